// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/cells.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/fit/coverage/reading_direction.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/prediction.h"
#include "tools/residual/repeats.h"

namespace vernier::residual {
namespace {

constexpr int kMostPerSide = 5;     // cells that a picture of a volume can show
constexpr int kMostOnLine = 20;     // cells of a line: four times as many, because a line has no depth
constexpr double kRowsPerCell = 6;  // minimum, so that a mean is more accurate than a reading
constexpr std::size_t kLeastRowsOfPicture = 4;  // a picture of fewer rows shows less than their list
constexpr double kFlat = 0.02;  // of the longest side: a shorter side is the set-up of one plane or line

/// Tool points of all rows in the measuring frame of each row, mm.
Eigen::Matrix3Xd tool_points(const model::Machine& machine, const model::Measurement& m) {
  model::Measurement probe = m;
  probe.observations.clear();
  for (std::size_t row = 0; row < m.rows(); ++row)
    for (const model::ObservationKind kind :
         {model::ObservationKind::kX, model::ObservationKind::kY, model::ObservationKind::kZ})
      probe.observations.push_back({kind, row, 0});
  const Eigen::VectorXd points = model::predict(machine, probe);
  return Eigen::Map<const Eigen::Matrix3Xd>(points.data(), 3, static_cast<Eigen::Index>(m.rows()));
}

/// Residual of each row as a vector, mm; `seen` counts the directions that were measured.
struct RowVectors {
  Eigen::Matrix3Xd value;
  std::vector<int> seen;
};

/// Direction of a reading in workpiece coordinates. `point`: tool points in the measuring frame.
Eigen::Vector3d direction_of(const model::Machine& machine, const model::Measurement& m,
                             const model::Observation& o, const Eigen::Matrix3Xd& point) {
  const auto row = static_cast<Eigen::Index>(o.row);
  Eigen::Vector3d along;
  if (o.kind == model::ObservationKind::kLength)
    along = point.col(row) - m.centre.col(row);
  else if (o.kind == model::ObservationKind::kDistance)
    along = point.col(row) - point.col(static_cast<Eigen::Index>(m.other_end[o.row]));
  else
    return fit::reading_direction(machine, m, o);
  return fit::measuring_frame(machine, m, o.row).transpose() * along.normalized();
}

RowVectors row_vectors(const model::Machine& machine, const model::Measurement& m,
                       const Eigen::VectorXd& residual) {
  const Eigen::Matrix3Xd point = tool_points(machine, m);
  RowVectors vectors{Eigen::Matrix3Xd::Zero(3, point.cols()), std::vector<int>(m.rows(), 0)};
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if (model::is_rotation(o.kind) || m.check[o.row] != 0) continue;
    // A surface has a normal that only the fit knows.
    if (model::is_of_thing(o.kind) && m.things[m.thing[o.row]].artefact.dimension() != 3) continue;
    vectors.value.col(static_cast<Eigen::Index>(o.row)) +=
        residual[static_cast<Eigen::Index>(i)] * direction_of(machine, m, o, point);
    ++vectors.seen[o.row];
  }
  return vectors;
}

}  // namespace

std::vector<FailureCell> failure_cells(const model::Machine& machine, const model::Measurement& m,
                                       const Eigen::VectorXd& residual) {
  model::Machine without_set_up = machine;
  without_set_up.base_shifts.clear();
  const Eigen::Matrix3Xd point = tool_points(without_set_up, m);  // workpiece coordinates
  const RowVectors vectors = row_vectors(machine, m, residual);
  std::vector<Eigen::Index> used;
  for (std::size_t row = 0; row < m.rows(); ++row)
    if (vectors.seen[row] > 0) used.push_back(static_cast<Eigen::Index>(row));
  if (used.size() < kLeastRowsOfPicture) return {};
  Eigen::Vector3d low = point.col(used.front()), high = low;
  for (const Eigen::Index row : used) {
    low = low.cwiseMin(point.col(row));
    high = high.cwiseMax(point.col(row));
  }
  const double longest = (high - low).maxCoeff();
  int sides = 0;
  for (int k = 0; k < 3; ++k) sides += high[k] - low[k] > kFlat * longest ? 1 : 0;
  const int per_side = std::clamp(
      static_cast<int>(std::pow(static_cast<double>(used.size()) / kRowsPerCell, 1.0 / std::max(1, sides))),
      1, sides == 1 ? kMostOnLine : kMostPerSide);
  struct Sum {
    Eigen::Vector3d point = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
    double squares = 0;
    std::size_t count = 0;
  };
  std::map<std::array<int, 3>, Sum> sums;
  for (const Eigen::Index row : used) {
    std::array<int, 3> cell{};
    for (Eigen::Index k = 0; k < 3; ++k)
      if (high[k] - low[k] > kFlat * longest)
        cell[static_cast<std::size_t>(k)] = std::min(
            per_side - 1, static_cast<int>(per_side * (point(k, row) - low[k]) / (high[k] - low[k])));
    Sum& sum = sums[cell];
    sum.point += point.col(row);
    sum.mean += vectors.value.col(row);
    sum.squares += vectors.value.col(row).squaredNorm();
    ++sum.count;
  }
  std::vector<FailureCell> cells;
  for (const auto& [cell, sum] : sums) {
    const auto n = static_cast<double>(sum.count);
    FailureCell item{sum.point / n, maths::kUmPerMm * sum.mean / n, 0, sum.count};
    const double spread = std::max(0.0, sum.squares / n - (sum.mean / n).squaredNorm());
    item.noise_um = sum.count > 1 ? maths::kUmPerMm * std::sqrt(spread / (n - 1)) : 0;
    cells.push_back(item);
  }
  return cells;
}

}  // namespace vernier::residual
