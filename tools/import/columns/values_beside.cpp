// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/values_beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/words/doubtful_words.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/stated_directions.h"
#include "tools/maths/median.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// Largest error of a machine as a share of its travel (kImplausibleShare in deviation_sizes.cpp).
constexpr double kErrorOfTravel = 0.05;
constexpr std::size_t kRowsOfPattern = 4;  // fewer rows show no pattern
constexpr int kShownDecimals = 6;          // of a mm: below every instrument

/// The factors of two units of one dimension. Two columns without a unit have the same one if their values
/// agree.
std::optional<std::pair<double, double>> factors_of(const ColumnPair& pair) {
  if (pair.position_unit.empty() && pair.reading_unit.empty()) return std::pair(1.0, 1.0);
  const auto from = format::find_unit(pair.position_unit), to = format::find_unit(pair.reading_unit);
  const bool stated = from && to && !pair.position_unit.empty() && !pair.reading_unit.empty();
  if (!stated || from->dimension != to->dimension) return std::nullopt;
  return std::pair(from->factor, to->factor);
}

double range_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

/// The numbers of a column, row by row; empty if a filled cell is no number.
std::vector<std::pair<std::size_t, double>> numbers_of(const sheet::Sheet& sheet,
                                                       const sheet::SheetTable& table, std::size_t column) {
  std::vector<std::pair<std::size_t, double>> values;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (is_missing(sheet.rows[row][column])) continue;
    const auto value = sheet::number_at(sheet, row, column);
    if (!value) return {};
    values.emplace_back(row, *value);
  }
  return values;
}

/// True for a word of a dial gauge or of another instrument with a pointer.
bool names_dial(const std::string& text) {
  constexpr std::array<std::string_view, 8> kParts = {"uhr", "dial",   "gauge",  "indicator",
                                                      "skt", "zeiger", "taster", "comparator"};
  const std::string small = text::in_small_letters(text);
  return std::any_of(kParts.begin(), kParts.end(),
                     [&](std::string_view part) { return small.find(part) != std::string::npos; });
}

bool titles_name_dial(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  const std::vector<std::string> titles = title_cells(sheet, table);
  return std::any_of(titles.begin(), titles.end(), names_dial);
}

/// The column with the numbers 1 to n of the positions.
std::optional<std::size_t> column_of_numbers(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                             const std::vector<std::string>& units) {
  std::optional<std::size_t> numbers;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    const bool target = Guess::bare(table.headings[k].name) == Guess::Bare::kTarget;
    if (target && units[k].empty() && numbers_positions(sheet, table, k)) {
      numbers = k;
      continue;
    }
    // Another column has the positions.
    const bool length = units[k] == "mm" || units[k] == "m" || units[k] == "in" || units[k] == "deg";
    if ((target || length) && !numbers_of(sheet, table, k).empty()) return std::nullopt;
  }
  return numbers;
}

/// Two columns with the begin and the end of each step, and a column with the measured length of the step.
struct StepColumns {
  std::size_t from = 0, to = 0, length = 0;
};

std::optional<StepColumns> columns_of_steps(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                            const std::vector<std::string>& units) {
  std::vector<std::vector<std::pair<std::size_t, double>>> values;
  for (std::size_t k = 0; k < table.headings.size(); ++k) values.push_back(numbers_of(sheet, table, k));
  const auto alike = [&](std::size_t a, std::size_t b) {
    return a != b && values[a].size() >= kRowsOfPattern && values[a].size() == values[b].size() &&
           units[a] == units[b];
  };
  for (std::size_t a = 0; a < values.size(); ++a)
    for (std::size_t b = 0; b < values.size(); ++b) {
      if (!alike(a, b)) continue;
      bool chain = true;
      for (std::size_t i = 0; i + 1 < values[a].size(); ++i)
        chain &= values[b][i].second == values[a][i + 1].second && values[b][i].second != values[a][i].second;
      for (std::size_t c = 0; chain && c < values.size(); ++c) {
        if (c == a || !alike(b, c)) continue;
        bool steps = true;
        for (std::size_t i = 0; i < values[c].size(); ++i) {
          const double step = std::abs(values[b][i].second - values[a][i].second);
          steps &= std::abs(std::abs(values[c][i].second) - step) < kErrorOfTravel * step;
        }
        if (steps) return StepColumns{a, b, c};
      }
    }
  return std::nullopt;
}

