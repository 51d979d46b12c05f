// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/distances/distance_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/column_signs.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

namespace columns = format::columns;
using WordSet = std::set<std::string, std::less<>>;

/// What a heading says of its column.
enum class Says { kNothing, kNominal, kMeasured, kDeviation, kMean, kSpread, kUncertainty };

/// Target and measured words of drawings and callipers, beside those of positions.
bool says_nominal(const std::string& word) {
  static const WordSet kWords = {"nenn",   "nennlänge",   "solllänge", "sollänge", "cad",
                                 "design", "theoretisch", "theorie",   "theo",     "theoretical",
                                 "ideal",  "expected",    "zeichnung", "drawing",  "sollabstand",
                                 "true",   "modell",      "model"};
  // "pos" and "achse" are words of positions, and "Weg" is one of a length here.
  static const WordSet kNot = {"position", "pos", "weg", "achse", "axis", "maschine", "machine", "set"};
  return kWords.contains(word) || (says_target(word) && !kNot.contains(word));
}

bool says_length(const std::string& word) {
  static const WordSet kWords = {
      "messschieber", "schieblehre", "caliper",  "calliper", "messung",   "wert",   "value",    "länge",
      "length",       "abstand",     "distance", "distanz",  "messwerte", "result", "ergebnis", "measurement",
      "istlänge",     "istabstand",  "gem",      "strecke",  "l",         "mm",     "maß"};
  return kWords.contains(word) || says_measured(word);
}

bool says_uncertainty(const std::string& word) {
  return word == columns::kUncertainty || word.ends_with("unsicherheit") || word == "uncertainty" ||
         word == "±";
}

Says said_by(const sheet::Heading& heading) {
  const std::vector<std::string> words = heading_words(text::in_small_letters(heading.name));
  const auto any = [&](auto says) { return std::any_of(words.begin(), words.end(), says); };
  static const WordSet kSpreads = {
      "stabw", "stdabw", "stdev", "standardabweichung", "spannweite", "range", "std", "sd", "s", "σ"};
  if (any([](const std::string& word) { return kSpreads.contains(word); }) ||
      says_standard_deviation(heading.name))
    return Says::kSpread;
  if (names_statistic(heading)) return Says::kMean;
  if (any(says_uncertainty)) return Says::kUncertainty;
  const bool nominal = any(says_nominal), measured = any(says_measured);
  if (any(says_deviation) || names_correction(heading) || (nominal && measured)) return Says::kDeviation;
  if (nominal) return Says::kNominal;
  return any(says_length) ? Says::kMeasured : Says::kNothing;
}

/// The heading without numbers and signs between words: "Ist 1" and "Ist 2" are the same.
std::string without_number(const sheet::Heading& heading) {
  std::string text;
  for (const char c : text::in_small_letters(heading.name))
    if ((c < '0' || c > '9') && std::string_view(" .()#_-:").find(c) == std::string_view::npos) text += c;
  return text;
}

struct Cells {
  std::size_t numbers = 0, words = 0;
};

Cells cells_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  Cells cells;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][column];
    if (is_missing(cell)) continue;
    ++(sheet::plain_number(cell, sheet.decimal_comma) ? cells.numbers : cells.words);
  }
  return cells;
}

std::optional<SheetColumn> as_given(const sheet::SheetTable& table, const SheetWishes& wishes,
                                    std::size_t column) {
  for (const SheetWishes::Assignment& wish : wishes.assignments) {
    if (find_heading(table, wish.heading) != column) continue;
    SheetColumn one = wish.column;
    one.why = one.use == SheetColumn::Use::kLeft ? "as given"
              : wish.place.file.empty()          ? "as given"
                                                 : "by the profile";
    return one;
  }
  return std::nullopt;
}

SheetColumn column_of(const std::string& name, const std::string& unit, const std::string& why) {
  SheetColumn column;
  column.name = name;
  column.unit = unit;
  column.why = why;
  return column;
}

std::string names_of(const sheet::SheetTable& table, const std::vector<std::size_t>& list) {
  std::string names;
  for (const std::size_t k : list) names += (names.empty() ? "\"" : ", \"") + table.headings[k].text + "\"";
  return names;
}

}  // namespace

