// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/robot_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tools/text/error.h"

namespace vernier::evaluate {
namespace {

using Eigen::Vector3d;
using Visits = std::vector<const PoseReading*>;

struct MeanAndSpread {
  double mean = 0, spread = 0;  // n - 1
};

MeanAndSpread of(const std::vector<double>& values) {
  MeanAndSpread result;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) result.mean += value / n;
  double squares = 0;
  for (const double value : values) squares += std::pow(value - result.mean, 2);
  result.spread = std::sqrt(squares / (n - 1));
  return result;
}

DistanceResult distance_of(const Visits& first, const Visits& second) {
  DistanceResult result;
  result.from_mm = first.front()->commanded_mm, result.to_mm = second.front()->commanded_mm;
  result.count = first.size();
  const Vector3d commanded = result.to_mm - result.from_mm;
  result.commanded_mm = commanded.norm();
  std::vector<double> lengths, along[3];
  double u = 0;
  for (std::size_t j = 0; j < first.size(); ++j) {
    const Vector3d way = second[j]->measured_mm - first[j]->measured_mm;
    lengths.push_back(way.norm());
    for (int k = 0; k < 3; ++k) along[k].push_back(std::abs(way[k]));
    u = std::max({u, first[j]->u_mm, second[j]->u_mm});
  }
  const MeanAndSpread length = of(lengths);
  const auto n = static_cast<double>(lengths.size());
  result.accuracy_mm = length.mean - result.commanded_mm;
  result.repeatability_mm = 3 * length.spread;
  // The instrument errs at either end, by the same in every visit.
  result.accuracy_std_mm = std::hypot(length.spread / std::sqrt(n), std::sqrt(2.0) * u);
  std::tie(result.low_mm, result.high_mm) = spread_interval(result.repeatability_mm, n - 1);
  for (int k = 0; k < 3; ++k) {
    const MeanAndSpread one = of(along[k]);
    result.accuracy_xyz_mm[k] = one.mean - std::abs(commanded[k]);
    result.repeatability_xyz_mm[k] = 3 * one.spread;
  }
  return result;
}

}  // namespace

std::vector<DistanceResult> evaluate_distances(const std::vector<PoseReading>& readings) {
  const std::vector<Visits> poses = visits_by_pose(readings);
  if (poses.size() < 2)
    throw text::InputError("the file has only one commanded pose; a distance needs two poses");
  for (const Visits& pose : poses) {
    const Vector3d& at = pose.front()->commanded_mm;
    if (pose.size() != poses.front().size() || pose.size() < 2)
      throw text::InputError(
          fmt::format("{} readings at {:g} {:g} {:g} mm, but {} at the first pose: all poses must have the "
                      "same number of readings, at least two",
                      pose.size(), at[0], at[1], at[2], poses.front().size()));
  }
  std::vector<DistanceResult> results;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) results.push_back(distance_of(poses[i], poses[i + 1]));
  return results;
}

}  // namespace vernier::evaluate
