// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Determines the sign of each deviation: as the user states it, by its heading, or by another text of the
/// file for all deviations. A text that is not clear is stored in the column (`sign_text`).
void settle_signs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                  std::vector<SheetColumn>& columns, const SheetWishes& wishes);

/// Determines the sign of the deviations of lengths in column `k`, by its heading or another text.
void settle_sign_of_lengths(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k,
                            SheetColumn& column);

}  // namespace vernier::importer