/// A column beside the readings that is no reading: a statistic, a tolerance, an uncertainty.
bool says_statistic_or_limit(const sheet::Heading& heading) {
  static const std::set<std::string> kOther = {
      "toleranz", "tolerance",        "tol",   "grenze", "limit", "unsicherheit", "uncertainty",
      "u",        "messunsicherheit", "stabw", "std"};
  const std::vector<std::string> words = plain_words(heading.name);
  // A word for a deviation: the proposal reads it ("Summenabweichung" before "Einzelabweichung").
  const std::string small = text::in_small_letters(heading.name);
  for (const char* part : {"abweich", "fehler", "deviat", "error"})
    if (small.find(part) != std::string::npos) return true;
  return names_statistic(heading) || std::any_of(words.begin(), words.end(), [](const std::string& word) {
           return kOther.contains(word);
         });
}

/// Means of the readings in each approach direction, and no readings: the user may read both of them.
std::string means_of_directions(const sheet::SheetTable& table) {
  std::string forth, back;
  for (const sheet::Heading& heading : table.headings) {
    const std::vector<std::string> words = heading_words(text::in_small_letters(heading.name));
    int sense = 0;
    bool mean = false;
    for (const std::string& word : words) {
      if (sense_said(word) != 0 && !says_statistic(word)) sense = sense_said(word);
      mean |= word.starts_with("mittel") || word == "mean" || word == "average" || word == "avg";
    }
    if (!mean || sense == 0) continue;
    std::string& found = sense > 0 ? forth : back;
    if (!found.empty()) return "";
    found = heading.text;
  }
  if (forth.empty() || back.empty()) return "";
  return fmt::format(
      "\"{}\" and \"{}\" are means of the readings in each approach direction: to read both of "
      "them, write Abweichung in place of the word for the mean in both headings (Abweichung vor [um], "
      "Abweichung zurück [um])",
      forth, back);
}

/// Two or more columns with one unit whose values are small beside the positions, and no heading says what
/// they are: an option would read one of them, and the others would be lost.
std::string several_deviations(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                               const std::vector<std::string>& units) {
  const auto position = column_of_positions(table);
  if (!position) return "";
  const SheetWishes usual;
  const Guess guess(usual);
  std::vector<std::size_t> small;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    const SheetColumn column = guess.column(table.headings[k]);
    const bool other = k == *position || column.use != SheetColumn::Use::kColumn || units[k].empty() ||
                       is_known_name(column.name) || guess.is_axis(column.name) ||
                       says_statistic_or_limit(table.headings[k]);
    if (other ||
        values_beside(sheet, table, {*position, k, units[*position], units[k]}) != Values::kDeviations)
      continue;
    if (!small.empty() && units[small.front()] != units[k]) return "";
    small.push_back(k);
  }
  constexpr std::size_t kFewest = 2;  // columns; one alone may be what the user wants
  if (small.size() < kFewest) return "";
  std::string names;
  for (const std::size_t k : small)
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", table.headings[k].text);
  const std::string& unit = units[small.front()];
  return fmt::format(
      "the values of {0} are small compared with the positions, and --deviation would read one of these "
      "columns "
      "only: if they are deviations, one column for each approach direction, write Abweichung vor [{1}] and "
      "Abweichung zurück [{1}] as their headings; if they are runs, write Lauf 1 + [{1}], Lauf 1 - [{1}] (+ "
      "and "
      "- are the approach directions)",
      names, unit);
}

/// Notes measured positions, as the user states, whose values are not those of the axis.
void note_other_values(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SizedColumn>& columns, std::size_t k) {
  if (columns[k].measures.empty() || !columns[k].stated) return;
  const auto position = std::find_if(columns.begin(), columns.end(), [&](const SizedColumn& one) {
    return one.axis && one.name == columns[k].measures;
  });
  if (position == columns.end()) return;
  const ColumnPair pair{static_cast<std::size_t>(position - columns.begin()), k, position->unit,
                        columns[k].unit};
  const std::string work = work_before_reading(sheet, table, values_beside(sheet, table, pair), pair);
  if (!work.empty())
    sheet.notes.push_back(
        fmt::format("\"{}\" is read as the measured position of {}, as given; if it is this "
                    "position, {}",
                    table.headings[k].text, columns[k].measures, work));
}

}  // namespace

