// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/excluded.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <optional>
#include <string_view>

#include "tools/format/csv_file.h"
#include "tools/text/error.h"

namespace vernier::workbench {
namespace {

constexpr std::string_view kMark = "# excluded \"", kEndOfReason = "\": ";
constexpr std::size_t kMostLines = 10'000'000;

/// Splits at line ends. A line end belongs to its line.
std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::size_t length = end == std::string_view::npos ? text.size() : end + 1;
    lines.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return lines;
}

std::optional<ExcludedRow> read_excluded(std::string_view line, std::size_t number) {
  if (line.substr(0, kMark.size()) != kMark) return std::nullopt;
  const auto end = line.find(kEndOfReason, kMark.size());
  if (end == std::string_view::npos) return std::nullopt;
  return ExcludedRow{number, std::string(line.substr(kMark.size(), end - kMark.size())),
                     std::string(line.substr(end + kEndOfReason.size()))};
}

/// Returns the text with the named lines replaced by change(line, number).
std::string changed(const std::string& text, const std::vector<std::size_t>& lines,
                    const std::function<std::string(std::string_view, std::size_t)>& change) {
  std::string result;
  result.reserve(text.size() + 64 * lines.size());
  std::size_t number = 0;
  for (const std::string_view line : split(text)) {
    ++number;
    if (std::binary_search(lines.begin(), lines.end(), number))
      result += change(line, number);
    else
      result += line;
  }
  return result;
}

std::size_t line_number(std::string_view word) {
  std::size_t value = 0;
  const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end.ec != std::errc() || end.ptr != word.data() + word.size() || value == 0 || value > kMostLines)
    throw text::InputError("--lines \"" + std::string(word) + "\": no line number");
  return value;
}

}  // namespace

std::vector<ExcludedRow> excluded_rows(const std::string& text) {
  std::vector<ExcludedRow> rows;
  std::size_t number = 0;
  for (std::string_view line : split(text)) {
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    if (auto row = read_excluded(line, ++number)) rows.push_back(std::move(*row));
  }
  return rows;
}

std::string exclude_rows(const std::string& text, const std::string& file,
                         const std::vector<std::size_t>& lines, const std::string& reason) {
  if (std::any_of(reason.begin(), reason.end(),
                  [](char c) { return c == '"' || static_cast<unsigned char>(c) < 0x20; }))
    throw text::InputError("--reason: the text must not contain quotes or line ends");
  const format::CsvFile csv = format::parse_csv(text, file);
  for (const std::size_t line : lines)
    if (!std::binary_search(csv.line.begin(), csv.line.end(), line))
      throw text::InputError({file, line}, std::to_string(line), "no row of the measurement is on this line");
  return changed(text, lines, [&](std::string_view row, std::size_t) {
    return std::string(kMark) + reason + std::string(kEndOfReason) + std::string(row);
  });
}

std::string restore_rows(const std::string& text, const std::string& file,
                         const std::vector<std::size_t>& lines) {
  std::size_t restored = 0;
  std::string result = changed(text, lines, [&](std::string_view row, std::size_t number) {
    auto excluded = read_excluded(row, number);
    if (!excluded)
      throw text::InputError({file, number}, std::to_string(number), "no excluded row is on this line");
    ++restored;
    return excluded->row;
  });
  if (restored != lines.size())
    throw text::InputError({file, lines.back()}, std::to_string(lines.back()),
                           "this line number is beyond the end of the file");
  format::parse_csv(result, file);  // tests that the output can be read
  return result;
}

std::vector<std::size_t> parse_lines(const std::string& text) {
  std::vector<std::size_t> lines;
  std::string_view rest = text;
  while (true) {
    const auto comma = rest.find(',');
    const std::string_view word = rest.substr(0, comma);
    const auto dash = word.find('-');
    const std::size_t first = line_number(word.substr(0, dash));
    const std::size_t last = dash == std::string_view::npos ? first : line_number(word.substr(dash + 1));
    if (last < first) throw text::InputError("--lines \"" + std::string(word) + "\": ends before it begins");
    for (std::size_t line = first; line <= last; ++line) lines.push_back(line);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  return lines;
}

}  // namespace vernier::workbench
