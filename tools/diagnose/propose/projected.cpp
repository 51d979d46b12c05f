// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/projected.h"

#include <utility>

namespace vernier::diagnose {

void ProjectedColumns::renew(const Evidence& evidence, std::size_t candidates) {
  constexpr Eigen::Index kMost = 20'000'000;  // numbers: 160 MB
  if (revision_ != evidence.revision()) {
    revision_ = evidence.revision();
    room_ = kMost;
    points_.clear();
    waves_.clear();
  }
  points_.resize(candidates);
  waves_.resize(candidates);
}

const std::vector<ProjectedPoint>* ProjectedColumns::points(std::size_t candidate) const {
  return points_[candidate].empty() ? nullptr : &points_[candidate];
}

const ProjectedWaves* ProjectedColumns::waves(std::size_t candidate) const {
  return waves_[candidate].columns.cols() == 0 ? nullptr : &waves_[candidate];
}

void ProjectedColumns::keep(std::size_t candidate, std::vector<ProjectedPoint> points) {
  Eigen::Index numbers = 0;
  for (const ProjectedPoint& point : points) numbers += point.columns.size();
  // Two threads that pass at one time may exceed the limit by one candidate each.
  if (numbers == 0 || !has_room(numbers)) return;
  room_ -= numbers;
  points_[candidate] = std::move(points);
}

const ProjectedWaves& ProjectedColumns::keep(std::size_t candidate, ProjectedWaves waves) {
  room_ -= waves.columns.size();
  return waves_[candidate] = std::move(waves);
}

}  // namespace vernier::diagnose