Values values_beside(const sheet::Sheet& sheet, const sheet::SheetTable& table, const ColumnPair& pair) {
  const bool no_units = pair.position_unit.empty() && pair.reading_unit.empty();
  const auto factors = factors_of(pair);
  if (!factors) return Values::kUnclear;
  std::vector<double> at, value, size, apart, sum, step;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto a = sheet::number_at(sheet, row, pair.position),
               b = sheet::number_at(sheet, row, pair.reading);
    if (!a || !b) continue;
    if (!at.empty()) step.push_back(std::abs(*b * factors->second - (*a * factors->first - at.back())));
    at.push_back(*a * factors->first);
    value.push_back(*b * factors->second);
    size.push_back(std::abs(value.back()));
    apart.push_back(std::abs(value.back() - at.back()));
    sum.push_back(value.back() + at.back());
  }
  if (at.size() < kRowsOfPattern) return Values::kUnclear;
  const double travel = range_of(at);
  if (!(travel > 0)) return Values::kUnclear;
  if (no_units && !(maths::median(apart) < kErrorOfTravel * travel)) return Values::kUnclear;
  if (!no_units && *std::max_element(size.begin(), size.end()) < kErrorOfTravel * travel)
    return Values::kDeviations;
  if (maths::median(apart) < kErrorOfTravel * travel) return Values::kPositions;
  if (range_of(sum) < kErrorOfTravel * travel)
    return std::abs(maths::median(sum)) < kErrorOfTravel * travel ? Values::kOpposite : Values::kFalling;
  // The steps are a part of the travel: they agree within a twentieth of themselves.
  if (maths::median(step) < kErrorOfTravel * maths::median(size)) return Values::kSteps;
  return Values::kUnclear;
}

std::string work_before_reading(const sheet::Sheet& sheet, const sheet::SheetTable& table, Values values,
                                const ColumnPair& pair) {
  const std::string& heading = table.headings[pair.reading].text;
  if (values == Values::kOpposite)
    return fmt::format(
        "first change the sign of \"{}\" in the file: its values are the positions with the "
        "opposite sign",
        heading);
  if (values == Values::kSteps)
    return fmt::format(
        "first replace the values of \"{}\" in the file by their sums from the first row to each "
        "row: the values are the steps from row to row",
        heading);
  if (values != Values::kFalling) return "";
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto a = sheet::number_at(sheet, row, pair.position),
               b = sheet::number_at(sheet, row, pair.reading);
    const auto factors = factors_of(pair);
    if (!a || !b || !factors) continue;
    return fmt::format(
        "first replace each value of \"{}\" in the file by {} minus the value: the values fall "
        "where the positions rise",
        heading, text::fixed_text(*b + *a * factors->first / factors->second, kShownDecimals));
  }
  return "";
}

