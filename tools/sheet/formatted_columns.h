// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/sheet/sheet.h"

namespace vernier::sheet {

/// Reads the number formats of a workbook: a heading without a unit gets the unit that the format of all its
/// numbers shows ("Position X [in]"), and other formats that show more than the number are quoted. Each has a
/// note.
void take_number_formats(Sheet& sheet);

}  // namespace vernier::sheet
