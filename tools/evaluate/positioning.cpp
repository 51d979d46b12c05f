// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/positioning.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "tools/text/csv.h"
#include "tools/text/numbers.h"
#include "tools/text/units.h"

namespace vernier::evaluate {
namespace {

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double spread_of(const std::vector<double>& values, double mean) {
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

/// Smallest and largest so far.
struct Range {
  std::optional<double> low, high;
  void take(double value) {
    low = std::min(low.value_or(value), value);
    high = std::max(high.value_or(value), value);
  }
  std::optional<double> width() const { return low ? std::optional(*high - *low) : std::nullopt; }
};

void raise(std::optional<double>& most, double value) { most = std::max(most.value_or(value), value); }

TargetResult result_at(const TargetReadings& readings) {
  TargetResult result;
  result.target = readings.target;
  for (std::size_t sense = 0; sense < 2; ++sense) {
    const auto& list = readings.deviation[sense];
    result.count[sense] = list.size();
    if (list.empty()) continue;
    if (list.size() == 1)
      throw text::InputError("one reading at " + text::number_text(readings.target) +
                             (sense == 0 ? " forward" : " backward") +
                             ": a spread needs two, ISO 230-2 asks for five");
    result.mean[sense] = mean_of(list);
    result.spread[sense] = spread_of(list, result.mean[sense]);
    result.repeatability[sense] = 4 * result.spread[sense];
  }
  const bool both = result.count[0] > 0 && result.count[1] > 0;
  if (!both) return result;
  result.mean_both = (result.mean[0] + result.mean[1]) / 2;
  result.reversal = result.mean[0] - result.mean[1];
  result.repeatability_both =
      std::max({2 * result.spread[0] + 2 * result.spread[1] + std::abs(result.reversal),
                result.repeatability[0], result.repeatability[1]});
  return result;
}

class Table {
 public:
  Table(const std::string& text, const std::string& file) : csv_(text::parse_csv(text, file)) {}

  std::optional<std::size_t> find(const std::string& name) const {
    for (std::size_t k = 0; k < csv_.columns.size(); ++k)
      if (csv_.columns[k].name == name) return k;
    return std::nullopt;
  }
  std::size_t need(const std::string& name) const {
    const auto column = find(name);
    if (!column) throw text::InputError({csv_.file, csv_.header_line}, name, "this column is missing");
    return *column;
  }
  text::Unit unit(std::size_t column) const { return *text::find_unit(csv_.columns[column].unit); }
  /// In the base unit; nothing for an empty cell.
  std::optional<double> number(std::size_t row, std::size_t column) const {
    const std::string& cell = csv_.rows[row][column];
    if (cell.empty()) return std::nullopt;
    const auto value = text::parse_number(cell);
    if (!value)
      throw text::InputError({csv_.file, csv_.line[row]}, cell,
                             "not a number, in column " + csv_.columns[column].name);
    return unit(column).factor * *value + unit(column).offset;
  }
  const text::CsvFile& csv() const { return csv_; }

 private:
  text::CsvFile csv_;
};

/// Of a rotary axis the angle about it serves where no column has its name: rz of C.
std::size_t reading_column(const Table& table, const std::string& axis, const std::string& reading) {
  if (const auto own = table.find(reading)) return *own;
  if (const auto about = text::angle_about(axis))
    if (const auto angle = table.find(*about)) return *angle;
  return table.need(reading);
}

}  // namespace

PositioningResult evaluate_positioning(const std::vector<TargetReadings>& readings) {
  PositioningResult result;
  std::array<Range, 2> means, bands;
  Range all_means, all_bands, middles;
  double reversals = 0;
  std::size_t both = 0;
  for (const TargetReadings& one : readings) {
    const TargetResult at = result_at(one);
    for (std::size_t sense = 0; sense < 2; ++sense) {
      if (at.count[sense] == 0) continue;
      for (const double side : {-2.0, 2.0}) {
        bands[sense].take(at.mean[sense] + side * at.spread[sense]);
        all_bands.take(at.mean[sense] + side * at.spread[sense]);
      }
      means[sense].take(at.mean[sense]);
      all_means.take(at.mean[sense]);
      raise(result.repeatability[sense], at.repeatability[sense]);
    }
    if (at.count[0] > 0 && at.count[1] > 0) {
      ++both;
      reversals += at.reversal;
      middles.take(at.mean_both);
      raise(result.reversal, std::abs(at.reversal));
      raise(result.repeatability_both, at.repeatability_both);
    }
    result.targets.push_back(at);
  }
  if (result.targets.size() < 2)
    throw text::InputError("an axis is judged by two targets at least; ISO 230-2 asks for five a metre");
  for (std::size_t sense = 0; sense < 2; ++sense) {
    result.systematic[sense] = means[sense].width();
    result.accuracy[sense] = bands[sense].width();
  }
  if (both == 0) return result;
  result.systematic_both = all_means.width();
  result.accuracy_both = all_bands.width();
  result.range = middles.width();
  result.mean_reversal = reversals / static_cast<double>(both);
  return result;
}

PositioningFile read_positioning(const std::string& text, const std::string& file, const std::string& axis,
                                 const std::string& reading) {
  const Table table(text, file);
  const std::size_t position = table.need(axis), actual = reading_column(table, axis, reading);
  PositioningFile result;
  const text::Dimension dimension = table.unit(position).dimension;
  if (dimension != text::Dimension::kLength && dimension != text::Dimension::kAngle)
    throw text::InputError({file, table.csv().header_line}, axis,
                           "an axis position needs a unit like mm or deg");
  if (table.unit(actual).dimension != dimension)
    throw text::InputError({file, table.csv().header_line}, reading, "of another kind of unit than " + axis);
  result.unit = text::base_unit(dimension);
  const auto dir = table.find("dir" + axis), u = table.find("u");
  result.sense_from_order = !dir;
  // Targets are what was commanded: a thousandth of a micrometre apart they are the same.
  std::map<long long, TargetReadings> targets;
  std::optional<double> before;
  double sense = 0;
  for (std::size_t row = 0; row < table.csv().rows.size(); ++row) {
    const auto at = table.number(row, position);
    if (!at) throw text::InputError({file, table.csv().line[row]}, axis, "this column may not be empty");
    if (dir) {
      sense = table.number(row, *dir).value_or(0);
      if (sense != 0 && std::abs(sense) != 1)
        throw text::InputError({file, table.csv().line[row]}, text::number_text(sense),
                               "a sense of approach is 1 or -1 (0: nothing moved)");
    } else if (before) {
      // At the far end the same target is approached again from the other side.
      sense = *at > *before ? 1 : *at < *before ? -1 : -sense;
    } else {
      sense = 1;
    }
    before = at;
    const auto value = table.number(row, actual);
    if (!value || sense == 0) continue;
    TargetReadings& target = targets[std::llround(*at * 1e6)];
    target.target = *at;
    target.deviation[sense > 0 ? 0 : 1].push_back(*value - *at);
    ++result.rows;
    if (u)
      if (const auto one = table.number(row, *u)) raise(result.u, *one);
  }
  for (auto& [key, target] : targets) result.readings.push_back(std::move(target));
  if (result.rows == 0)
    throw text::InputError({file, table.csv().header_line}, axis,
                           "no row has a reading and a sense of approach (dir" + axis + " of 1 or -1)");
  return result;
}

}  // namespace vernier::evaluate
