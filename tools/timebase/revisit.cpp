// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/timebase/revisit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tools/maths/median.h"

namespace vernier::timebase {
namespace {

using Index = Eigen::Index;

// Finds the points of a path near a given one: sorted along the first coordinate.
class Neighbours {
 public:
  explicit Neighbours(const Eigen::MatrixXd& points)
      : points_(points), order_(static_cast<std::size_t>(points.rows())) {
    std::iota(order_.begin(), order_.end(), Index{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](Index a, Index b) { return points(a, 0) < points(b, 0); });
  }

  // Rows within `radius` of a point, increasing.
  std::vector<Index> within(const Eigen::RowVectorXd& point, double radius) const {
    std::vector<Index> found;
    auto it = std::lower_bound(order_.begin(), order_.end(), point[0] - radius,
                               [&](Index row, double value) { return points_(row, 0) < value; });
    for (; it != order_.end() && points_(*it, 0) <= point[0] + radius; ++it) {
      if ((points_.row(*it) - point).norm() <= radius) found.push_back(*it);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  const Eigen::MatrixXd& points_;
  std::vector<Index> order_;
};

// Radius of the search for the nearest row, of the usual step. Half a step finds the nearest row of a path
// with the same spacing. The rest is a margin for uneven steps.
constexpr double kRadius = 0.8;

// Direction of the path at each row.
Eigen::RowVectorXd heading(const Eigen::MatrixXd& points, Index row) {
  const Index before = std::max<Index>(row - 1, 0), after = std::min<Index>(row + 1, points.rows() - 1);
  return (points.row(after) - points.row(before)) / static_cast<double>(std::max<Index>(after - before, 1));
}

double usual_step(const Eigen::MatrixXd& points) {
  std::vector<double> steps;
  for (Index i = 1; i < points.rows(); ++i) steps.push_back((points.row(i) - points.row(i - 1)).norm());
  return steps.empty() ? 0 : maths::median(steps);
}

// Poses set one by one are not a path: there are no positions between them, so every pose is a
// neighbour of every other.
bool is_path(const Eigen::MatrixXd& points) {
  constexpr double kLongestStep = 0.1;  // of the extent
  if (points.rows() < 2 || points.cols() == 0) return false;
  const double extent = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  const double step = usual_step(points);
  return step > 0 && step <= kLongestStep * extent;
}

// Position between the rows of a path that is nearest to a point, about `row`.
double project(const Eigen::MatrixXd& points, Index row, const Eigen::RowVectorXd& point) {
  const Eigen::RowVectorXd along = heading(points, row);
  const double square = along.squaredNorm();
  if (square <= 0) return static_cast<double>(row);
  return static_cast<double>(row) + std::clamp((point - points.row(row)).dot(along) / square, -1.0, 1.0);
}

Index nearest(const Eigen::MatrixXd& points, const std::vector<Index>& rows, std::size_t from, std::size_t to,
              const Eigen::RowVectorXd& point) {
  Index best = rows[from];
  for (std::size_t k = from; k < to; ++k) {
    if ((points.row(rows[k]) - point).norm() < (points.row(best) - point).norm()) best = rows[k];
  }
  return best;
}

// The first stretch of neighbouring rows after `row` that is not correlated with it and goes the same
// way.
double return_to(const Eigen::MatrixXd& points, const std::vector<Index>& near, Index row) {
  const auto self = static_cast<std::size_t>(std::find(near.begin(), near.end(), row) - near.begin());
  std::size_t k = self;
  while (k + 1 < near.size() && near[k + 1] <= near[k] + 2) ++k;
  for (++k; k < near.size();) {
    std::size_t end = k + 1;
    while (end < near.size() && near[end] <= near[end - 1] + 2) ++end;
    const Index again = nearest(points, near, k, end, points.row(row));
    if (heading(points, again).dot(heading(points, row)) > 0)
      return project(points, again, points.row(row)) - static_cast<double>(row);
    k = end;
  }
  return std::nan("");
}

}  // namespace

Eigen::MatrixXd path_points(const model::Measurement& m, const std::vector<std::size_t>& rows) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t a = 0; a < m.states.axis.size(); ++a) {
    const model::Column axis = model::commanded(m, a);
    Eigen::VectorXd column(static_cast<Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
      column[static_cast<Index>(i)] = axis[static_cast<Index>(rows[i])];
    const double range = column.size() > 0 ? column.maxCoeff() - column.minCoeff() : 0;
    if (range > 0) columns.push_back(column / range);
  }
  Eigen::MatrixXd points(static_cast<Index>(rows.size()), static_cast<Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) points.col(static_cast<Index>(c)) = columns[c];
  return points;
}

Eigen::VectorXd revisit_lags(const Eigen::MatrixXd& points) {
  Eigen::VectorXd lags = Eigen::VectorXd::Constant(points.rows(), std::nan(""));
  if (!is_path(points)) return lags;
  const double radius = kRadius * usual_step(points);
  const Neighbours neighbours(points);
  for (Index i = 0; i < points.rows(); ++i)
    lags[i] = return_to(points, neighbours.within(points.row(i), radius), i);
  return lags;
}

std::optional<PathMap> map_paths(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  if (first.cols() != second.cols() || !is_path(first) || !is_path(second)) return std::nullopt;
  const double radius = kRadius * std::max(usual_step(first), usual_step(second));
  const Neighbours neighbours(second);
  std::vector<double> place(static_cast<std::size_t>(first.rows()), std::nan(""));
  for (Index i = 0; i < first.rows(); ++i) {
    const auto near = neighbours.within(first.row(i), radius);
    if (near.empty()) continue;
    place[static_cast<std::size_t>(i)] =
        project(second, nearest(second, near, 0, near.size(), first.row(i)), first.row(i));
  }
  constexpr std::size_t kSpan = 20;  // rows, over which a slope is good to a few per cent
  std::vector<double> slopes, offsets;
  for (std::size_t i = kSpan; i < place.size(); ++i) {
    const double slope = (place[i] - place[i - kSpan]) / static_cast<double>(kSpan);
    if (std::isfinite(slope)) slopes.push_back(slope);
  }
  if (slopes.size() < kSpan) return std::nullopt;
  PathMap map;
  // The median slope is coarse; the line between the ends of its inliers makes it exact.
  map.rate = maths::median(slopes);
  // Rows from the line that still belong to it: at first 2 % of the path, by which the median slope may miss
  // its end; then the two rows to which a neighbour is known.
  constexpr double kCoarse = 0.02, kFine = 2;
  // Of the rows of the first path: fewer on the line are not the same path.
  constexpr double kLeastShare = 0.7;
  for (int round = 0; round < 2; ++round) {
    offsets.clear();
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (std::isfinite(place[i])) offsets.push_back(place[i] - map.rate * static_cast<double>(i));
    }
    map.offset = maths::median(offsets);
    double n = 0, si = 0, sp = 0, sii = 0, sip = 0;
    const double allowed = round == 0 ? kCoarse * static_cast<double>(place.size()) + kFine : kFine;
    for (std::size_t i = 0; i < place.size(); ++i) {
      const auto x = static_cast<double>(i);
      if (!(std::abs(place[i] - map.offset - map.rate * x) <= allowed)) continue;
      n += 1, si += x, sp += place[i], sii += x * x, sip += x * place[i];
    }
    const double det = n * sii - si * si;
    if (det <= 0) return std::nullopt;
    map.rate = (n * sip - si * sp) / det;
    map.offset = (sp - map.rate * si) / n;
    map.share = n / static_cast<double>(place.size());
  }
  if (map.share < kLeastShare || map.rate == 0) return std::nullopt;
  return map;
}

}  // namespace vernier::timebase
