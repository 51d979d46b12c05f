// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/other_quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tools/format/columns.h"
#include "tools/import/words/doubtful_words.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/stated_directions.h"
#include "tools/import/words/table_texts.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

bool begins_with_one_of(const std::string& word, std::initializer_list<std::string_view> starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](std::string_view start) { return word.starts_with(start); });
}

/// The first text about a table that states increments; empty: none.
TableText text_of_increments(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  for (TableText& one : texts_about(sheet, table))
    if (states_increments(one.text, false) || (!one.in_row && may_state(one.text, Doubtful::kIncrements)))
      return std::move(one);
  return {};
}

void doubt_increments(sheet::Sheet& sheet, const sheet::SheetTable& table,
                      std::vector<SheetColumn>& columns) {
  const TableText title = text_of_increments(sheet, table);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kDeviation || !column.doubt.empty()) continue;
    const std::string& heading = table.headings[k].text;
    const bool own = states_increments(table.headings[k].name, true);
    if (!own && title.text.empty()) continue;
    const std::string text = own ? heading : title.quoted();
    if (column.why == "as given" || column.why == "by the profile") {
      sheet.notes.push_back(
          fmt::format("the text \"{}\" states increments, each from the position before, and \"{}\" is read "
                      "as deviations "
                      "from the target, as given",
                      text, heading));
      continue;
    }
    column.doubt_place = {sheet.file, own ? sheet.line[table.heading_row] : title.line};
    column.doubt_word = text;
    column.doubt = fmt::format(
        "by this text the values of \"{0}\" are increments, each from the position before, and a measurement "
        "file has deviations from the target: replace each value in the file by the sum of the values up to "
        "it in its run, and change the text; if the values are deviations already, give --deviation "
        "\"{1}[{2}]={0}\"",
        heading, column.name, column.unit.empty() ? "um" : column.unit);
  }
}

/// The only value of a column; nullopt: it has several, or fewer than three rows.
std::optional<std::string> only_value(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                      std::size_t k) {
  constexpr std::size_t kFewestRows = 3;  // two readings may be at one position
  std::set<std::string> values;
  std::size_t rows = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (!sheet::number_at(sheet, row, k)) continue;
    values.insert(sheet.rows[row][k]);
    ++rows;
  }
  return rows >= kFewestRows && values.size() == 1 ? std::optional(*values.begin()) : std::nullopt;
}

void doubt_steps(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                 std::vector<SheetColumn>& columns) {
  static const WordSet kMotions = {"weg",   "verfahrweg", "schritt", "schrittweite", "step",
                                   "steps", "stroke",     "travel",  "distance",     "move"};
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    const bool read = column.use == SheetColumn::Use::kColumn && column.why == "by its heading" &&
                      std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& other) {
                        return other.use == SheetColumn::Use::kDeviation && other.name == column.name;
                      });
    const std::vector<std::string> words = plain_words(table.headings[k].name);
    const bool motion = std::any_of(words.begin(), words.end(),
                                    [&](const std::string& word) { return kMotions.contains(word); });
    const auto value = read && motion ? only_value(sheet, table, k) : std::nullopt;
    if (!value || !column.doubt.empty()) continue;
    column.doubt_place = {sheet.file, sheet.line[table.first_data]};
    column.doubt_word = *value;
    column.doubt = fmt::format(
        "\"{0}\" has this value in all rows: it is the length of each motion, and not the position. Write "
        "the "
        "position of each reading into the file; if the axis is at this position in all rows, give --column "
        "\"{1}{2}={0}\"",
        table.headings[k].text, column.name, column.unit.empty() ? "" : "[" + column.unit + "]");
  }
}

bool names_diameter(const std::string& text) {
  const std::vector<std::string> words = plain_words(text);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return begins_with_one_of(word, {"durchmesser", "diameter", "diamètre", "diametro"});
  });
}

void note_diameters(sheet::Sheet& sheet, const sheet::SheetTable& table,
                    const std::vector<SheetColumn>& columns) {
  std::string headings;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use != SheetColumn::Use::kLeft && names_diameter(table.headings[k].name))
      headings += (headings.empty() ? "\"" : ", \"") + table.headings[k].text + "\"";
  if (headings.empty()) return;
  sheet.notes.push_back(fmt::format(
      "{} has diameters, which change by twice the motion of the carriage: the values are read as "
      "positions without a change; if the axis of the machine file is the radius, divide them by 2 "
      "in the file, and check whether the deviations are of the diameter too",
      headings));
}

}  // namespace

void judge_other_quantities(sheet::Sheet& sheet, const sheet::SheetTable& table,
                            std::vector<SheetColumn>& columns) {
  doubt_increments(sheet, table, columns);
  doubt_steps(sheet, table, columns);
  note_diameters(sheet, table, columns);
}

void read_slopes_as_angles(sheet::Sheet& sheet, sheet::SheetTable& table) {
  for (sheet::Heading& heading : table.headings) {
    const std::vector<std::string> words = plain_words(heading.name);
    if (std::none_of(words.begin(), words.end(), says_tilt)) continue;
    const bool micro = heading.unit == "um/m", milli = heading.unit == "mm/m";
    if (!micro && !milli) continue;
    const std::string written = std::exchange(heading.unit, micro ? "urad" : "mrad");
    sheet.notes.push_back(
        fmt::format("\"{}\": a slope of 1 {} is an angle of 1 {}", heading.text, written, heading.unit));
  }
}

}  // namespace vernier::importer
