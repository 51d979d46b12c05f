// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/column_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/values_beside.h"
#include "tools/maths/median.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {
namespace {

using Use = SheetColumn::Use;

/// A measured position follows its target with the slope 1 to within this value, a deviation with the slope
/// 0. No machine has a scale error of a twentieth.
constexpr double kSlope = 0.05;
/// Without two targets, one of target and reading is this share of the other one.
constexpr double kSmall = 0.05;
/// A deviation that does not change is smaller than this share of the travel.
constexpr double kShareOfTravel = 0.02;
/// Positions in a wrong unit follow the target with the ratio of the units. A true scale error is never
/// within this share of such a ratio.
constexpr double kSameRatio = 0.01;

/// Axes with a reading along or about them, reading_of.
constexpr std::array kAxes = {"X", "Y", "Z", "A", "B", "C"};

/// Values of one cell pair after another: target, reading; mm if their units are known.
struct Pairs {
  std::vector<double> target, reading;
};

double factor_of(const std::string& unit) {
  const auto found = format::find_unit(unit);
  return unit.empty() || !found ? 1 : found->factor;
}

Pairs pairs_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
               const std::vector<SheetColumn>& columns, std::size_t target, std::size_t reading) {
  const double of_target = factor_of(columns[target].unit);
  // A reading without a unit counts in the unit of the target.
  const double of_reading = columns[reading].unit.empty() ? of_target : factor_of(columns[reading].unit);
  Pairs pairs;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto at = sheet::number_at(sheet, row, target), read = sheet::number_at(sheet, row, reading);
    if (!at || !read) continue;
    pairs.target.push_back(*at * of_target);
    pairs.reading.push_back(*read * of_reading);
  }
  return pairs;
}

std::optional<std::size_t> column_named(const std::vector<SheetColumn>& columns, const std::string& name) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == Use::kColumn && columns[k].name == name) return k;
  return std::nullopt;
}

