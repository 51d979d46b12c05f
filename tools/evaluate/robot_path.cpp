// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/robot_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/model/column_reader.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::evaluate {
namespace {

using Eigen::Vector3d;
using Cycle = std::vector<PoseReading>;

std::vector<Cycle> cycles_of(const std::vector<PoseReading>& readings) {
  std::vector<Cycle> cycles;
  std::map<std::string, std::size_t> place;
  for (const PoseReading& reading : readings) {
    const auto [found, fresh] = place.emplace(reading.run, cycles.size());
    if (fresh) cycles.emplace_back();
    cycles[found->second].push_back(reading);
  }
  return cycles;
}

/// Way along the commanded path at each sample, mm.
std::vector<double> ways(const Cycle& cycle) {
  std::vector<double> way = {0};
  for (std::size_t i = 1; i < cycle.size(); ++i)
    way.push_back(way.back() + (cycle[i].commanded_mm - cycle[i - 1].commanded_mm).norm());
  return way;
}

struct Crossing {
  Vector3d at, tangent;  // of the commanded path
  double way = 0;
};

std::vector<Crossing> stations_of(const Cycle& cycle, std::size_t count) {
  const std::vector<double> way = ways(cycle);
  if (!(way.back() > 0))
    throw text::InputError(fmt::format("the commanded path of run \"{}\" has no length", cycle.front().run));
  std::vector<Crossing> stations;
  std::size_t i = 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = way.back() * static_cast<double>(k + 1) / static_cast<double>(count + 1);
    while (way[i] < at || way[i] == way[i - 1]) ++i;
    const Vector3d step = cycle[i].commanded_mm - cycle[i - 1].commanded_mm;
    stations.push_back({cycle[i - 1].commanded_mm + step * (at - way[i - 1]) / (way[i] - way[i - 1]),
                        step.normalized(), at});
  }
  return stations;
}

/// Where a cycle's measured path crosses the plane across the commanded one at a station: of all crossings
/// the one whose own commanded way is nearest (a closed path crosses each plane twice).
std::optional<PoseReading> crossing(const Cycle& cycle, const std::vector<double>& way,
                                    const Crossing& station) {
  std::optional<PoseReading> best;
  double least = 0;
  for (std::size_t i = 1; i < cycle.size(); ++i) {
    const double before = (cycle[i - 1].measured_mm - station.at).dot(station.tangent),
                 after = (cycle[i].measured_mm - station.at).dot(station.tangent);
    if (before > 0 || after <= 0) continue;
    const double share = before / (before - after);
    const double off = std::abs(way[i - 1] + share * (way[i] - way[i - 1]) - station.way);
    if (best && off >= least) continue;
    least = off;
    best = cycle[i];
    best->commanded_mm = station.at;
    best->commanded_deg = std::nullopt;
    best->measured_deg = std::nullopt;
    best->measured_mm = cycle[i - 1].measured_mm + share * (cycle[i].measured_mm - cycle[i - 1].measured_mm);
    best->u_mm = std::max(cycle[i - 1].u_mm, cycle[i].u_mm);
  }
  return best;
}

}  // namespace

PathResult evaluate_path(const std::vector<PoseReading>& readings, std::size_t stations) {
  const std::vector<Cycle> cycles = cycles_of(readings);
  if (cycles.size() < 2)
    throw text::InputError(
        "the readings contain fewer than two cycles (runs) of the path: repeatability requires two cycles, "
        "and ISO 9283 requires ten");
  std::vector<std::vector<double>> way;
  for (const Cycle& cycle : cycles) way.push_back(ways(cycle));
  PathResult result;
  for (const Crossing& station : stations_of(cycles.front(), stations)) {
    std::vector<PoseReading> here;
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      const auto found = crossing(cycles[i], way[i], station);
      if (!found)
        throw text::InputError(
            fmt::format("run \"{}\" does not pass the commanded path at {:.3f} mm from its beginning",
                        cycles[i].front().run, station.way));
      here.push_back(*found);
    }
    result.stations.push_back(evaluate_poses(here).front());
    const PoseResult& last = result.stations.back();
    if (last.accuracy_mm > result.stations[result.accuracy_at].accuracy_mm)
      result.accuracy_at = result.stations.size() - 1;
    if (last.repeatability_mm > result.stations[result.repeatability_at].repeatability_mm)
      result.repeatability_at = result.stations.size() - 1;
  }
  return result;
}

std::vector<PoseReading> read_pose_readings(const std::string& text, const std::string& file) {
  const format::CsvFile csv = format::parse_csv(text, file);
  namespace columns = format::columns;
  model::ColumnReader reader(csv);
  std::array<model::Column, 3> commanded, measured;
  const auto read = [&](const std::array<const char*, 3>& names, std::array<model::Column, 3>& values,
                        bool filled) {
    for (std::size_t k = 0; k < 3; ++k) {
      reader.require(names[k], "this column is missing: " + format::words_of(columns::kNominalPoint) +
                                   " commanded, " + format::words_of(columns::kPoint) +
                                   " measured (or give --machine)");
      values[k] = reader.numbers(names[k], format::Dimension::kLength, filled);
    }
  };
  read(columns::kNominalPoint, commanded, true);
  read(columns::kPoint, measured, false);
  const auto beside = [&](const char* name) {
    return reader.has(name) ? reader.numbers(name, reader.dimension(name), false) : model::Column();
  };
  const model::Column u = beside(columns::kUncertainty), time = beside(columns::kTime);
  const std::vector<std::string> runs =
      reader.has(columns::kRun) ? reader.words(columns::kRun) : std::vector<std::string>(reader.rows());
  std::vector<PoseReading> readings;
  for (Eigen::Index row = 0; row < commanded[0].size(); ++row) {
    PoseReading one;
    for (std::size_t k = 0; k < 3; ++k) {
      one.commanded_mm[static_cast<Eigen::Index>(k)] = commanded[k][row];
      one.measured_mm[static_cast<Eigen::Index>(k)] = measured[k][row];
    }
    one.run = runs[static_cast<std::size_t>(row)];
    if (u.size() > 0 && !std::isnan(u[row])) one.u_mm = u[row];
    if (time.size() > 0 && !std::isnan(time[row])) one.time_s = time[row];
    if (one.measured_mm.allFinite()) readings.push_back(one);
  }
  if (readings.empty())
    throw text::InputError(reader.header(), columns::kPoint.front(), "no row has a reading");
  return readings;
}

}  // namespace vernier::evaluate
