// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/several_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>

#include "tools/sheet/dates.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::sheet {
namespace {

bool is_number(const Sheet& sheet, std::size_t row, std::size_t column) {
  return plain_number(sheet.rows[row][column], sheet.decimal_comma).has_value();
}

/// A word of a heading: no mark of a missing value, no date.
bool is_word(const std::string& cell) {
  return !cell.empty() && !begins_with_error_value(cell) && !is_date(cell) &&
         text::in_small_letters(cell) != "n/a" && cell.find_first_not_of('-') != std::string::npos;
}

/// No number, and at least two words in columns that have numbers in the row of data before. A line of units
/// alone (below headings that are numbers: 1, 2, 3) begins no table.
bool is_line_of_headings(const Sheet& sheet, std::size_t row, std::size_t data) {
  std::size_t words = 0;
  for (std::size_t k = 0; k < sheet.rows[row].size(); ++k) {
    if (is_number(sheet, row, k)) return false;
    words += is_number(sheet, data, k) && is_word(sheet.rows[row][k]) ? 1 : 0;
  }
  return words >= 2 && !is_line_of_units(sheet, row);
}

/// A line that only numbers a page: "Seite 2 von 2", "Page 2/3", "Fortsetzung".
bool is_page_line(const std::vector<std::string>& cells) {
  static const std::set<std::string> kPages = {"seite", "page", "blatt", "sheet", "fortsetzung", "continued"};
  static const std::set<std::string> kBeside = {"von", "of"};
  bool page = false;
  for (const std::string& cell : cells)
    for (const std::string& word : text::words_in(text::in_small_letters(cell), " \t_-./:;,()[]")) {
      const bool names = kPages.contains(word);
      page |= names;
      if (!names && !kBeside.contains(word) && word.find_first_not_of("0123456789") != std::string::npos)
        return false;
    }
  return page;
}

/// The rows above the first row of data from a row on.
std::size_t data_from(const Sheet& sheet, std::size_t row) {
  while (row < sheet.rows.size() && !is_row_of_data(sheet, row)) ++row;
  return row;
}

/// Joins pages: the headings of each further table are those of the first one, and only page numbers and
/// lines of the first page are above them. False: the tables are not the pages of one table, and the sheet
/// does not change.
bool join_pages(Sheet& sheet, const std::vector<std::size_t>& first) {
  const std::size_t top = data_from(sheet, 0);
  std::vector<std::size_t> drop;
  for (std::size_t table = 1; table < first.size(); ++table) {
    const std::size_t data = data_from(sheet, first[table]);
    std::size_t heads = 0;  // equal rows directly above the data
    while (heads < top && heads < data - first[table] &&
           sheet.rows[top - 1 - heads] == sheet.rows[data - 1 - heads])
      ++heads;
    if (heads == 0) return false;
    bool page = false;
    for (std::size_t row = first[table]; row + heads < data; ++row) {
      const bool of_page = is_page_line(sheet.rows[row]);
      const auto above = sheet.rows.begin() + static_cast<std::ptrdiff_t>(top);
      if (!of_page && !is_blank(sheet.rows[row]) &&
          std::find(sheet.rows.begin(), above, sheet.rows[row]) == above)
        return false;
      page |= of_page;
    }
    if (!page) return false;
    for (std::size_t row = first[table]; row < data; ++row) drop.push_back(row);
  }
  std::string lines;
  for (auto row = first.begin() + 1; row != first.end(); ++row)
    lines += (lines.empty() ? "" : ", ") + std::to_string(sheet.line[*row]);
  sheet.notes.push_back(fmt::format(
      "the headings are repeated on further pages (line {}): the rows of all pages are read as one table",
      lines));
  for (auto row = drop.rbegin(); row != drop.rend(); ++row) remove_row(sheet, *row);
  return true;
}

}  // namespace

std::vector<std::size_t> tables_of(const Sheet& sheet) {
  std::vector<std::size_t> first = {0};
  bool data = false, headings = false;  // since the table began; since the last row of data
  std::size_t begin = 0;                // of the rows behind the last row of data
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    if (!is_row_of_data(sheet, row)) {
      headings |= data && is_line_of_headings(sheet, row, begin - 1);
      continue;
    }
    if (data && headings) first.push_back(begin);
    data = true;
    headings = false;
    begin = row + 1;
  }
  return first;
}

