// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/positioning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/model/column_reader.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

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
      throw text::InputError(fmt::format(
          "the file has only one reading at {}{}: a standard deviation needs at least two "
          "readings, ISO 230-2 requires five. If the file has no directions: if all runs go one way, state "
          "the direction of all rows (import table --set \"dirX=1\", with the name of the axis); if the runs "
          "go "
          "forward and back (the values of two runs differ at each position), write + or - behind the number "
          "of each run in the table (Lauf 1 +, Lauf 2 -), and import it again",
          text::number_text(readings.target), sense == 0 ? " forward" : " backward"));
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

/// For a rotary axis the angle about it is the reading if no column has its name: rz of C.
std::string reading_column(const model::ColumnReader& file, const std::string& axis,
                           const std::string& reading) {
  const auto about = format::angle_about(axis);
  if (!file.has(reading) && about && file.has(*about)) return *about;
  file.require(reading, "this column is missing");
  return reading;
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
    throw text::InputError("an evaluation needs at least two targets; ISO 230-2 requires five per metre");
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
  const format::CsvFile csv = format::parse_csv(text, file);
  model::ColumnReader reader(csv);
  reader.require(axis, "this column is missing");
  const std::string actual = reading_column(reader, axis, reading);
  PositioningFile result;
  const format::Dimension dimension = reader.dimension(axis);
  if (dimension != format::Dimension::kLength && dimension != format::Dimension::kAngle)
    throw text::InputError(reader.header(), axis, "an axis position needs a unit like mm or deg");
  if (reader.dimension(actual) != dimension)
    throw text::InputError(reader.header(), reading,
                           fmt::format("the unit has another dimension than {}", axis));
  result.unit = format::base_unit(dimension);
  const model::Column position = reader.numbers(axis, dimension, true),
                      readings = reader.numbers(actual, dimension, false);
  const std::string dir = format::axis_column(format::AxisQuantity::kSense, axis);
  result.sense_from_order = !reader.has(dir);
  const model::Column senses =
      result.sense_from_order ? model::Column() : reader.numbers(dir, format::Dimension::kNone, false);
  const std::string uncertainty = format::columns::kUncertainty;
  const model::Column u = reader.has(uncertainty)
                              ? reader.numbers(uncertainty, reader.dimension(uncertainty), false)
                              : model::Column();
  // Targets are commanded positions: they are equal if they differ by less than a thousandth of a micrometre.
  std::map<long long, TargetReadings> targets;
  double sense = 1;
  for (Eigen::Index row = 0; row < position.size(); ++row) {
    const double at = position[row];
    if (!result.sense_from_order) {
      sense = std::isnan(senses[row]) ? 0 : senses[row];
      if (sense != 0 && std::abs(sense) != 1)
        throw text::InputError(reader.place(static_cast<std::size_t>(row)), text::number_text(sense),
                               "an approach direction is 1 or -1 (0: no motion)");
    } else if (row > 0) {
      // At the far end the same target is approached again from the other side.
      const double before = position[row - 1];
      sense = at > before ? 1 : at < before ? -1 : -sense;
    }
    if (std::isnan(readings[row])) continue;
    if (sense == 0) {
      ++result.undirected;
      continue;
    }
    TargetReadings& target = targets[std::llround(at * 1e6)];
    target.target = at;
    target.deviation[sense > 0 ? 0 : 1].push_back(readings[row] - at);
    ++result.rows;
    if (u.size() > 0 && !std::isnan(u[row])) raise(result.u, u[row]);
  }
  for (auto& [key, target] : targets) result.readings.push_back(std::move(target));
  if (result.rows == 0)
    throw text::InputError(
        reader.header(), axis,
        fmt::format("no row has a reading and an approach direction ({} of 1 or -1)", dir));
  return result;
}

}  // namespace vernier::evaluate
