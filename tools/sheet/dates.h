// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace vernier::sheet {

/// True if a number format of a spreadsheet shows dates or times (ECMA-376 part 1, section 18.8.31). code: as
/// written, "dd.mm.yyyy"; quoted or escaped text and text in brackets is ignored, except [h] [m] [s].
bool is_date_format(std::string_view code);

/// True if a built-in format with this number shows dates or times (section 18.8.30, all languages).
bool is_date_format(unsigned id);

/// Converts a serial number of days to "2026-03-04", "2026-03-04T12:30:00", below one day "12:30:00".
/// from_1904: day 0 of the workbook is 1904-01-01, else 1899-12-30. Returns the number as text outside the
/// years 1 to
/// 9999.
std::string date_text(double serial, bool from_1904);

/// True if a cell has a form that `date_text` writes.
bool is_date(std::string_view cell);

}  // namespace vernier::sheet
