// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/computed_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/import/tables/statistic_values.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

// Words of computed rows in German and English, in small letters.
const WordSet kAlways = {
    "mittel", "mittelwert", "mittelwerte", "mean", "average", "avg", "ø", "durchschnitt", "stdev", "stddev",
    "stdabw", "stabw", "std", "standardabweichung", "spannweite", "varianz", "variance", "sigma", "σ", "rms",
    "median", "summe", "mittelw", "streuung", "rmse", "standardab",
    // Signs of a mean, a sum and a standard deviation; capitals beyond ASCII have no small letters here.
    "Ø", "⌀", "∅", "x̄", "x̅", "Σ", "∑", "2σ", "3σ", "±2σ", "gesamtmittel", "mittelung", "averages", "means",
    "moyenne", "écart-type"};
// States of a machine can have these names too.
const WordSet kSometimes = {"max",   "maximum", "maximal",  "min",    "minimum", "minimal", "range",
                            "sum",   "total",   "gesamt",   "anzahl", "count",   "spread",  "s",
                            "maxim", "größte",  "kleinste", "mw",     "sd",      "var"};
// Further words of such a cell: "Std. dev.", "Max. Abweichung", "Mean value".
const WordSet kBeside = {"value",    "values",    "wert",   "werte",  "dev",   "deviation", "abweichung",
                         "abw",      "error",     "fehler", "of",     "the",   "der",       "die",
                         "all",      "aller",     "alle",   "runs",   "läufe", "von",       "abs",
                         "standard", "quadratic", "square", "column", "spalte"};

/// A row with a word of a statistic in one of its columns.
struct Computed {
  std::size_t row = 0, column = 0;
  std::string word;
};

enum class Names { kNoRow, kRowAtTheEnd, kRow };

/// True for a word of digits: "Ø 6,1" has its value in the same cell.
bool is_count(const std::string& word) { return word.find_first_not_of("0123456789") == std::string::npos; }

Names computed_word(const std::string& cell) {
  Names found = Names::kNoRow;
  bool standard = false, deviation = false;
  if (says_standard_deviation(cell)) return Names::kRow;
  for (const std::string& word : plain_words(cell)) {
    standard |= word == "standard" || word == "std";
    deviation |= word == "deviation" || word == "dev" || word == "abweichung";
    if (kAlways.contains(word))
      found = Names::kRow;
    else if (kSometimes.contains(word))
      found = std::max(found, Names::kRowAtTheEnd);
    else if (word.size() > 1 && !kBeside.contains(word) && !is_count(word) &&
             !sheet::unit_meant(word))  // a letter alone is an axis
      return Names::kNoRow;
  }
  return standard && deviation ? Names::kRow : found;
}

/// True if the other cells of a column are numbers, in most rows.
bool is_column_of_numbers(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  std::size_t numbers = 0, words = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][column];
    if (cell.empty() || computed_word(cell) != Names::kNoRow) continue;
    ++(sheet::plain_number(cell, sheet.decimal_comma) ? numbers : words);
  }
  return numbers > words;
}

/// True if the columns from this one have no numbers: remarks at the right end.
bool are_words(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t from, std::size_t end) {
  for (std::size_t k = from; k < end; ++k)
    if (is_column_of_numbers(sheet, table, k)) return false;
  return true;
}

/// Rows whose cell of this column names them as computed.
std::vector<std::size_t> computed_rows_by(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          std::size_t column) {
  std::vector<std::size_t> rows;
  std::vector<std::pair<std::size_t, std::string>> open;
  std::size_t last_other = 0;
  bool computed = false;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][column];
    const Names word = computed_word(cell);
    if (word == Names::kRow) {
      rows.push_back(row);
      computed = true;
    } else if (word == Names::kRowAtTheEnd) {
      open.emplace_back(row, text::in_small_letters(cell));
    } else if (!cell.empty()) {
      last_other = row;
    }
  }
  if (open.empty()) return rows;
  const bool numbers = is_column_of_numbers(sheet, table, column);
  for (const auto& [row, word] : open) {
    const auto times = std::count_if(open.begin(), open.end(),
                                     [&, said = word](const auto& other) { return other.second == said; });
    const bool labelled = last_other > 0 && last_other < row && times == 1;
    if (numbers || computed || labelled) rows.push_back(row);
  }
  return rows;
}

/// The first cell of a row that is not empty.
std::string label_of(const std::vector<std::string>& cells) {
  const auto first =
      std::find_if(cells.begin(), cells.end(), [](const std::string& cell) { return !cell.empty(); });
  return first == cells.end() ? "" : *first;
}

