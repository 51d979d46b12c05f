// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/position_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string>

#include "tools/maths/median.h"

namespace vernier::importer {
namespace {

/// A row is far from its target if its difference is this many times as large as the largest one of the other
/// rows. Exchanged digits change a position by at least 9 of its last digits, a slipped decimal sign by nine
/// tenths; the deviations of a robot are 2 mm and of one size.
constexpr double kFar = 15;
constexpr double kVisible_mm = 0.5, kVisible_deg = 0.1;  // no difference is judged below this size
/// The same, if the differences of the other rows are equal to the last digit and show no scatter.
constexpr double kVisibleBesideEqual_mm = 5, kVisibleBesideEqual_deg = 1;
constexpr std::size_t kFewestRows = 4;  // fewer rows show no usual difference
constexpr double kTurn_deg = 360;
/// More rows than this share may be the usual ones, and the others a second set-up.
constexpr double kMostShare = 0.4;
/// No turn of a usual axis is longer: two turns in each direction.
constexpr double kMost_rad = 4 * std::numbers::pi;
/// Joints of a robot that move less than this in rad are not judged.
constexpr double kPlainly_rad = 1;
/// Whole numbers of radians are not a usual choice of targets. With this many of them, the unit is wrong.
constexpr std::size_t kFewestAngles = 3;

/// True if no other axis moves in a way that moves the point: the measured position of a linear axis follows
/// its target only while the rotary axes and the parallel axes stand still.
bool follows_target(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                    const std::vector<SizedColumn>& columns, std::size_t target) {
  const auto is_linear = [](const std::string& name) { return name == "X" || name == "Y" || name == "Z"; };
  if (!is_linear(columns[target].name)) return true;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (k == target || !columns[k].axis || is_linear(columns[k].name)) continue;
    std::set<double> values;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      if (const auto value = sheet::number_at(sheet, row, k)) values.insert(*value);
    if (values.size() > 1) return false;
  }
  return true;
}

/// Column with the target positions of a column of measured positions.
std::optional<std::size_t> target_of(const std::vector<SizedColumn>& columns, std::size_t measured) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == SizedColumn::Use::kPosition && columns[k].axis &&
        columns[k].name == columns[measured].measures)
      return k;
  return std::nullopt;
}

/// Difference of a measured position from its target, row after row, in mm or deg.
struct Difference {
  std::size_t row = 0;
  double from_target = 0, from_middle = 0;
};

std::vector<Difference> differences_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                       const std::vector<SizedColumn>& columns, std::size_t target,
                                       std::size_t reading) {
  const double of_target = sized_unit(columns[target])->factor,
               of_reading = sized_unit(columns[reading])->factor;
  const bool angle = sized_unit(columns[reading])->dimension == format::Dimension::kAngle;
  std::vector<Difference> list;
  std::vector<double> values;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto at = sheet::number_at(sheet, row, target), read = sheet::number_at(sheet, row, reading);
    if (!at || !read) continue;
    const double apart = *read * of_reading - *at * of_target;
    list.push_back({row, angle ? std::remainder(apart, kTurn_deg) : apart, 0});
    values.push_back(list.back().from_target);
  }
  if (list.empty()) return list;
  const double middle = maths::median(std::move(values));
  for (Difference& one : list) one.from_middle = std::abs(one.from_target - middle);
  std::sort(list.begin(), list.end(),
            [](const auto& a, const auto& b) { return a.from_middle < b.from_middle; });
  return list;
}

