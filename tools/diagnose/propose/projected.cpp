// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/projected.h"

#include <algorithm>
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

std::vector<std::size_t> KnownProducts::prepare(const Eigen::MatrixXd& columns, std::size_t batches) {
  constexpr std::size_t kMost = 400;  // columns: with 20 000 stored columns 64 MB of products
  if (known_.size() + static_cast<std::size_t>(columns.cols()) > kMost) known_.clear();
  std::vector<std::size_t> prepared;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const auto is_it = [&](const Known& known) { return known.column == columns.col(j); };
    const auto found = std::find_if(known_.begin(), known_.end(), is_it);
    prepared.push_back(static_cast<std::size_t>(found - known_.begin()));
    if (found == known_.end()) known_.push_back({columns.col(j), {}});
  }
  for (const std::size_t k : prepared) known_[k].of_batch.resize(batches);
  return prepared;
}

std::vector<Eigen::Index> KnownProducts::missing(const std::vector<std::size_t>& prepared,
                                                 std::size_t at) const {
  std::vector<Eigen::Index> positions;
  for (std::size_t i = 0; i < prepared.size(); ++i)
    if (known_[prepared[i]].of_batch[at].size() == 0) positions.push_back(static_cast<Eigen::Index>(i));
  return positions;
}

void KnownProducts::store(const std::vector<std::size_t>& prepared,
                          const std::vector<Eigen::Index>& positions, std::size_t at,
                          const Eigen::MatrixXd& products) {
  for (std::size_t i = 0; i < positions.size(); ++i)
    known_[prepared[static_cast<std::size_t>(positions[i])]].of_batch[at] =
        products.row(static_cast<Eigen::Index>(i));
}

Eigen::MatrixXd KnownProducts::products(const std::vector<std::size_t>& prepared, std::size_t at) const {
  Eigen::MatrixXd all(static_cast<Eigen::Index>(prepared.size()), known_[prepared.at(0)].of_batch[at].size());
  for (std::size_t i = 0; i < prepared.size(); ++i)
    all.row(static_cast<Eigen::Index>(i)) = known_[prepared[i]].of_batch[at];
  return all;
}

namespace {

constexpr Eigen::Index kMost = 20'000'000;  // numbers in a store: 160 MB

}  // namespace

bool ProjectedColumns::have_room(Eigen::Index numbers) { return numbers <= kMost; }

void ProjectedColumns::renew(const Evidence& evidence, std::size_t candidates) {
  if (revision_ != evidence.revision()) {
    revision_ = evidence.revision();
    room_ = kMost;
    batches_.clear();
    products_.clear();
    held_.clear();
    waves_.clear();
  }
  held_.resize(candidates);
  waves_.resize(candidates);
}

Eigen::MatrixXd ProjectedColumns::products_of(const std::vector<std::size_t>& prepared, std::size_t at) {
  const std::vector<Eigen::Index> missing = products_.missing(prepared, at);
  if (!missing.empty()) {
    const Eigen::MatrixXd& columns = batches_[at].columns;
    Eigen::MatrixXd directions(columns.rows(), static_cast<Eigen::Index>(missing.size()));
    for (std::size_t i = 0; i < missing.size(); ++i)
      directions.col(static_cast<Eigen::Index>(i)) =
          products_.column(prepared[static_cast<std::size_t>(missing[i])]);
    products_.store(prepared, missing, at, directions.transpose() * columns);
  }
  return products_.products(prepared, at);
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