/// Results with a name ("A =", "Reversal B") in the block of rows at the end whose first cells are words in
/// a column of numbers, if a row of the block is named as computed.
std::vector<std::size_t> results_at_the_end(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<std::size_t> block;
  bool computed = false;
  if (sheet.rows.empty() || sheet.rows.front().empty() || !is_column_of_numbers(sheet, table, 0)) return {};
  for (std::size_t row = sheet.rows.size(); row-- > table.first_data + 1;) {
    const std::string& cell = sheet.rows[row].front();
    const Names word = computed_word(cell);
    // A mistyped number ("1OO") has digits.
    const bool name =
        !cell.empty() && cell.find_first_of("0123456789") == std::string::npos &&
        std::any_of(cell.begin(), cell.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
    if (word == Names::kNoRow && !name) break;
    computed |= word == Names::kRow;
    if (word == Names::kNoRow) block.push_back(row);
  }
  if (!computed) block.clear();
  return block;
}

}  // namespace

bool says_computed_row(const std::string& cell) { return computed_word(cell) != Names::kNoRow; }

namespace {

/// What a row is whose cell in the column `k` is a word of a statistic. A row with a position is computed
/// only if its numbers are statistics. Otherwise the word is a remark about a measurement, or, in a column
/// that has a value in most rows, the kind of the row is not known.
enum class Row { kComputed, kRemark, kUnknown };

/// For each column: true if it has a value in most rows.
std::vector<bool> filled_columns(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<bool> filled;
  for (std::size_t k = 0; k < sheet.rows.front().size(); ++k) {
    std::size_t cells = 0;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      cells += sheet.rows[row][k].empty() ? 0 : 1;
    filled.push_back(2 * cells > sheet.rows.size() - table.first_data);
  }
  return filled;
}

/// Takes the rows out of `computed` that are measurements with a remark, with a note for each, and refuses
/// the table if the kind of a row is not known.
void keep_measurements(sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<Computed>& computed) {
  constexpr std::size_t kMost = 100;  // computed rows: of more, each is about the rows since the one before
  const bool few = computed.size() <= kMost;
  const std::vector<std::size_t> positions = position_columns(table);
  const std::vector<bool> filled = filled_columns(sheet, table);
  std::size_t since = table.first_data;
  std::erase_if(computed, [&](const Computed& one) {
    const bool is_computed =
        !has_number(sheet, one.row, positions) || agrees_with_statistics(sheet, table, one.row, since, few);
    const Row kind = is_computed ? Row::kComputed : filled[one.column] ? Row::kUnknown : Row::kRemark;
    since = one.row + 1;
    if (kind == Row::kUnknown)
      throw text::InputError(
          {sheet.file, sheet.line[one.row]}, one.word,
          "this word names a computed row, but the row has a position, and its values are no statistics of "
          "the rows above it: if the row is computed, delete the row; if it is a measurement, change the "
          "word");
    if (kind == Row::kRemark)
      sheet.notes.push_back(fmt::format(
          "line {}: the word \"{}\" is a remark: the row has a position, its values are no statistics of the "
          "rows above it, and it is read as a measurement",
          sheet.line[one.row], one.word));
    return kind == Row::kRemark;
  });
}

}  // namespace

void leave_computed_rows(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  const std::vector<std::size_t> named = results_at_the_end(sheet, table);
  std::vector<Computed> computed;
  std::set<std::size_t> rows;
  for (std::size_t k = 0; !sheet.rows.empty() && k < sheet.rows.front().size(); ++k)
    for (const std::size_t row : computed_rows_by(sheet, table, k))
      if (rows.insert(row).second) computed.push_back({row, k, sheet.rows[row][k]});
  for (const std::size_t row : named)
    if (rows.insert(row).second) computed.push_back({row, 0, label_of(sheet.rows[row])});
  if (rows.empty() || rows.size() + table.first_data >= sheet.rows.size()) return;
  std::sort(computed.begin(), computed.end(),
            [](const Computed& a, const Computed& b) { return a.row < b.row; });
  keep_measurements(sheet, table, computed);
  for (const Computed& one : computed)
    sheet.notes.push_back(
        fmt::format("line {}: the row \"{}\" is computed from the rows above it and is omitted",
                    sheet.line[one.row], one.word));
  for (auto one = computed.rbegin(); one != computed.rend(); ++one) sheet::remove_row(sheet, one->row);
}

void note_short_rows(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  if (!table.has_headings || sheet.written.empty()) return;
  const std::size_t headings =
      std::min(sheet.written[table.heading_row], sheet.rows[table.heading_row].size());
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::size_t cells = sheet.written[row];
    if (cells >= headings) continue;
    if (sheet.separator == ' ' && !are_words(sheet, table, cells, headings))
      throw text::InputError(
          {sheet.file, sheet.line[row]}, text::joined(sheet.rows[row], " ").substr(0, 40),
          fmt::format(
              "this row has {} cells, but line {} has {} headings; write - for a cell without a value", cells,
              sheet.line[table.heading_row], headings));
    const std::string& first = table.headings[cells].text;
    sheet.notes.push_back(fmt::format(
        "line {}: {} cells, {} headings: no value for {}", sheet.line[row], cells, headings,
        headings - cells == 1 ? fmt::format("\"{}\"", first)
                              : fmt::format("\"{}\" to \"{}\"", first, table.headings[headings - 1].text)));
  }
}

}  // namespace vernier::importer
