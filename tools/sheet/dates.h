// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace vernier::sheet {

/// Does a number format of a spreadsheet show dates or times (ECMA-376 part 1, section 18.8.31)?
/// code: as written, "dd.mm.yyyy". Quoted, escaped or bracketed characters are not letters of the
/// format, except [h] [m] [s].
bool is_date_format(std::string_view code);

/// Is the built-in format with this number a format of dates or times (section 18.8.30, all
/// languages)?
bool is_date_format(unsigned id);

/// Returns a serial number of days as "2026-03-04", "2026-03-04T12:30:00", below one day
/// "12:30:00". from_1904: of a workbook whose day 0 is 1904-01-01, else 1899-12-30. Returns the
/// number as text if the year is not in 1 to 9999. tool.
std::string date_text(double serial, bool from_1904);

/// Has a cell the form of `date_text`?
bool is_date(std::string_view cell);

}  // namespace vernier::sheet
