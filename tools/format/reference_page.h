// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::format {

/// The page tools/docs/measurement_columns.md: every column, kind of reading, unit and reserved name, as the
/// tables of this room have them. tool.
std::string reference_page();

}  // namespace vernier::format