std::vector<TableBeside> tables_side_by_side(const Sheet& sheet) {
  constexpr std::size_t kFewest = 3;  // columns: a position, and two columns of readings
  const std::size_t data = data_from(sheet, 0);
  if (data < 2 || data == sheet.rows.size()) return {};
  const std::vector<std::string>&headings = sheet.rows[data - 1], &titles = sheet.rows[data - 2];
  std::vector<TableBeside> tables;
  bool open = false;
  for (std::size_t k = 0; k < headings.size(); ++k) {
    const bool empty = std::all_of(sheet.rows.begin() + static_cast<std::ptrdiff_t>(data - 2),
                                   sheet.rows.end(), [&](const auto& cells) { return cells[k].empty(); });
    if (!empty && !open) tables.push_back({k, k, titles[k]});
    open = !empty;
    if (open) tables.back().end = k + 1;
  }
  const auto of = [&](const TableBeside& table) {
    return std::vector<std::string>(headings.begin() + static_cast<std::ptrdiff_t>(table.first),
                                    headings.begin() + static_cast<std::ptrdiff_t>(table.end));
  };
  std::set<std::string> different;
  for (const TableBeside& table : tables) {
    different.insert(table.title);
    if (table.end - table.first < kFewest || of(table) != of(tables.front()) || table.title.empty())
      return {};
  }
  if (tables.size() < 2 || different.size() < tables.size()) return {};
  return tables;
}

namespace {

/// Keeps the columns of a table beside others, and removes the rows below its end.
void keep_columns(Sheet& sheet, const TableBeside& table) {
  for (std::size_t row = sheet.rows.size(); row-- > 0;) {
    std::vector<std::string>& cells = sheet.rows[row];
    cells = {cells.begin() + static_cast<std::ptrdiff_t>(table.first),
             cells.begin() + static_cast<std::ptrdiff_t>(table.end)};
    if (!sheet.written.empty())
      sheet.written[row] = std::clamp(sheet.written[row], table.first, table.end) - table.first;
    if (is_blank(cells)) remove_row(sheet, row);
  }
}

}  // namespace

void keep_table(Sheet& sheet, std::optional<std::size_t> number) {
  const std::vector<std::size_t> first = tables_of(sheet);
  if (!number && (first.size() == 1 || join_pages(sheet, first))) return;
  if (const auto beside = tables_side_by_side(sheet); number && first.size() == 1 && !beside.empty()) {
    if (*number < 1 || *number > beside.size())
      throw text::InputError(
          {sheet.file, 0}, std::to_string(*number),
          fmt::format("the file has no table of this number: it has {} tables side by side", beside.size()));
    return keep_columns(sheet, beside[*number - 1]);
  }
  std::string lines;
  for (const std::size_t row : first) lines += (lines.empty() ? "" : ", ") + std::to_string(sheet.line[row]);
  const std::string found = std::to_string(first.size()) + " table" + (first.size() == 1 ? "" : "s") +
                            " (first line: " + lines + ")";
  if (!number)
    throw text::InputError({sheet.file, sheet.line[first[1]]}, "",
                           fmt::format("a second line of headings: the file has {}; import each with --table "
                                       "1 and so on, then give all files to the command",
                                       found));
  if (*number < 1 || *number > first.size())
    throw text::InputError({sheet.file, 0}, std::to_string(*number),
                           fmt::format("the file has no table of this number: it has {}", found));
  // A title at the top of the file may state the sign of the deviations of all its tables.
  std::size_t data = 0;
  while (data < sheet.rows.size() && !is_row_of_data(sheet, data)) ++data;
  for (std::size_t row = 0; *number > 1 && row + 1 < data; ++row)
    sheet.remarks.push_back({sheet.line[row], text::joined(sheet.rows[row], " ")});
  const auto part = [&](auto& list) {
    const auto at = [&](std::size_t table) {
      return table < first.size() ? list.begin() + static_cast<std::ptrdiff_t>(first[table]) : list.end();
    };
    list = {std::make_move_iterator(at(*number - 1)), std::make_move_iterator(at(*number))};
  };
  part(sheet.rows);
  part(sheet.line);
  if (!sheet.written.empty()) part(sheet.written);
}

}  // namespace vernier::sheet
