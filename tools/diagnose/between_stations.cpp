// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/between_stations.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vernier::diagnose {
namespace {

/// Stations of the table of an axis in the measured range, and the two beside it; empty: no table.
std::vector<double> stations_read(const Evidence& evidence, std::size_t axis) {
  const Evidence::Range range = evidence.range_of(axis);
  std::vector<double> stations;
  for (const model::Table& table : evidence.machine().tables) {
    if (table.axis != axis) continue;
    for (std::size_t k = 0; k < table.stations.size(); ++k) {
      const bool before = k + 1 < table.stations.size() && table.stations[k + 1].loc <= range.low;
      const bool behind = k > 0 && table.stations[k - 1].loc >= range.high;
      if (!before && !behind) stations.push_back(table.stations[k].loc);
    }
  }
  return stations;
}

double median_distance(const std::vector<double>& stations) {
  std::vector<double> distances;
  for (std::size_t k = 1; k < stations.size(); ++k) distances.push_back(stations[k] - stations[k - 1]);
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

CurveBetweenStations curve_between_stations(const Evidence& evidence, const effects::Candidate& candidate) {
  CurveBetweenStations curve;
  if (!candidate.choice.axis || !candidate.choice.place) return curve;
  const std::size_t axis = *candidate.choice.axis;
  const std::vector<double> stations = stations_read(evidence, axis);
  if (stations.size() < 2) return curve;
  curve.spacing = median_distance(stations);
  const Eigen::VectorXd response = evidence.response(evidence.index_of(*candidate.choice.place));
  const Eigen::ArrayXd position = evidence.at_readings(evidence.position(axis));
  Eigen::MatrixXd columns(response.size(), static_cast<Eigen::Index>(stations.size()) - 1);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    const double low = stations[static_cast<std::size_t>(k)],
                 high = stations[static_cast<std::size_t>(k) + 1];
    const double half = (high - low) / 2;
    const Eigen::ArrayXd hat = (1 - (position - (low + half)).abs() / half).max(0);
    columns.col(k) = response.array() * hat;
  }
  evidence.whiten(columns);
  curve.columns = evidence.beside_model(columns);
  return curve;
}

}  // namespace vernier::diagnose
