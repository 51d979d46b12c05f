// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/column_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using Use = SheetColumn::Use;

/// A measured position spans what its target spans, and no machine is wrong by a twentieth of that.
constexpr double kSpanOfDeviation = 0.05;
/// Positions in a wrong unit follow the target with the ratio of the units. A true scale error is never
/// within this share of such a ratio.
constexpr double kSameRatio = 0.01;
/// Two positions show no line.
constexpr std::size_t kFewestPairs = 3;

constexpr std::array<std::pair<const char*, const char*>, 3> kLinear = {{{"X", "x"}, {"Y", "y"}, {"Z", "z"}}};

/// Values of one cell pair after another: target, reading; mm if their units are known.
struct Pairs {
  std::vector<double> target, reading;
};

double factor_of(const std::string& unit) {
  const auto found = format::find_unit(unit);
  return unit.empty() || !found ? 1 : found->factor;
}

std::optional<double> value_of(const sheet::Sheet& sheet, std::size_t row, std::size_t column) {
  const auto number = sheet::plain_number(sheet.rows[row][column], sheet.decimal_comma);
  return number ? text::parse_number(*number) : std::nullopt;
}

Pairs pairs_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
               const std::vector<SheetColumn>& columns, std::size_t target, std::size_t reading) {
  const double of_target = factor_of(columns[target].unit);
  // A reading without a unit counts in the unit of the target.
  const double of_reading = columns[reading].unit.empty() ? of_target : factor_of(columns[reading].unit);
  Pairs pairs;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto at = value_of(sheet, row, target), read = value_of(sheet, row, reading);
    if (!at || !read) continue;
    pairs.target.push_back(*at * of_target);
    pairs.reading.push_back(*read * of_reading);
  }
  return pairs;
}

double span_of(const std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most - *least;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Slope of the reading over the target, and the part of the reading's span that the line leaves.
struct Line {
  double slope = 0, rest = 0;
};

Line line_through(const Pairs& pairs) {
  const double x0 = mean_of(pairs.target), y0 = mean_of(pairs.reading);
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < pairs.target.size(); ++i) {
    xx += (pairs.target[i] - x0) * (pairs.target[i] - x0);
    xy += (pairs.target[i] - x0) * (pairs.reading[i] - y0);
  }
  Line line;
  line.slope = xx > 0 ? xy / xx : 0;
  std::vector<double> left;
  for (std::size_t i = 0; i < pairs.target.size(); ++i)
    left.push_back(pairs.reading[i] - line.slope * pairs.target[i]);
  const double span = span_of(pairs.reading);
  line.rest = span > 0 ? span_of(left) / span : 1;
  return line;
}

/// The ratio of two units of length that a slope is; empty if it is none.
std::string ratio_of_units(const Line& line) {
  if (line.rest > kSpanOfDeviation) return "";
  constexpr std::array<std::pair<double, const char*>, 4> kRatios = {
      {{1e-3, "1/1000"}, {1e3, "1000"}, {1 / 25.4, "1/25.4"}, {25.4, "25.4"}}};
  for (const auto& [ratio, text] : kRatios)
    if (std::abs(line.slope / ratio - 1) < kSameRatio) return text;
  return "";
}

/// Does another component of the measured point follow this axis? Then the readings are in a frame that is
/// turned against the machine.
bool another_follows(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                     const std::vector<SheetColumn>& columns, std::size_t target, std::size_t reading) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const bool point = std::find(format::columns::kPoint.begin(), format::columns::kPoint.end(),
                                 columns[k].name) != format::columns::kPoint.end();
    if (k == reading || columns[k].use != Use::kColumn || !point) continue;
    const Pairs pairs = pairs_of(sheet, table, columns, target, k);
    if (pairs.target.size() < kFewestPairs) continue;
    const Line line = line_through(pairs);
    if (std::abs(line.slope) > kSpanOfDeviation) return true;
  }
  return false;
}

std::string length_text(double mm) {
  return mm < 1 ? fmt::format("{:.3g} um", mm * 1e3) : fmt::format("{:.6g} mm", mm);
}

std::optional<std::size_t> column_named(const std::vector<SheetColumn>& columns, const std::string& name) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == Use::kColumn && columns[k].name == name) return k;
  return std::nullopt;
}

