// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/table_texts.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/import/words/unread_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

constexpr std::size_t kShortestText = 5;  // bytes; shorter cells are codes and marks

/// The cell with a blank behind it if it is only a label ("Vorzeichen:") of the next cell; empty otherwise.
std::string label_of_sign(const std::string& cell) {
  const std::vector<std::string> words = text::words_in(text::in_small_letters(cell), " \t:");
  const bool alone = words.size() == 1 && (words[0].starts_with("vorzeichen") || words[0] == "sign");
  return alone ? cell + " " : "";
}

/// The only cell of a row that is not empty; empty if the row has none or several.
std::string only_cell(const std::vector<std::string>& row) {
  std::string found;
  for (const std::string& cell : row) {
    if (cell.empty()) continue;
    if (!found.empty()) return "";
    found = cell;
  }
  return found;
}

/// True for a text of several words; a heading or a line of units has fewer.
bool is_sentence(const std::string& cell) {
  constexpr std::size_t kFewestWords = 4;  // a heading alone in its line has fewer
  std::size_t words = 0;
  for (const std::string& word : text::words_in(cell, " \t_./:;,()[]#"))
    words += std::any_of(word.begin(), word.end(),
                         [](char c) { return static_cast<unsigned char>(c) >= 0x80 || std::isalpha(c) != 0; })
                 ? 1
                 : 0;
  return words >= kFewestWords;
}

bool is_row_of_headings(const sheet::Sheet& sheet, std::size_t row) {
  constexpr std::ptrdiff_t kFewest = 2;  // a table with one column has no text between
  const std::vector<std::string>& cells = sheet.rows[row];
  const auto words = std::count_if(cells.begin(), cells.end(), [&](const std::string& cell) {
    return !cell.empty() && !sheet::plain_number(cell, sheet.decimal_comma);
  });
  return words >= kFewest;
}

}  // namespace

std::vector<TableText> texts_about(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<TableText> texts;
  for (const sheet::Remark& remark : sheet.remarks) texts.push_back({remark.line, remark.text});
  const std::size_t headings = table.upper_row ? *table.upper_row : table.heading_row;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    if (table.has_headings && row >= headings && row < table.first_data) continue;
    std::string label;
    for (const std::string& cell : sheet.rows[row]) {
      if (cell.size() < kShortestText || sheet::plain_number(cell, sheet.decimal_comma)) continue;
      const bool in_row = row >= table.first_data && sheet::is_row_of_data(sheet, row);
      texts.push_back({sheet.line[row], label + cell, "", in_row});
      label = label_of_sign(cell);
    }
  }
  for (const std::string& text : texts_beside_headings(sheet, table))
    texts.push_back({sheet.line[table.heading_row], text});
  // A cover sheet is about all sheets of the workbook; another table states its own facts.
  std::string label;
  for (const sheet::TextElsewhere& other : sheet.elsewhere) {
    if (other.table) continue;
    texts.push_back({0, label + other.text, other.sheet});
    label = label_of_sign(other.text);
  }
  return texts;
}

std::vector<TableText> sentences_about(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<TableText> texts = texts_about(sheet, table);
  const std::size_t end = table.has_headings ? table.heading_row : 0;  // an upper line of headings too
  for (std::size_t row = 0; row < end; ++row) {
    std::vector<std::string> cells;
    for (const std::string& cell : sheet.rows[row])
      if (!cell.empty()) cells.push_back(cell);
    if (cells.size() > 1 || (table.upper_row && row == *table.upper_row))
      texts.push_back({sheet.line[row], text::joined(cells, ", ")});
  }
  return texts;
}

void take_sentences_below_headings(sheet::Sheet& sheet) {
  std::size_t first = 0;
  while (first < sheet.rows.size() && !sheet::is_row_of_data(sheet, first)) ++first;
  if (first == sheet.rows.size()) return;
  std::size_t headings = first;  // the sentences are between this row and the first row of data
  while (headings > 0 && is_sentence(only_cell(sheet.rows[headings - 1]))) --headings;
  if (headings == first || headings == 0 || !is_row_of_headings(sheet, headings - 1)) return;
  // Titles are above the headings: a title may state units, an axis and a sign.
  for (std::size_t row = headings; row < first; ++row) {
    const auto at = static_cast<std::ptrdiff_t>(row);
    sheet.notes.push_back(
        fmt::format("line {}: \"{}\" is a text between the headings and the rows: it is read as a "
                    "title, and is no heading",
                    sheet.line[row], only_cell(sheet.rows[row])));
    std::rotate(sheet.rows.begin(), sheet.rows.begin() + at, sheet.rows.begin() + at + 1);
    std::rotate(sheet.line.begin(), sheet.line.begin() + at, sheet.line.begin() + at + 1);
    if (row < sheet.written.size())
      std::rotate(sheet.written.begin(), sheet.written.begin() + at, sheet.written.begin() + at + 1);
  }
}

void note_title_alone(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  if (table.has_headings || table.first_data == 0) return;
  const std::string title = only_cell(sheet.rows[table.first_data - 1]);
  if (title.empty()) return;
  sheet.notes.push_back(
      fmt::format("line {}: \"{}\" is one text above {} columns: it is read as a title, and the columns have "
                  "no headings (1, 2, ...); if they are headings, separate them as the rows are separated",
                  sheet.line[table.first_data - 1], title, table.headings.size()));
}

}  // namespace vernier::importer