std::optional<SizeDoubt> far_row(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                 const std::vector<SizedColumn>& columns, std::size_t target,
                                 std::size_t reading) {
  const std::vector<Difference> sorted = differences_of(sheet, table, columns, target, reading);
  if (sorted.size() < kFewestRows) return std::nullopt;
  const bool angle = sized_unit(columns[reading])->dimension == format::Dimension::kAngle;
  constexpr double kEqual = 1e-9;  // rounding of the numbers
  const std::size_t most =
      std::max<std::size_t>(1, static_cast<std::size_t>(kMostShare * static_cast<double>(sorted.size())));
  for (std::size_t i = sorted.size() - most; i < sorted.size(); ++i) {
    const double usual = sorted[i - 1].from_middle;
    const bool equal = usual < kEqual;
    const double visible = angle   ? equal ? kVisibleBesideEqual_deg : kVisible_deg
                           : equal ? kVisibleBesideEqual_mm
                                   : kVisible_mm;
    if (sorted[i].from_middle < visible || sorted[i].from_middle < kFar * usual) continue;
    const auto first = std::min_element(sorted.begin() + static_cast<std::ptrdiff_t>(i), sorted.end(),
                                        [](const auto& a, const auto& b) { return a.row < b.row; });
    const std::size_t more = sorted.size() - i - 1;
    return SizeDoubt{
        reading, sheet.line[first->row], sheet.rows[first->row][reading],
        fmt::format("the measured position \"{0}\" differs from its target {1} by {2} in this row{3}, in the "
                    "other rows by at most {4} from their usual difference: correct the cell or its target; "
                    "if both are right, give --column \"{5}[{6}]={0}\"",
                    table.headings[reading].text, sheet.rows[first->row][target],
                    size_text(std::abs(first->from_target), angle),
                    more > 0 ? fmt::format(" (and so in {} more)", more) : "", size_text(usual, angle),
                    columns[reading].name, columns[reading].unit)};
  }
  return std::nullopt;
}

/// A number of a column, and half of the step of the last digit of the column.
struct Printed {
  double value = 0, half_digit = 0;
};

std::vector<Printed> printed_values(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                    std::size_t k) {
  std::vector<Printed> list;
  std::set<double> known;
  double finest = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, k);
    if (!value || !known.insert(*value).second) continue;
    const std::string& cell = sheet.rows[row][k];
    const auto sign = cell.find(sheet.decimal_comma ? ',' : '.');
    // Zeros at the end of all cells show no digit: a table may print 0.524 as 0.5240.
    const auto last = sign == std::string::npos ? sign : cell.find_last_not_of('0');
    finest = std::max(finest, sign == std::string::npos ? 0 : static_cast<double>(last - sign));
    list.push_back({*value, sign == std::string::npos ? 0 : static_cast<double>(cell.size() - sign - 1)});
  }
  for (Printed& one : list)  // the cell "0" shows no digits of its own
    one.half_digit = 0.5 * std::pow(10, -(one.value == 0 ? finest : std::min(one.half_digit, finest)));
  return list;
}

double largest_of(const std::vector<Printed>& values) {
  double largest = 0;
  for (const Printed& one : values) largest = std::max(largest, std::abs(one.value));
  return largest;
}

/// Whole degrees under a heading in rad.
bool are_degrees(const std::vector<Printed>& values) {
  const double largest = largest_of(values);
  const bool whole = std::all_of(values.begin(), values.end(),
                                 [](const Printed& one) { return one.value == std::floor(one.value); });
  const auto other =
      std::count_if(values.begin(), values.end(), [](const Printed& one) { return one.value != 0; });
  return largest > kMost_rad ||
         (whole && largest > std::numbers::pi && static_cast<std::size_t>(other) >= kFewestAngles);
}

/// True if all numbers but those near `zero` are fractions of a half turn away from it, to the last digit.
/// `roundings`: number of printed values in a difference.
bool are_fractions_of_a_half_turn(const std::vector<Printed>& values, double zero, double roundings) {
  for (const int parts : {2, 3, 4, 5, 6, 8, 9, 10, 12, 15, 16, 18, 20, 24, 30, 36}) {
    const double step = std::numbers::pi / parts;
    const bool all = std::all_of(values.begin(), values.end(), [&](const Printed& one) {
      // Spreadsheets cut digits off: a whole digit, and the rounding of the binary number.
      return std::abs(std::remainder(one.value - zero, step)) <= 2.001 * roundings * one.half_digit + 1e-12;
    });
    if (all) return true;
  }
  return false;
}

