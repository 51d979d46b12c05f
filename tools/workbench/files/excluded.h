// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace vernier::workbench {

/// A row of a measurement file that a user excluded. In the file, the comment `# excluded "reason": row`
/// replaces this row. Commands ignore an excluded row. All rows that are not excluded keep their line
/// numbers, and no data are lost.
struct ExcludedRow {
  std::size_t line = 0;  // line number, from 1
  std::string reason, row;
};

/// Returns the excluded rows of a measurement file, in the order of their lines.
std::vector<ExcludedRow> excluded_rows(const std::string& text);

/// Returns the text of a measurement file in which the rows on the given lines are excluded. `reason`: text
/// without quotes and line ends. Throws InputError with the line if a given line contains no row. `file`:
/// name of the file in messages.
std::string exclude_rows(const std::string& text, const std::string& file,
                         const std::vector<std::size_t>& lines, const std::string& reason);

/// Returns the text of a measurement file in which the excluded rows on the given lines are restored. Throws
/// InputError with the line if a given line contains no excluded row.
std::string restore_rows(const std::string& text, const std::string& file,
                         const std::vector<std::size_t>& lines);

/// Reads line numbers from a text such as "12,15-20". The result of parse_lines() is sorted and contains each
/// line number (from 1) once. Throws InputError with the wrong word if the text is not valid.
std::vector<std::size_t> parse_lines(const std::string& text);

}  // namespace vernier::workbench