double span_of(const std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

/// Median of the slopes of all pairs of points (Theil 1950; Sen 1968): one wrong cell does not change it.
/// nullopt: the target has one value.
std::optional<double> slope_of(const Pairs& pairs) {
  constexpr std::size_t kMost = 200;  // points that are compared with one another
  const std::size_t n = pairs.target.size(), stride = n / kMost + 1;
  std::vector<double> slopes;
  for (std::size_t i = 0; i < n; i += stride)
    for (std::size_t k = i + stride; k < n; k += stride)
      if (const double moved = pairs.target[k] - pairs.target[i]; moved != 0)
        slopes.push_back((pairs.reading[k] - pairs.reading[i]) / moved);
  if (slopes.empty()) return std::nullopt;
  return maths::median(std::move(slopes));
}

/// The ratio of two units of length that a slope is, if the readings follow the line; else empty.
std::string ratio_of_units(const Pairs& pairs, double slope) {
  constexpr std::array<std::pair<double, const char*>, 4> kRatios = {
      {{1e-3, "1/1000"}, {1e3, "1000"}, {1 / 25.4, "1/25.4"}, {25.4, "25.4"}}};
  std::vector<double> left;
  for (std::size_t i = 0; i < pairs.target.size(); ++i)
    left.push_back(pairs.reading[i] - slope * pairs.target[i]);
  const double middle = maths::median(left);
  for (double& one : left) one = std::abs(one - middle);
  if (maths::median(left) > kSlope * std::abs(slope) * span_of(pairs.target)) return "";
  for (const auto& [ratio, text] : kRatios)
    if (std::abs(slope / ratio - 1) < kSameRatio) return text;
  return "";
}

/// What the values of a column are beside the target of its axis.
enum class Nature { kPosition, kDeviation, kUnclear };

Nature nature_of(const Pairs& pairs) {
  std::vector<double> target, reading, apart;
  for (std::size_t i = 0; i < pairs.target.size(); ++i) {
    target.push_back(std::abs(pairs.target[i]));
    reading.push_back(std::abs(pairs.reading[i]));
    apart.push_back(std::abs(pairs.reading[i] - pairs.target[i]));
  }
  const double size = maths::median(reading);
  if (const auto slope = slope_of(pairs)) {
    if (std::abs(*slope - 1) < kSlope) return Nature::kPosition;
    const bool small = size < kShareOfTravel * std::max(span_of(pairs.target), maths::median(target));
    return std::abs(*slope) < kSlope && small ? Nature::kDeviation : Nature::kUnclear;
  }
  if (maths::median(apart) < kSmall * maths::median(target)) return Nature::kPosition;
  return size < kSmall * maths::median(target) ? Nature::kDeviation : Nature::kUnclear;
}

/// Does another component of the measured point follow this axis, and not its own one? Then the readings are
/// in a frame that is turned against the machine.
bool is_turned_frame(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                     const std::vector<SheetColumn>& columns, std::size_t target, std::size_t reading) {
  for (const char* const axis : kAxes) {
    const auto other = column_named(columns, *reading_of(axis));
    if (!other || *other == reading || columns[*other].name == columns[reading].name) continue;
    if (const auto own = column_named(columns, axis))
      if (nature_of(pairs_of(sheet, table, columns, *own, *other)) != Nature::kUnclear) continue;
    const auto slope = slope_of(pairs_of(sheet, table, columns, target, *other));
    if (slope && std::abs(*slope) > kSlope) return true;
  }
  return false;
}

std::string length_text(double mm) {
  return mm < 1 ? fmt::format("{:.3g} um", mm * 1e3) : fmt::format("{:.6g} mm", mm);
}

/// The two ways to state what a column is.
std::string ways_to_read(const sheet::Heading& heading, const std::string& axis, const SheetColumn& column) {
  const std::string unit = column.unit.empty() ? "" : "[" + column.unit + "]";
  return fmt::format(
      "--column \"{}{}={}\" for a measured position, or --deviation \"{}{}={}\" for a deviation",
      *reading_of(axis), unit, heading.text, axis, unit, heading.text);
}

void settle_reading(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                    std::vector<SheetColumn>& columns, std::size_t target, std::size_t k) {
  const sheet::Heading& heading = table.headings[k];
  SheetColumn& column = columns[k];
  const std::string& axis = columns[target].name;
  const Pairs pairs = pairs_of(sheet, table, columns, target, k);
  if (pairs.target.empty()) return;
  const text::Place place{sheet.file, sheet.line[table.heading_row]};
  const Nature nature = nature_of(pairs);
  const double slope = slope_of(pairs).value_or(0);
  const std::string ratio = ratio_of_units(pairs, slope);
  const bool units_differ = !ratio.empty() && !column.unit.empty() && pairs.target.size() > 2;
  if (column.use == Use::kDeviation) {
    if (nature == Nature::kPosition && slope != 0)
      throw text::InputError(
          place, heading.text,
          fmt::format("the values follow {}, so they are positions and not deviations; give "
                      "--column \"{}{}={}\"",
                      axis, *reading_of(axis), column.unit.empty() ? "" : "[" + column.unit + "]",
                      heading.text));
    if (units_differ && slope > 1)
      throw text::InputError(place, heading.text,
                             fmt::format("the values follow {} with the ratio {}, so they are positions in "
                                         "another unit and not deviations; correct the heading",
                                         axis, ratio));
    return;
  }
  column.by_values = true;
  if (nature == Nature::kPosition) return;
  if (units_differ)
    throw text::InputError(place, heading.text,
                           fmt::format("the values follow {} with the ratio {}, so they are positions, and "
                                       "the unit of one of the two columns is wrong; correct the heading",
                                       axis, ratio));
  if (is_turned_frame(sheet, table, columns, target, k)) return;
  if (nature == Nature::kUnclear) {
    // A target that is always 0 has positions that are its deviations.
    if (span_of(pairs.target) == 0 && pairs.target.front() == 0) return;
    const bool alone = std::none_of(columns.begin(), columns.end(), [&](const SheetColumn& other) {
      return &other != &column && other.use == Use::kColumn && other.name != column.name &&
             std::any_of(kAxes.begin(), kAxes.end(),
                         [&](const char* one) { return other.name == *reading_of(one); });
    });
    constexpr std::size_t kEnough = 3;  // fewer rows show nothing
    if (!alone || pairs.target.size() < kEnough) return;
    const ColumnPair pair{target, k, columns[target].unit, column.unit};
    if (const std::string work = work_before_reading(sheet, table, values_beside(sheet, table, pair), pair);
        !work.empty())
      throw text::InputError(place, heading.text,
                             fmt::format("the values are not the positions of {}: {}", axis, work));
    throw text::InputError(
        place, heading.text,
        fmt::format("the values are neither positions of {} nor small deviations from them; state the "
                    "meaning: {}",
                    axis, ways_to_read(heading, axis, column)));
  }
  column.use = Use::kDeviation;
  column.name = axis;
  const bool angle = format::angle_about(axis).has_value();
  const auto shown = [&](double value, const std::string& unit) {
    return unit.empty() ? fmt::format("{:.3g}", value)
           : angle      ? fmt::format("{:.3g} deg", value)
                        : length_text(value);
  };
  column.why =
      fmt::format("by its values: they span {}, {} spans {}", shown(span_of(pairs.reading), column.unit),
                  axis, shown(span_of(pairs.target), columns[target].unit));
}

}  // namespace

