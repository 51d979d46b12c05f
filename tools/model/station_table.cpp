// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/station_table.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tools/maths/decompositions.h"

namespace vernier::model {
namespace {

/// Returns the second derivatives of the interpolating cubic spline as a linear map of the values
/// (natural ends).
Eigen::MatrixXd natural_curvature(const std::vector<double>& x) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n, n), right = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double h0 = x[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(i - 1)];
    const double h1 = x[static_cast<std::size_t>(i + 1)] - x[static_cast<std::size_t>(i)];
    left(i, i - 1) = h0 / 6;
    left(i, i) = (h0 + h1) / 3;
    left(i, i + 1) = h1 / 6;
    right(i, i - 1) = 1 / h0;
    right(i, i) = -1 / h0 - 1 / h1;
    right(i, i + 1) = 1 / h1;
  }
  return maths::solve_square(left, right);
}

/// The same for a periodic spline; the last station repeats the first.
Eigen::MatrixXd periodic_curvature(const std::vector<double>& x) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const Eigen::Index m = n - 1;  // different stations
  Eigen::MatrixXd left = Eigen::MatrixXd::Zero(m, m), right = Eigen::MatrixXd::Zero(m, m);
  const auto width = [&](Eigen::Index i) {
    const auto k = static_cast<std::size_t>((i + m) % m);
    return x[k + 1] - x[k];
  };
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index before = (i + m - 1) % m, after = (i + 1) % m;
    const double h0 = width(i - 1), h1 = width(i);
    left(i, before) += h0 / 6;
    left(i, i) += (h0 + h1) / 3;
    left(i, after) += h1 / 6;
    right(i, before) += 1 / h0;
    right(i, i) += -1 / h0 - 1 / h1;
    right(i, after) += 1 / h1;
  }
  const Eigen::MatrixXd inner = maths::solve_square(left, right);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n, n);
  whole.topLeftCorner(m, m) = inner;
  whole.row(m).head(m) = inner.row(0);
  return whole;
}

}  // namespace

StationTable::StationTable(const Table& table) : table_(table) {
  for (const Station& station : table.stations) loc_.push_back(station.loc);
  if (table.interpolation != Interpolation::kCubic || loc_.size() < 3) return;
  curvature_ = table.periodic ? periodic_curvature(loc_) : natural_curvature(loc_);
  bend_.resize(loc_.size());
  for (std::size_t i = 0; i < loc_.size(); ++i)
    for (std::size_t c = 0; c < 6; ++c) {
      bend_[i][c] = 0;
      for (std::size_t k = 0; k < loc_.size(); ++k)
        bend_[i][c] += curvature_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) *
                       table.stations[k].value[c];
    }
}

StationTable::Spot StationTable::spot(double raw) const {
  if (loc_.size() == 1) return {0, 0, 1, true};
  const double first = loc_.front(), last = loc_.back();
  if (table_.periodic)
    raw = first + (raw - first) - (last - first) * std::floor((raw - first) / (last - first));
  const std::size_t segments = loc_.size() - 1;
  if (raw <= first) return {0, 0, loc_[1] - loc_[0], raw < first};
  if (raw >= last) return {segments - 1, 1, loc_[segments] - loc_[segments - 1], raw > last};
  const auto after = std::upper_bound(loc_.begin(), loc_.end(), raw);
  const auto segment = static_cast<std::size_t>(after - loc_.begin()) - 1;
  const double width = loc_[segment + 1] - loc_[segment];
  return {segment, (raw - loc_[segment]) / width, width, false};
}

std::array<double, 6> StationTable::values(double raw) const {
  const Spot s = spot(raw);
  std::array<double, 6> result = table_.stations[s.segment].value;
  if (loc_.size() == 1) return result;
  const auto& next = table_.stations[s.segment + 1].value;
  const double b = s.fraction, a = 1 - b;
  const double ka = (a * a * a - a) * s.width * s.width / 6, kb = (b * b * b - b) * s.width * s.width / 6;
  for (std::size_t c = 0; c < 6; ++c) {
    result[c] = a * result[c] + b * next[c];
    if (!bend_.empty()) result[c] += ka * bend_[s.segment][c] + kb * bend_[s.segment + 1][c];
  }
  return result;
}

std::array<double, 6> StationTable::slopes(double raw) const {
  const Spot s = spot(raw);
  std::array<double, 6> result{};
  if (loc_.size() == 1 || s.held) return result;
  const double b = s.fraction, a = 1 - b;
  for (std::size_t c = 0; c < 6; ++c) {
    result[c] = (table_.stations[s.segment + 1].value[c] - table_.stations[s.segment].value[c]) / s.width;
    if (!bend_.empty())
      result[c] +=
          s.width / 6 * ((3 * b * b - 1) * bend_[s.segment + 1][c] - (3 * a * a - 1) * bend_[s.segment][c]);
  }
  return result;
}

void StationTable::weights(double raw, std::vector<std::pair<std::size_t, double>>& result) const {
  result.clear();
  const Spot s = spot(raw);
  if (loc_.size() == 1) {
    result.emplace_back(0, 1.0);
    return;
  }
  const double b = s.fraction, a = 1 - b;
  const auto folded = [&](std::size_t i) { return table_.periodic && i + 1 == loc_.size() ? 0 : i; };
  if (bend_.empty()) {
    if (a != 0) result.emplace_back(folded(s.segment), a);
    if (b == 0) return;
    if (!result.empty() && result.back().first == folded(s.segment + 1))
      result.back().second += b;
    else
      result.emplace_back(folded(s.segment + 1), b);
    return;
  }
  const double ka = (a * a * a - a) * s.width * s.width / 6, kb = (b * b * b - b) * s.width * s.width / 6;
  const std::size_t count = table_.periodic ? loc_.size() - 1 : loc_.size();
  const auto row = static_cast<Eigen::Index>(s.segment);
  for (std::size_t k = 0; k < count; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    double weight = ka * curvature_(row, column) + kb * curvature_(row + 1, column);
    if (k == folded(s.segment)) weight += a;
    if (k == folded(s.segment + 1)) weight += b;
    if (weight != 0) result.emplace_back(k, weight);
  }
}

std::array<double, 6> table_values(const Table& table, double raw) { return StationTable(table).values(raw); }

}  // namespace vernier::model