/// Fractions of a half turn in rad, to the last digit: 0.524 1.047 1.571 … 6.283, or the same with another
/// zero: 0.050 0.574 1.097 … Returns the zero; nullopt: the numbers show no radians.
std::optional<double> zero_of_radians(const std::vector<Printed>& values) {
  constexpr double kLeastResolution = 1000;  // largest value in steps of the last digit
  if (values.size() < kFewestAngles) return std::nullopt;
  const auto [least, most] =
      std::minmax_element(values.begin(), values.end(),
                          [](const Printed& one, const Printed& other) { return one.value < other.value; });
  double half_digit = 0;
  for (const Printed& one : values) half_digit = std::max(half_digit, one.half_digit);
  const double span = most->value - least->value, step = kLeastResolution * half_digit;
  const auto other =
      std::count_if(values.begin(), values.end(), [](const Printed& one) { return one.value != 0; });
  if (largest_of(values) <= kMost_rad && largest_of(values) >= step &&
      static_cast<std::size_t>(other) >= kFewestAngles && are_fractions_of_a_half_turn(values, 0, 1))
    return 0;
  // With another zero: more numbers, because each difference agrees by chance more often.
  if (values.size() <= kFewestAngles + 1 || span > kMost_rad || span < step) return std::nullopt;
  // By chance, a number between two fractions of 5 deg agrees with one of them with this probability.
  const double chance = 4 * 2.001 * half_digit / (std::numbers::pi / 36);
  constexpr double kByChance = 1e-6;  // of a table with right units
  if (!(std::pow(chance, static_cast<double>(values.size() - 1)) < kByChance)) return std::nullopt;
  if (are_fractions_of_a_half_turn(values, least->value, 2)) return least->value;
  return std::nullopt;
}

/// Positions in a unit below the millimetre that no machine moves by, and deviations that are no small part
/// of the motion: a heading in um above positions in mm.
constexpr double kSmallMachine_mm = 1;
/// Piezo stages without a scale have deviations of some per cent of their motion, and move by up to 0.2 mm.
constexpr double kPiezo_mm = 0.25;
constexpr double kLargeShare = 0.005;  // of the motion; stages with a scale are ten times as good

/// Size of the deviations of a position, mm: the median of the deviations, or the largest difference between
/// the measured positions and their targets, from their median.
std::optional<double> deviation_size(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                     const std::vector<SizedColumn>& columns, std::size_t position) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto unit = sized_unit(columns[k]);
    if (!unit || unit->dimension != format::Dimension::kLength) continue;
    std::vector<double> sizes;
    if (columns[k].use == SizedColumn::Use::kDeviation && columns[k].positions == columns[position].name) {
      // Exchanged units of two headings: judge_deviation_sizes() states them.
      if (unit->factor > sized_unit(columns[position])->factor) return std::nullopt;
      for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
        if (const auto value = sheet::number_at(sheet, row, k))
          sizes.push_back(std::abs(*value) * unit->factor);
    } else if (!columns[k].measures.empty() && columns[k].measures == columns[position].name) {
      const std::vector<Difference> list = differences_of(sheet, table, columns, position, k);
      if (!list.empty()) return list.back().from_middle;
    }
    if (!sizes.empty()) return maths::median(std::move(sizes));
  }
  return std::nullopt;
}

}  // namespace

std::vector<SizeDoubt> judge_measured_positions(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                                const std::vector<SizedColumn>& columns) {
  std::vector<SizeDoubt> doubts;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SizedColumn::Use::kPosition || columns[k].measures.empty()) continue;
    const auto at = target_of(columns, k);
    if (!at || !sized_unit(columns[*at]) || !sized_unit(columns[k]) ||
        sized_unit(columns[*at])->dimension != sized_unit(columns[k])->dimension)
      continue;
    if (!follows_target(sheet, table, columns, *at)) continue;
    const auto doubt = far_row(sheet, table, columns, *at, k);
    // A profile was made from another file: its cells may be wrong.
    if (doubt && columns[k].stated && !columns[k].profile)
      sheet.notes.push_back(fmt::format("line {}, \"{}\": {}", doubt->line, doubt->word,
                                        doubt->text.substr(0, doubt->text.find(": correct the cell"))));
    else if (doubt)
      doubts.push_back(*doubt);
  }
  return doubts;
}

void remove_whole_turns(sheet::Sheet& sheet, const sheet::SheetTable& table,
                        const std::vector<SizedColumn>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SizedColumn::Use::kPosition || columns[k].measures.empty() ||
        columns[k].unit != "deg")
      continue;
    const auto at = target_of(columns, k);
    if (!at || columns[*at].unit != "deg") continue;
    std::size_t changed = 0;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const auto set = sheet::number_at(sheet, row, *at), read = sheet::number_at(sheet, row, k);
      if (!set || !read) continue;
      const double turns = std::round((*read - *set) / kTurn_deg);
      if (turns == 0) continue;
      std::string& cell = sheet.rows[row][k];
      const char sign = sheet.decimal_comma ? ',' : '.';
      const auto point = cell.find(sign);
      cell = fmt::format("{:.{}f}", *read - turns * kTurn_deg,
                         point == std::string::npos ? 0 : cell.size() - point - 1);
      if (const auto dot = cell.find('.'); dot != std::string::npos) cell[dot] = sign;
      ++changed;
    }
    if (changed > 0)
      sheet.notes.push_back(
          fmt::format("{} measured positions of \"{}\" differ from their target by whole turns, which are "
                      "removed (359.999 "
                      "at 0 deg is read as -0.001)",
                      changed, table.headings[k].text));
  }
}