std::vector<SheetColumn> distance_columns(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const PairSheet& pairs, const SheetWishes& wishes,
                                          std::string& ask) {
  std::vector<SheetColumn> result(table.headings.size());
  std::vector<std::size_t> measured, unknown, means, deviations;
  bool given = false;
  for (std::size_t k = 0; k < result.size(); ++k) {
    const sheet::Heading& heading = table.headings[k];
    SheetColumn& column = result[k];
    const auto from_cells = pairs.units.find(k);
    const std::string unit = from_cells != pairs.units.end() ? from_cells->second : heading.unit;
    if (const auto wish = as_given(table, wishes, k); wish && k != pairs.column) {
      column = *wish;
      if (column.unit.empty() && column.use == SheetColumn::Use::kColumn) column.unit = unit;
      if (column.name == kDeviationName) settle_sign_of_lengths(sheet, table, k, column);
      given |= column.name == columns::kDistance || column.name == kDeviationName;
      continue;
    }
    const Cells cells = cells_of(sheet, table, k);
    if (k == pairs.column) {
      column = column_of(kPairName, "", "its cells name two points");
      column.words = true;
    } else if (cells.numbers == 0 && cells.words == 0) {
      leave_column(column, "empty");
    } else if (cells.words > cells.numbers ||
               (cells.words == cells.numbers && said_by(heading) == Says::kNothing)) {
      column = column_of(sheet::name_from_words(heading.name), "", "words: a label of its rows");
      column.words = true;
    } else if (const auto dimension = unit.empty() ? std::nullopt : format::find_unit(unit);
               dimension && dimension->dimension != format::Dimension::kLength) {
      leave_column(column, "not a length");
    } else {
      const std::string why = "by its heading";
      switch (heads_counting(heading.name) ? Says::kSpread : said_by(heading)) {
        case Says::kNominal:
          column = column_of(kNominalName, unit, why);
          break;
        case Says::kUncertainty:
          column = column_of(columns::kUncertainty, unit, why);
          break;
        case Says::kMeasured:
          column = column_of(columns::kDistance, unit, why);
          measured.push_back(k);
          break;
        case Says::kDeviation:
          column = column_of(kDeviationName, unit, why);
          deviations.push_back(k);
          break;
        case Says::kMean:
          column = column_of(columns::kDistance, unit, "the mean of measured distances");
          means.push_back(k);
          break;
        case Says::kSpread:
          leave_column(column,
                       heads_counting(heading.name) ? "counts the rows" : "computed from the readings");
          break;
        case Says::kNothing:
          column = column_of(columns::kDistance, unit, "numbers of another heading: a measured distance");
          unknown.push_back(k);
          break;
      }
    }
  }
  const auto leave = [&](const std::vector<std::size_t>& list, const std::string& why) {
    for (const std::size_t k : list) leave_column(result[k], why);
  };
  if (given || !measured.empty()) {
    leave(means, "computed from the readings");
    leave(deviations, "follows from the measured distances");
    leave(unknown, "not the measured distance");
    if (given) leave(measured, "not the measured distance");
  } else if (!deviations.empty()) {
    for (const std::size_t k : deviations) settle_sign_of_lengths(sheet, table, k, result[k]);
    leave(means, "computed from the readings");
    leave(unknown, "not a deviation");
    measured = deviations;
  } else if (!unknown.empty()) {
    leave(means, "computed from the readings");
    measured = unknown;
  } else {
    measured = means;
  }
  if (given) return result;
  const auto without_heading = [&](std::size_t k) {
    return !table.has_headings || sheet.rows[table.heading_row][k].empty();
  };
  const std::string option = fmt::format("--column \"{}[mm]=HEADING\"", columns::kDistance);
  std::set<std::string> forms;
  for (const std::size_t k : measured) forms.insert(without_number(table.headings[k]));
  if (measured.empty())
    ask = fmt::format("no column has the measured distances: name it, {}", option);
  else if (measured.size() > 1 && std::any_of(measured.begin(), measured.end(), without_heading))
    ask = fmt::format(
        "the columns have no headings: name the measured distances by the number of the column, {0}=2\", and "
        "the nominal distances, {1}=3\"; repeated measurements are several columns with the name {2}",
        "--column \"" + std::string(columns::kDistance) + "[mm]",
        "--column \"" + std::string(kNominalName) + "[mm]", columns::kDistance);
  else if (forms.size() > 1)
    ask = fmt::format(
        "the columns {} may all have the measured distances: name the right one, {}, or leave the others "
        "out, "
        "--leave \"{}\"; repeated measurements have headings that differ by a number only (Ist 1, Ist 2)",
        names_of(table, measured), option, table.headings[measured.back()].text);
  return result;
}

}  // namespace vernier::importer
