// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace vernier::workbench {

/// A row of a measurement file that a user excluded: a comment `# excluded "reason": row` replaces it. Every
/// command ignores an excluded row, every other row keeps its line, and no data are lost.
struct ExcludedRow {
  std::size_t line = 0;  // 1-based
  std::string reason, row;
};

/// The excluded rows of a measurement file, by line.
std::vector<ExcludedRow> excluded_rows(const std::string& text);

/// Returns the text with the rows on these lines excluded. reason: without quotes and line ends. Throws
/// InputError with the line if a line contains no row. `file` is for messages.
std::string exclude_rows(const std::string& text, const std::string& file,
                         const std::vector<std::size_t>& lines, const std::string& reason);

/// Returns the text with the excluded rows on these lines restored. Throws InputError with the line if a line
/// has no excluded row.
std::string restore_rows(const std::string& text, const std::string& file,
                         const std::vector<std::size_t>& lines);

/// Reads line numbers such as "12,15-20"; returns them from 1, sorted, each once. Throws InputError with the
/// word.
std::vector<std::size_t> parse_lines(const std::string& text);

}  // namespace vernier::workbench