std::string other_decimal_sign(const sheet::Sheet& sheet) {
  return fmt::format(
      "this cell has a decimal {}, and the table is read with a decimal {}; write the cells of the file with "
      "one decimal sign (find and replace in this column), because --decimal applies to all cells",
      sheet.decimal_comma ? "point" : "comma", sheet.decimal_comma ? "comma" : "point");
}

void settle_by_values(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                      std::vector<SheetColumn>& columns) {
  if (!table.has_headings) return;
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (const char* const axis : kAxes) {
      const bool by_heading = columns[k].why == "by its heading";
      // A heading that is written as in the measurement file has its meaning.
      const bool is_reading = columns[k].use == Use::kColumn && columns[k].name == *reading_of(axis) &&
                              by_heading && table.headings[k].name != columns[k].name;
      const bool is_deviation = columns[k].use == Use::kDeviation && columns[k].name == axis;
      if (!is_reading && !is_deviation) continue;
      if (const auto target = column_named(columns, axis)) settle_reading(sheet, table, columns, *target, k);
      break;
    }
}

namespace {

/// The columns of one axis: its target and its readings.
struct AxisBlock {
  std::size_t target = 0, first = 0, last = 0;
  bool read = false;
};

/// Share of the steps from row to row at which both targets change; 1 if a row has only one of them.
double moved_together(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t one,
                      std::size_t other) {
  double steps = 0, both = 0;
  std::optional<std::size_t> before;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string &a = sheet.rows[row][one], &b = sheet.rows[row][other];
    if (a.empty() != b.empty()) return 1;
    if (a.empty()) continue;
    if (before) {
      ++steps;
      both += a != sheet.rows[*before][one] && b != sheet.rows[*before][other] ? 1 : 0;
    }
    before = row;
  }
  return steps > 0 ? both / steps : 0;
}

}  // namespace

void refuse_tables_side_by_side(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SheetColumn>& columns) {
  if (!table.has_headings) return;
  std::vector<AxisBlock> blocks;
  for (const char* const axis : kAxes) {
    const auto target = column_named(columns, axis);
    if (!target) continue;
    AxisBlock block{*target, *target, *target, false};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const bool reading = (columns[k].use == Use::kColumn && columns[k].name == *reading_of(axis)) ||
                           (columns[k].use == Use::kDeviation && columns[k].name == axis);
      if (!reading) continue;
      block.first = std::min(block.first, k);
      block.last = std::max(block.last, k);
      block.read = true;
    }
    if (block.read) blocks.push_back(block);
  }
  for (std::size_t i = 0; i < blocks.size(); ++i)
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      if (blocks[i].last >= blocks[k].first) continue;
      constexpr double kNearlyAll = 0.8;  // a grid moves one axis at nearly every step, a diagonal both
      if (moved_together(sheet, table, blocks[i].target, blocks[k].target) < kNearlyAll) continue;
      const std::string one = columns[blocks[i].target].name, other = columns[blocks[k].target].name;
      throw text::InputError(
          {sheet.file, sheet.line[table.heading_row]}, "",
          fmt::format("{} and its readings are in the columns {} to {}, {} in the columns {} to {}: if "
                      "these are two tables side by side, read each with --leave for the columns of the "
                      "other one; if the axes moved together, give --one-motion",
                      one, blocks[i].first + 1, blocks[i].last + 1, other, blocks[k].first + 1,
                      blocks[k].last + 1));
    }
}

}  // namespace vernier::importer