std::optional<SizeDoubt> doubt_of_dial(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                       std::size_t column, const std::string& unit) {
  constexpr double kTurn_mm = 1;  // of a dial gauge with divisions of 0.01 mm (ISO 463)
  constexpr double kJump = 0.5;   // of a turn: a larger step is shorter the other way round
  const bool divisions = unit == "0.01mm";
  const auto known = format::find_unit(unit);
  if (!known || unit.empty() ||
      (!divisions &&
       !(unit == "mm" && (names_dial(table.headings[column].text) || titles_name_dial(sheet, table)))))
    return std::nullopt;
  std::optional<double> before;
  std::size_t jump_row = 0, rows = 0;
  std::string from, to;
  bool steady = true;  // the readings are smooth if the pointer passed zero at each jump
  for (const auto& [row, value] : numbers_of(sheet, table, column)) {
    const double mm = value * known->factor;
    if (mm < 0 || mm >= kTurn_mm) return std::nullopt;
    if (before && std::abs(mm - *before) > kJump * kTurn_mm) {
      if (jump_row == 0) {
        jump_row = row;
        to = sheet.rows[row][column];
      }
      steady &= kTurn_mm - std::abs(mm - *before) < kJump * kTurn_mm / 2;
    } else if (jump_row == 0) {
      from = sheet.rows[row][column];
    }
    before = mm;
    ++rows;
  }
  if (jump_row == 0 || !steady || rows < kRowsOfPattern) return std::nullopt;
  const double turn = kTurn_mm / known->factor, jumped = *sheet::number_at(sheet, jump_row, column);
  const bool falls = jumped * known->factor < kJump * kTurn_mm;  // the pointer passed zero upward: 85, 4
  return SizeDoubt{
      column, sheet.line[jump_row], to,
      fmt::format(
          "the reading goes from {0} to {1} between two rows, nearly a whole turn of a dial gauge: if the "
          "pointer passed zero, {2} {3} {4} each value in the file from this row on, up to the row where the "
          "reading jumps back ({1} becomes {5}), and give --sign if the dial runs against the axis",
          from, to, falls ? "add" : "subtract", text::fixed_text(turn, kShownDecimals), falls ? "to" : "from",
          text::fixed_text(falls ? jumped + turn : jumped - turn, kShownDecimals))};
}

std::vector<SizeDoubt> judge_raw_readings(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const std::vector<SizedColumn>& columns) {
  std::vector<SizeDoubt> doubts;
  if (!table.has_headings) return doubts;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    note_other_values(sheet, table, columns, k);
    if (columns[k].use != SizedColumn::Use::kDeviation) continue;
    const std::string& heading = table.headings[k].text;
    const std::string option = fmt::format("--deviation \"{}[{}]={}\"", columns[k].name,
                                           columns[k].unit.empty() ? "um" : columns[k].unit, heading);
    if (auto dial = doubt_of_dial(sheet, table, k, columns[k].unit)) {
      if (columns[k].stated) {
        sheet.notes.push_back(fmt::format("\"{}\", line {}: {}", heading, dial->line, dial->text));
      } else {
        dial->text += "; if the values are right, give " + option;
        doubts.push_back(std::move(*dial));
      }
    }
  }
  return doubts;
}

std::string text_of_numbered_positions(const sheet::Heading& heading) {
  return fmt::format(
      "\"{0}\" has the numbers of the positions and not the positions: write a column with the "
      "positions beside it (heading Soll X [mm]); if the axis was at 1, 2, 3 ..., write their unit "
      "in the heading ({0} [mm])",
      heading.text);
}

std::string no_assignment(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::vector<std::string>& units) {
  if (!table.has_headings) return "";
  const SheetWishes usual;
  const Guess guess(usual);
  const bool axis = std::any_of(table.headings.begin(), table.headings.end(), [&](const sheet::Heading& one) {
    return guess.is_axis(guess.column(one).name);
  });
  if (const auto numbers = axis ? std::nullopt : column_of_numbers(sheet, table, units))
    return text_of_numbered_positions(table.headings[*numbers]);
  if (const std::string means = means_of_directions(table); !means.empty()) return means;
  if (const auto steps = columns_of_steps(sheet, table, units))
    return fmt::format(
        "each row has the length of a step from \"{0}\" to \"{1}\", and not the position: write one "
        "row for each position, with the position (\"{1}\") below Soll X and the sum of \"{2}\" from "
        "the first row to this row below Ist X, and a first row with the position where the first "
        "step begins, twice",
        table.headings[steps->from].text, table.headings[steps->to].text, table.headings[steps->length].text);
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (numbers_of(sheet, table, k).empty()) continue;
    if (states_increments(table.headings[k].name, true) ||
        may_state(table.headings[k].name, Doubtful::kIncrements))
      return fmt::format(
          "by its heading the values of \"{0}\" are increments, each from the position before: replace "
          "each value in the file by the sum of the values up to it in its run, and write Abweichung "
          "in the heading",
          table.headings[k].text);
    if (const auto dial = doubt_of_dial(sheet, table, k, units[k]))
      return fmt::format("\"{}\", line {}: {}; then write Abweichung in the heading", table.headings[k].text,
                         dial->line, dial->text);
  }
  return several_deviations(sheet, table, units);
}

}  // namespace vernier::importer
