// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/projected.h"

#include <utility>

namespace vernier::diagnose {

ProjectedBatch project(const Evidence& evidence, std::vector<GridPoint> points, Eigen::MatrixXd columns) {
  ProjectedBatch batch{std::move(points), std::move(columns), {}, {}};
  batch.norms = batch.columns.colwise().norm();
  const Eigen::MatrixXd& q = evidence.absorbed();
  const Eigen::MatrixXd part = q.transpose() * batch.columns;
  batch.columns.noalias() -= q * part;
  batch.grams.reserve(batch.points.size());
  for (const GridPoint& point : batch.points) {
    const auto own = batch.columns.middleCols(point.first, point.count);
    batch.grams.emplace_back(own.transpose() * own);
  }
  return batch;
}

void ProjectedColumns::renew(const Evidence& evidence, std::size_t candidates) {
  constexpr Eigen::Index kMost = 20'000'000;  // numbers: 160 MB
  if (revision_ != evidence.revision()) {
    revision_ = evidence.revision();
    room_ = kMost;
    batches_.clear();
    held_.clear();
    waves_.clear();
  }
  held_.resize(candidates);
  waves_.resize(candidates);
}

const ProjectedWaves* ProjectedColumns::waves(std::size_t candidate) const {
  return waves_[candidate].columns.cols() == 0 ? nullptr : &waves_[candidate];
}

void ProjectedColumns::keep(ProjectedBatch batch) {
  if (!has_room(batch.columns.size())) return;
  room_ -= batch.columns.size();
  for (const GridPoint& point : batch.points) held_[point.candidate] = 1;
  batches_.push_back(std::move(batch));
}

const ProjectedWaves& ProjectedColumns::keep(std::size_t candidate, ProjectedWaves waves) {
  room_ -= waves.columns.size();
  return waves_[candidate] = std::move(waves);
}

}  // namespace vernier::diagnose
