// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/dense_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

namespace vernier::lint {
namespace {

/// Positions that differ by less count as one, mm or deg: an axis stops to within some um.
constexpr double kSame = 0.01;

double median_step(const std::vector<double>& sorted) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < sorted.size(); ++k) steps.push_back(sorted[k] - sorted[k - 1]);
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// The different positions of an axis in rows in which it moved alone.
std::vector<double> positions_alone(const std::vector<std::vector<double>>& positions, std::size_t axis) {
  std::set<double> found;
  const std::vector<double>& own = positions[axis];
  for (std::size_t row = 1; row < own.size(); ++row) {
    const auto moved = [&](std::size_t a) {
      return std::abs(positions[a][row] - positions[a][row - 1]) > kSame;
    };
    bool alone = moved(axis);
    for (std::size_t a = 0; alone && a < positions.size(); ++a)
      alone = a == axis || positions[a].size() != own.size() || !moved(a);
    if (!alone) continue;
    for (const std::size_t at : {row - 1, row})
      if (std::isfinite(own[at])) found.insert(std::round(own[at] / kSame) * kSame);
  }
  return {found.begin(), found.end()};
}

}  // namespace

std::vector<DensePoints> dense_points(const model::Machine& machine,
                                      const std::vector<std::vector<double>>& positions) {
  constexpr double kTimes = 3;  // points between two stations: fewer show no curve
  constexpr double kMostParts = 100;
  constexpr std::size_t kEnough = 8;  // positions
  std::vector<DensePoints> list;
  for (const model::Table& table : machine.tables) {
    if (table.axis >= positions.size() || table.stations.size() < 2) continue;
    const std::vector<double> at = positions_alone(positions, table.axis);
    if (at.size() < kEnough) continue;
    std::vector<double> stations;
    for (std::size_t k = 0; k < table.stations.size(); ++k) {
      const bool before = k + 1 < table.stations.size() && table.stations[k + 1].loc <= at.front();
      const bool behind = k > 0 && table.stations[k - 1].loc >= at.back();
      if (!before && !behind) stations.push_back(table.stations[k].loc);
    }
    const model::Axis& axis = machine.axes[table.axis];
    DensePoints one{axis.name,       axis.rotary ? "deg" : "mm", at.size(),
                    median_step(at), median_step(stations),      0};
    if (!(one.station_spacing > kTimes * one.spacing)) continue;
    const double least = (at.back() - at.front()) / kMostParts;
    one.step = one.spacing >= least ? one.spacing : std::ceil(least);
    list.push_back(one);
  }
  return list;
}

std::string dense_points_text(const DensePoints& points) {
  return fmt::format("{}: {} positions about {:.4g} {} apart, and the table has stations {:.4g} {} apart",
                     points.axis, points.positions, points.spacing, points.unit, points.station_spacing,
                     points.unit);
}

std::string dense_points_remedy(const DensePoints& points) {
  return fmt::format(
      "the curve between two stations remains in the residual, where it can look like a cyclic error; make "
      "the machine file with --stations {}={:.4g} (vernier new), or add stations to the table",
      points.axis, points.step);
}

}  // namespace vernier::lint
