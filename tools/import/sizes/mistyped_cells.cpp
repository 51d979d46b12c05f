// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/mistyped_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "tools/format/columns.h"
#include "tools/import/order/motion_directions.h"
#include "tools/import/sizes/expected_readings.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"

namespace vernier::importer {
namespace {

/// Distances of a mistyped value and of the corrected value from the expected one, in standard deviations.
/// Simulated tables (lead error, backlash, cyclic error, curve, normal noise of 0.3 to 3 um, 1 to 5 runs, 5
/// to 30 targets): no note in 5000 right tables; 5 give 2 notes in them. Of 118 lost minus signs that change
/// a value by more than 10 standard deviations of the noise, 100 get a note.
constexpr double kFarValue = 5.5;
constexpr double kNearValue = 2.5;
constexpr double kOtherUnit = 1000;       // um in a mm
constexpr std::size_t kMoreDecimals = 2;  // one more is a digit of the same instrument
constexpr std::size_t kMostMistyped = 2;  // more cells are no single errors
constexpr std::size_t kFewestUsual = 3;   // cells with the usual number of decimals
constexpr double kLargestCell = 1.5;      // a cell in the other unit is at most so many times the largest one
constexpr std::size_t kMostReadings = 20000;  // more are the log of an instrument, which nobody typed

enum class Typo { kLostMinus, kGainedMinus, kUnit, kUnitByDecimals };

struct Mistyped {
  std::size_t index = 0;
  Typo typo = Typo::kLostMinus;
};

struct TypedColumn {
  std::vector<PlacedReading> readings;
  std::vector<std::size_t> row, decimals;
};

TypedColumn typed_column(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SizedColumn>& columns, std::size_t k) {
  TypedColumn typed;
  const std::string direction = format::entry_of(format::AxisQuantity::kSense).prefix + columns[k].name;
  std::optional<std::size_t> run, sense, position;
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].use != SizedColumn::Use::kPosition) continue;
    if (columns[i].name == format::columns::kRun) run = i;
    if (columns[i].name == direction) sense = i;
    if (columns[i].name == columns[k].positions) position = i;
    if (columns[i].axis) axes.push_back(i);
  }
  if (!position) return typed;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, k), at = sheet::number_at(sheet, row, *position);
    if (!value || !at) continue;
    PlacedReading one;
    one.value = *value;
    one.position = *at;
    for (const std::size_t axis : axes) one.place += sheet.rows[row][axis] + ";";
    if (run) one.run = sheet.rows[row][*run];
    if (sense) one.sense = sense_said(sheet.rows[row][*sense]);
    typed.readings.push_back(std::move(one));
    typed.row.push_back(row);
    typed.decimals.push_back(sheet::decimals_of(sheet.rows[row][k], sheet.decimal_comma));
  }
  if (!sense) {
    std::vector<double> positions;
    for (const PlacedReading& one : typed.readings) positions.push_back(one.position);
    const std::vector<int> directions = directions_by_motion(positions, {});
    for (std::size_t i = 0; i < directions.size(); ++i) typed.readings[i].sense = directions[i];
  }
  return typed;
}

/// Does the corrected value agree with the expected one, by the best predictor, and is it nearer than the
/// value by all of them?
bool agrees(const TypedColumn& typed, const std::vector<ExpectedReadings>& expected, std::size_t i,
            double corrected, double rounding) {
  bool judged = false;
  for (const ExpectedReadings& one : expected) {
    if (!one.at[i]) continue;
    const double far = std::abs(typed.readings[i].value - one.at[i]->value),
                 near = std::abs(corrected - one.at[i]->value);
    if (near >= far) return false;
    if (judged) continue;
    judged = true;
    if (far < kFarValue * one.at[i]->scale || near > kNearValue * one.at[i]->scale + rounding) return false;
  }
  return judged;
}