void settle_reading(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                    std::vector<SheetColumn>& columns, std::size_t target, std::size_t k) {
  const sheet::Heading& heading = table.headings[k];
  SheetColumn& column = columns[k];
  const std::string& axis = columns[target].name;
  const Pairs pairs = pairs_of(sheet, table, columns, target, k);
  const double moved = span_of(pairs.target), spans = span_of(pairs.reading);
  if (pairs.target.size() < kFewestPairs || moved <= 0) return;
  const text::Place place{sheet.file, sheet.line[table.heading_row]};
  const Line line = line_through(pairs);
  const std::string ratio = ratio_of_units(line);
  const bool deviation = column.use == Use::kDeviation;
  const bool follows = std::abs(line.slope - 1) < kSpanOfDeviation && line.rest < kSpanOfDeviation;
  if (deviation && (follows || (!ratio.empty() && line.slope > 1)))
    throw text::InputError(place, heading.text,
                           fmt::format("the values follow {}, so they are positions and not deviations; "
                                       "correct the heading, or give --column \"{}[{}]={}\"",
                                       axis, text::in_small_letters(axis),
                                       column.unit.empty() ? "mm" : column.unit, heading.text));
  if (deviation || spans > kSpanOfDeviation * moved) return;
  if (!ratio.empty() && !column.unit.empty())
    throw text::InputError(place, heading.text,
                           fmt::format("the values follow {} with the ratio {}, so they are positions, and "
                                       "the unit of one of the two columns is wrong; correct the heading",
                                       axis, ratio));
  if (another_follows(sheet, table, columns, target, k)) return;
  column.use = Use::kDeviation;
  column.name = axis;
  column.why = fmt::format("by its values: they span {}, {} spans {}",
                           column.unit.empty() ? fmt::format("{:.3g}", spans) : length_text(spans), axis,
                           length_text(moved));
}

}  // namespace

void settle_by_values(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                      std::vector<SheetColumn>& columns) {
  if (!table.has_headings) return;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    // A heading that is written as in the measurement file has its meaning.
    if (columns[k].why != "by its heading" || table.headings[k].name == columns[k].name) continue;
    for (const auto& [axis, point] : kLinear) {
      const bool is_reading = columns[k].use == Use::kColumn && columns[k].name == point;
      const bool is_deviation = columns[k].use == Use::kDeviation && columns[k].name == axis;
      if (!is_reading && !is_deviation) continue;
      if (const auto target = column_named(columns, axis)) settle_reading(sheet, table, columns, *target, k);
      break;
    }
  }
}

void refuse_tables_side_by_side(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SheetColumn>& columns) {
  // Axes with a target and a reading of their own, in each block of columns between empty columns.
  std::vector<std::set<std::string>> blocks(1);
  std::vector<std::size_t> first = {0};
  std::set<std::string> targets, read;
  const auto close = [&] {
    for (const std::string& axis : targets)
      if (read.contains(axis)) blocks.back().insert(axis);
    targets.clear();
    read.clear();
  };
  const auto is_empty = [&](std::size_t k) {
    for (std::size_t row = table.has_headings ? table.heading_row : table.first_data; row < sheet.rows.size();
         ++row)
      if (!sheet.rows[row][k].empty()) return false;
    return true;
  };
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (is_empty(k)) {
      close();
      blocks.emplace_back();
      first.push_back(k + 1);
      continue;
    }
    for (const auto& [axis, point] : kLinear) {
      if (columns[k].use == Use::kColumn && columns[k].name == axis) targets.insert(axis);
      if (columns[k].use == Use::kColumn && columns[k].name == point) read.insert(axis);
      if (columns[k].use == Use::kDeviation && columns[k].name == axis) read.insert(axis);
    }
  }
  close();
  std::vector<std::string> found;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (!blocks[b].empty())
      found.push_back(fmt::format("{} from column {}", *blocks[b].begin(), first[b] + 1));
  if (found.size() < 2) return;
  throw text::InputError({sheet.file, sheet.line[table.heading_row]}, "",
                         "tables side by side, with an empty column between them (" +
                             text::joined(found, ", ") +
                             "): a row would be one pose of all axes; save each table as a file of its own, "
                             "or remove the empty column if the axes moved together");
}

}  // namespace vernier::importer