std::vector<SizeDoubt> judge_angle_units(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                         const std::vector<SizedColumn>& columns) {
  std::vector<SizeDoubt> doubts;
  std::vector<std::size_t> small;  // joints in deg that would move over a half turn in rad
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SizedColumn& column = columns[k];
    const bool angles = column.use == SizedColumn::Use::kPosition && !column.stated &&
                        (column.axis || !column.measures.empty());
    if (!angles || (column.unit != "rad" && column.unit != "deg")) continue;
    const std::vector<Printed> values = printed_values(sheet, table, k);
    const double largest = largest_of(values);
    if (column.axis && column.unit == "deg" && largest <= std::numbers::pi && largest > kPlainly_rad)
      small.push_back(k);
    const bool degrees = column.unit == "rad" && are_degrees(values);
    const auto zero = column.unit == "deg" ? zero_of_radians(values) : std::nullopt;
    if (!degrees && !zero) continue;
    const std::string& heading = table.headings[k].text;
    const char* const other = degrees ? "deg" : "rad";
    doubts.push_back(
        {k, sheet.line[table.heading_row], "",
         fmt::format(
             "the positions go to {:.6g}, {}: {} under a heading in {}; correct the unit of the "
             "heading to [{}]; if [{}] is right, give --column \"{}[{}]={}\"",
             largest,
             degrees ? largest > kMost_rad
                           ? fmt::format("{:.3g} turns in rad", largest / (2 * std::numbers::pi))
                           : std::string("and all are whole numbers")
             : *zero == 0
                 ? std::string("and all are fractions of a half turn in rad")
                 : fmt::format("and all differ from {:.6g} by fractions of a half turn in rad", *zero),
             degrees ? "degrees" : "radians", column.unit, other, column.unit, column.name, column.unit,
             heading)});
  }
  constexpr std::size_t kJoints = 3;  // the axes of a robot, not those of a rotary table
  if (doubts.empty() && small.size() >= kJoints)
    sheet.notes.push_back(fmt::format(
        "the positions of {} rotary axes are between -{:.2f} and {:.2f} deg: if they are in radians, correct "
        "the units of their headings to [rad] (or give --column \"{}[rad]={}\" and so on)",
        small.size(), std::numbers::pi, std::numbers::pi, columns[small.front()].name,
        table.headings[small.front()].text));
  return doubts;
}

std::vector<SizeDoubt> judge_small_motions(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                           const std::vector<SizedColumn>& columns) {
  std::vector<SizeDoubt> doubts;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto unit = sized_unit(columns[k]);
    if (columns[k].use != SizedColumn::Use::kPosition || !columns[k].axis || columns[k].stated || !unit ||
        unit->dimension != format::Dimension::kLength || unit->factor >= 1)
      continue;
    const std::vector<Printed> values = printed_values(sheet, table, k);
    if (values.size() < kFewestRows) continue;
    const auto [least, most] =
        std::minmax_element(values.begin(), values.end(),
                            [](const Printed& one, const Printed& other) { return one.value < other.value; });
    const double motion_mm = (most->value - least->value) * unit->factor;
    const auto size_mm = deviation_size(sheet, table, columns, k);
    if (motion_mm >= kSmallMachine_mm || !size_mm) continue;
    const std::string text = fmt::format(
        "the positions go from {:.6g} to {:.6g} {}, so {} would move by {} only, with deviations of {}; if "
        "the "
        "positions are in mm, correct the unit of the heading to [mm]; if [{}] is right, give --column "
        "\"{}[{}]={}\"",
        least->value, most->value, columns[k].unit, columns[k].name, size_text(motion_mm),
        size_text(*size_mm), columns[k].unit, columns[k].name, columns[k].unit, table.headings[k].text);
    if (motion_mm > kPiezo_mm && *size_mm > kLargeShare * motion_mm)
      doubts.push_back({k, sheet.line[table.heading_row], "", text});
    else
      sheet.notes.push_back(fmt::format("\"{}\": {}", table.headings[k].text, text));
  }
  return doubts;
}

}  // namespace vernier::importer
