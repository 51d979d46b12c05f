// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace vernier::sheet {

/// True if a number format of a spreadsheet is for dates or times (ECMA-376 part 1, section 18.8.31). `code`:
/// the format as it is written, "dd.mm.yyyy". Quoted or escaped text and text in brackets is ignored, except
/// [h] [m] [s].
bool is_date_format(std::string_view code);

/// True if the built-in number format with this number is for dates or times (section 18.8.30, all
/// languages).
bool is_date_format(unsigned id);

/// Converts a serial number of days to text: "2026-03-04", "2026-03-04T12:30:00", or "12:30:00" below one
/// day. If from_1904 is true, day 0 is 1904-01-01; otherwise it is 1899-12-30. For dates outside the years 1
/// to 9999, returns the serial number as text.
std::string date_text(double serial, bool from_1904);

/// True if the text of a cell is a date or time in a form that `date_text` writes.
bool is_date(std::string_view cell);

}  // namespace vernier::sheet
