// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::sheet {

/// True if a line of text, or a part of a line, has the numbers of a row: two cells of numbers or more.
bool has_row_of_numbers(std::string_view line);

/// A text in which each quote that is alone in its cell (a ditto mark) is a cell in quotes: `""""`. Cells in
/// quotes are not changed, over several lines as well. `blanks`: true if blanks separate the cells.
std::string with_quoted_ditto_marks(const std::string& text, bool blanks = false);

/// Replaces each ditto mark (a quote alone in its cell, "dto.") in a row of numbers by the cell above it.
/// `line`: line number of each row. Returns a note for the user; empty if there are no marks. Throws
/// InputError for a mark without a row of numbers above it.
std::string repeat_above_ditto_marks(std::vector<std::vector<std::string>>& rows,
                                     const std::vector<std::size_t>& line, const std::string& file);

}  // namespace vernier::sheet
