// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/other_quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "tools/format/columns.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

bool begins_with_one_of(const std::string& word, std::initializer_list<std::string_view> starts) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](std::string_view start) { return word.starts_with(start); });
}

/// True for "previous target", "vorigen Position", "Vorposition": the position before.
bool names_position_before(const std::vector<std::string>& words) {
  static const WordSet kPlaces = {"position", "target",  "point",        "station",      "step",
                                  "value",    "schritt", "zielpunkt",    "punkt",        "messpunkt",
                                  "stelle",   "reading", "sollposition", "zielposition", "wert"};
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (begins_with_one_of(words[k], {"vorposition", "vorgängerposition", "vorpunkt"})) return true;
    const bool before = begins_with_one_of(
        words[k], {"previous", "preceding", "vorig", "vorherig", "vorangehend", "vorhergehend", "letzten"});
    if (before && k + 1 < words.size() && kPlaces.contains(words[k + 1])) return true;
  }
  return false;
}

/// True for the heading of deviations that are increments. "Increment" in a title is often the step of the
/// positions, and an increment of an encoder.
bool states_increments(const std::string& text, bool heading) {
  const std::vector<std::string> words = plain_words(text);
  if (names_position_before(words)) return true;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (begins_with_one_of(words[k], {"schrittfehler", "schrittabweichung"})) return true;
    if (!heading) continue;
    if (begins_with_one_of(words[k], {"incremental", "increment", "inkrement"})) return true;
    const std::string next = k + 1 < words.size() ? words[k + 1] : "";
    if (words[k] == "per" && (next == "pitch" || next == "step")) return true;
    if (words[k] == "je" && (next == "schritt" || next == "steigung" || next == "teilung")) return true;
  }
  return false;
}

/// The text that states increments, and its line; empty: none.
text::Place place_of_title(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::string& found) {
  const std::size_t end = table.upper_row ? *table.upper_row : table.heading_row;
  for (std::size_t row = 0; table.has_headings && row < end; ++row)
    for (const std::string& cell : sheet.rows[row])
      if (!cell.empty() && states_increments(cell, false)) {
        found = cell;
        return {sheet.file, sheet.line[row]};
      }
  for (const sheet::Remark& remark : sheet.remarks)
    if (states_increments(remark.text, false)) {
      found = remark.text;
      return {sheet.file, remark.line};
    }
  return {};
}

void doubt_increments(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                      std::vector<SheetColumn>& columns) {
  std::string title;
  const text::Place place = place_of_title(sheet, table, title);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kDeviation || column.why == "as given" ||
        column.why == "by the profile" || !column.doubt.empty())
      continue;
    const std::string& heading = table.headings[k].text;
    const bool own = states_increments(table.headings[k].name, true);
    if (!own && title.empty()) continue;
    column.doubt_place = own ? text::Place{sheet.file, sheet.line[table.heading_row]} : place;
    column.doubt_word = own ? heading : title;
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

}  // namespace vernier::importer