/// Cells with more decimals than all others, whose value is in the range of the others if multiplied by 1000.
std::vector<Mistyped> cells_with_more_decimals(const TypedColumn& typed) {
  std::map<std::size_t, std::size_t> count;
  for (const std::size_t one : typed.decimals) ++count[one];
  if (count.size() < 2) return {};
  const std::size_t most = count.rbegin()->first, fewer = std::next(count.rbegin())->first;
  // Numbers with as many digits as they need have more decimals near zero. A zero at the end may be cut off.
  if (count.size() - count.count(0) > 2) return {};
  if (count.rbegin()->second > kMostMistyped || most < fewer + kMoreDecimals) return {};
  if (typed.decimals.size() < count.rbegin()->second + kFewestUsual) return {};
  double largest = 0;
  for (std::size_t i = 0; i < typed.decimals.size(); ++i)
    if (typed.decimals[i] != most) largest = std::max(largest, std::abs(typed.readings[i].value));
  std::vector<Mistyped> found;
  for (std::size_t i = 0; i < typed.decimals.size(); ++i)
    if (typed.decimals[i] == most && typed.readings[i].value != 0 &&
        kOtherUnit * std::abs(typed.readings[i].value) <= kLargestCell * largest)
      found.push_back({i, Typo::kUnitByDecimals});
  return found;
}

std::vector<Mistyped> mistyped_cells(const TypedColumn& typed) {
  std::vector<Mistyped> found = cells_with_more_decimals(typed);
  if (!found.empty() || typed.readings.empty() || typed.readings.size() > kMostReadings) return found;
  const std::size_t usual = *std::max_element(typed.decimals.begin(), typed.decimals.end());
  const std::vector<ExpectedReadings> expected =
      expected_readings(typed.readings, std::pow(10, -static_cast<double>(usual)));
  for (std::size_t i = 0; i < typed.readings.size(); ++i) {
    const double value = typed.readings[i].value;
    const double last_digit = std::pow(10, -static_cast<double>(typed.decimals[i]));
    if (value != 0 && agrees(typed, expected, i, -value, 0))
      found.push_back({i, value > 0 ? Typo::kLostMinus : Typo::kGainedMinus});
    else if (value != 0 && typed.decimals[i] > 0 &&
             agrees(typed, expected, i, kOtherUnit * value, kOtherUnit * last_digit / 2))
      found.push_back({i, Typo::kUnit});
  }
  if (found.size() > kMostMistyped) found.clear();
  return found;
}

/// What is strange about a cell, and the question to the user.
std::string text_of(Typo typo, const std::string& heading) {
  switch (typo) {
    case Typo::kLostMinus:
      return fmt::format(
          "the negative value agrees with the other readings of \"{}\", and this value does not: "
          "is a minus sign lost?",
          heading);
    case Typo::kGainedMinus:
      return fmt::format(
          "the positive value agrees with the other readings of \"{}\", and this value does not: "
          "is the minus sign wrong?",
          heading);
    case Typo::kUnit:
      return fmt::format(
          "1000 times this value agrees with the other readings of \"{}\", and this value does "
          "not: has the cell another unit?",
          heading);
    case Typo::kUnitByDecimals:
      break;
  }
  return fmt::format(
      "this cell of \"{}\" has more decimals than the other ones, and 1000 times its value agrees "
      "with them: has the cell another unit?",
      heading);
}

}  // namespace

void note_mistyped_cells(sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SizedColumn>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SizedColumn::Use::kDeviation || !sized_unit(columns[k])) continue;
    const TypedColumn typed = typed_column(sheet, table, columns, k);
    for (const Mistyped& one : mistyped_cells(typed)) {
      const std::size_t row = typed.row[one.index];
      const std::string place = fmt::format("line {}, \"{}\": ", sheet.line[row], sheet.rows[row][k]);
      const bool noted = std::any_of(sheet.notes.begin(), sheet.notes.end(),
                                     [&](const std::string& note) { return note.starts_with(place); });
      if (noted) continue;  // an outlier already
      sheet.notes.push_back(
          fmt::format("{}{} The value is read; if it is wrong, correct the cell or write - into it", place,
                      text_of(one.typo, table.headings[k].text)));
    }
  }
}

}  // namespace vernier::importer
