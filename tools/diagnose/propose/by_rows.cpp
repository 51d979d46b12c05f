// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/by_rows.h"

#include <algorithm>
#include <utility>

namespace vernier::diagnose {
namespace {

/// Numbers that the sums of the model's columns may have in all (80 MB). Locations beyond it are summed again
/// for each use.
constexpr Eigen::Index kMostSums = 10'000'000;

/// Numbers of the columns that are whitened together (8 MB).
constexpr Eigen::Index kMostWhitened = 1'000'000;

/// Returns the scalar products of the columns of each grid point, of independent observations. `weights`: for
/// each pair of terms, the sum over the observations of a row of the product of their responses.
std::vector<Eigen::MatrixXd> grams_by_rows(const RowFunctions& functions,
                                           const std::vector<std::vector<Eigen::VectorXd>>& weights,
                                           const std::vector<GridPoint>& points) {
  const std::size_t terms = functions.of_term.size();
  std::vector<Eigen::MatrixXd> grams;
  for (const GridPoint& point : points) {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(point.count, point.count);
    for (std::size_t s = 0; s < terms; ++s)
      for (std::size_t t = 0; t < terms; ++t)
        for (Eigen::Index i = 0; i < point.count; ++i) {
          const Eigen::VectorXd weighted =
              functions.of_term[s].col(point.first + i).cwiseProduct(weights[s][t]);
          for (Eigen::Index j = i; j < point.count; ++j)
            gram(i, j) += weighted.dot(functions.of_term[t].col(point.first + j));
        }
    gram.triangularView<Eigen::StrictlyLower>() = gram.transpose();
    grams.push_back(std::move(gram));
  }
  return grams;
}

/// As grams_by_rows(), of correlated observations: from the whitened columns of some grid points at a time.
std::vector<Eigen::MatrixXd> grams_of_whitened(const Evidence& evidence, const effects::Candidate& effect,
                                               const RowFunctions& functions,
                                               const std::vector<GridPoint>& points) {
  const auto observations = static_cast<Eigen::Index>(evidence.rows().size());
  const Eigen::Index at_once = std::max<Eigen::Index>(1, kMostWhitened / (observations * functions.unknowns));
  std::vector<Eigen::MatrixXd> grams;
  for (Eigen::Index first = 0; first < std::ssize(points); first += at_once) {
    const Eigen::Index count = std::min<Eigen::Index>(at_once, std::ssize(points) - first);
    std::vector<Eigen::MatrixXd> of_term;
    for (const Eigen::MatrixXd& all : functions.of_term)
      of_term.push_back(all.middleCols(first * functions.unknowns, count * functions.unknowns));
    Eigen::MatrixXd columns = evidence.at_observations(effect, of_term);
    evidence.whiten(columns);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto own = columns.middleCols(i * functions.unknowns, functions.unknowns);
      grams.emplace_back(own.transpose() * own);
    }
  }
  return grams;
}

}  // namespace

void ByRows::prepare(const std::vector<std::size_t>& places, const Eigen::MatrixXd& known,
                     std::size_t candidates) {
  if (revision_ != evidence_.revision()) {
    revision_ = evidence_.revision();
    places_.assign(evidence_.places().size(), {});
    batches_.clear();
    products_.clear();
    own_ = evidence_.noise().own;
    absorbed_ = evidence_.absorbed();
    evidence_.whiten_transposed(absorbed_);
  }
  batches_.resize(candidates);
  prepared_ = products_.prepare(known, candidates);
  const auto rows = static_cast<Eigen::Index>(evidence_.fit_rows().size());
  Eigen::Index room = kMostSums;
  Eigen::MatrixXd transposed = known;
  evidence_.whiten_transposed(transposed);
  for (const std::size_t place : places) {
    places_[place].known = evidence_.sums_by_row(place, transposed);
    room -= rows * absorbed_.cols();
    if (places_[place].absorbed.rows() == 0 && room >= 0)
      places_[place].absorbed = evidence_.sums_by_row(place, absorbed_);
  }
}

bool ByRows::is_complete(std::size_t candidate) const {
  return batches_[candidate].has_value() && products_.missing(prepared_, candidate).empty();
}

ProjectedBatch ByRows::measured(std::size_t candidate, const effects::Candidate& effect,
                                const RowFunctions& functions) const {
  const std::size_t terms = functions.of_term.size();
  ProjectedBatch batch;
  for (std::size_t i = 0; i < functions.points.size(); ++i)
    batch.points.push_back({candidate, functions.points[i], static_cast<Eigen::Index>(i) * functions.unknowns,
                            functions.unknowns});
  Eigen::MatrixXd part = Eigen::MatrixXd::Zero(absorbed_.cols(), functions.of_term[0].cols());
  std::vector<std::vector<Eigen::VectorXd>> weights(terms);  // of independent observations
  const bool independent = evidence_.observations_are_independent();
  for (std::size_t s = 0; s < terms; ++s) {
    const std::size_t place = evidence_.index_of(effect.terms[s].place);
    const Eigen::MatrixXd& stored = places_[place].absorbed;
    if (stored.rows() > 0)
      part.noalias() += stored.transpose() * functions.of_term[s];
    else
      part.noalias() += evidence_.sums_by_row(place, absorbed_).transpose() * functions.of_term[s];
    for (std::size_t t = 0; independent && t < terms; ++t)
      weights[s].push_back(
          evidence_.sums_by_row(place, evidence_.response(evidence_.index_of(effect.terms[t].place))) /
          (own_ * own_));
  }
  const std::vector<Eigen::MatrixXd> grams =
      independent ? grams_by_rows(functions, weights, batch.points)
                  : grams_of_whitened(evidence_, effect, functions, batch.points);
  batch.norms.resize(part.cols());
  for (std::size_t i = 0; i < grams.size(); ++i) {
    const GridPoint& point = batch.points[i];
    batch.norms.segment(point.first, point.count) = grams[i].diagonal().transpose().cwiseMax(0).cwiseSqrt();
    const auto explained = part.middleCols(point.first, point.count);
    batch.grams.emplace_back(grams[i] - explained.transpose() * explained);
  }
  return batch;
}

void ByRows::complete(std::size_t candidate, const effects::Candidate& effect,
                      const RowFunctions& functions) {
  if (!batches_[candidate]) batches_[candidate] = measured(candidate, effect, functions);
  const std::vector<Eigen::Index> missing = products_.missing(prepared_, candidate);
  if (missing.empty()) return;
  Eigen::MatrixXd products =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(missing.size()), functions.of_term[0].cols());
  for (std::size_t t = 0; t < functions.of_term.size(); ++t) {
    const Eigen::MatrixXd sums =
        places_[evidence_.index_of(effect.terms[t].place)].known(Eigen::all, missing);
    products.noalias() += sums.transpose() * functions.of_term[t];
  }
  products_.store(prepared_, missing, candidate, products);
}

}  // namespace vernier::diagnose
