// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/trials.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace vernier::tolerance {

Eigen::MatrixXd Normals::draw(Eigen::Index rows, Eigen::Index columns) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [this]() { return next(); });
}

double Normals::uniform() { return (static_cast<double>(engine_() >> 11U) + 0.5) * 0x1p-53; }

double Normals::next() {
  const double radius = std::sqrt(-2 * std::log(uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

Eigen::MatrixXd draw_discrepancy(Normals& normals, const Eigen::Matrix3Xd& points,
                                 const Eigen::Vector3d& std_mm, double shortest_mm, double longest_mm,
                                 Eigen::Index draws) {
  constexpr int kWaves = 3;  // of a field
  Eigen::MatrixXd fields = Eigen::MatrixXd::Zero(3 * points.cols(), draws);
  for (Eigen::Index k = 0; k < draws; ++k)
    for (Eigen::Index direction = 0; direction < 3; ++direction) {
      if (!(std_mm[direction] > 0)) continue;
      for (int wave = 0; wave < kWaves; ++wave) {
        Eigen::Vector3d along(normals.next(), normals.next(), normals.next());
        if (normals.uniform() < 0.5)
          along = Eigen::Vector3d::Unit(
              std::min<Eigen::Index>(2, static_cast<Eigen::Index>(3 * normals.uniform())));
        const double length_mm = shortest_mm * std::pow(longest_mm / shortest_mm, normals.uniform());
        const Eigen::Vector3d turn = 2 * std::numbers::pi / length_mm * along.normalized();
        const double size = std_mm[direction] / std::sqrt(static_cast<double>(kWaves));
        const double a = size * normals.next(), b = size * normals.next();
        const Eigen::ArrayXd phase = (turn.transpose() * points).transpose().array();
        const Eigen::VectorXd field = (a * phase.cos() + b * phase.sin()).matrix();
        for (Eigen::Index i = 0; i < points.cols(); ++i) fields(3 * i + direction, k) += field[i];
      }
    }
  return fields;
}

void TrialTally::take(std::vector<double>& block, const std::optional<std::array<double, 2>>& limits) {
  std::sort(block.begin(), block.end());
  const auto at = [&](double share) {
    return block[static_cast<std::size_t>(std::lround(share * static_cast<double>(block.size() - 1)))];
  };
  low_.push_back(at(0.025));
  high_.push_back(at(0.975));
  for (const double value : block) {
    sum_ += value;
    squares_ += value * value;
    if (limits && value >= (*limits)[0] && value <= (*limits)[1]) ++conforming_;
  }
  trials_ += block.size();
}

double TrialTally::mean() const { return sum_ / static_cast<double>(trials_); }

double TrialTally::std() const {
  return std::sqrt(std::max(0.0, squares_ / static_cast<double>(trials_) - mean() * mean()));
}

double TrialTally::conforming() const {
  return static_cast<double>(conforming_) / static_cast<double>(trials_);
}

double TrialTally::average(const std::vector<double>& list) {
  return std::accumulate(list.begin(), list.end(), 0.0) / static_cast<double>(list.size());
}

double TrialTally::doubt() const {
  double worst = 0;
  for (const auto* list : {&low_, &high_}) {
    double rest = 0;
    for (const double one : *list) rest += std::pow(one - average(*list), 2);
    const auto h = static_cast<double>(list->size());
    worst = std::max(worst, 2 * std::sqrt(rest / (h * (h - 1))));
  }
  return worst;
}

}  // namespace vernier::tolerance
