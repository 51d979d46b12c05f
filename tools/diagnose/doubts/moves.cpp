// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/doubts/moves.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "tools/effects/places.h"
#include "tools/maths/golden.h"
#include "tools/maths/orthonormal.h"

namespace vernier::diagnose {
namespace {

/// More moves than these are not tested: their matrix of scalar products would take longer than the search.
constexpr std::size_t kMostMoves = 500;

/// Returns the number of the move of an axis between its reversals for each fit observation, in the order of
/// the file.
std::vector<Eigen::Index> moves_of(const Evidence& evidence, std::size_t axis) {
  std::vector<Eigen::Index> moves;
  int sense = 0;
  Eigen::Index last = 0;
  for (const std::size_t row : evidence.rows()) {
    const int now = evidence.sense_of(axis, row);
    if (now * sense < 0) ++last;
    if (now != 0) sense = now;
    moves.push_back(last);
  }
  return moves;
}

/// Returns one column for each move: the whitened readings per unit of an offset at a location.
Eigen::MatrixXd columns_of(const Evidence& evidence, const std::vector<Eigen::Index>& moves,
                           std::size_t place) {
  const auto response = evidence.response(place);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(response.size(), moves.back() + 1);
  for (Eigen::Index i = 0; i < response.size(); ++i)
    columns(i, moves[static_cast<std::size_t>(i)]) = response[i];
  evidence.whiten(columns);
  return columns;
}

/// A combination of offsets that is independent of the other combinations.
struct Direction {
  double square = 0, with_residual = 0;  // scalar products with itself and with the residual
};

/// Returns independent combinations of the columns of moves, beside the orthonormal columns of other effects.
std::vector<Direction> directions_of(const Evidence& evidence, Eigen::MatrixXd columns,
                                     const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) {
  columns = evidence.beside_model(columns);
  columns -= beside * (beside.transpose() * columns);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(columns.transpose() * columns);
  const Eigen::VectorXd products = eigen.eigenvectors().transpose() * (columns.transpose() * residual);
  std::vector<Direction> directions;
  const double least = 1e-12 * std::max(0.0, eigen.eigenvalues().maxCoeff());
  for (Eigen::Index i = 0; i < products.size(); ++i)
    if (eigen.eigenvalues()[i] > least) directions.push_back({eigen.eigenvalues()[i], products[i]});
  return directions;
}

/// Returns the largest decrease of -2 log likelihood by independent normal offsets of all moves (restricted
/// likelihood).
double decrease_by(const std::vector<Direction>& moves) {
  double largest = 0, most = 0;
  for (const Direction& move : moves) {
    largest = std::max(largest, move.square);
    if (move.square > 0) most = std::max(most, std::pow(move.with_residual / move.square, 2));
  }
  if (largest <= 0 || most <= 0) return 0;
  const auto decrease = [&](double log_variance) {
    const double variance = std::exp(log_variance);
    double sum = 0;
    for (const Direction& move : moves) {
      const double spread = 1 + variance * move.square;
      sum += variance * move.with_residual * move.with_residual / spread - std::log(spread);
    }
    return sum;
  };
  // From an offset that no move shows to the largest offset.
  constexpr double kUnseen = 1e-3;
  constexpr int kSections = 30;  // of a golden search: to a millionth of the range
  return std::max(
      0.0, maths::golden_peak(decrease, std::log(kUnseen / largest), std::log(most) + 1, kSections).value);
}

/// Returns orthonormal columns of several items beside the free parameters of the model.
Eigen::MatrixXd basis_of(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items) {
  std::vector<Eigen::MatrixXd> parts;
  for (const std::size_t item : items)
    parts.push_back(evidence.columns(pool.candidate(item), pool[item].scored.scanned));
  return AcceptedColumns(evidence.beside_model(maths::side_by_side(evidence.residual().size(), parts))).basis;
}

/// Returns the residual beside orthonormal columns.
Eigen::VectorXd residual_beside(const Evidence& evidence, const Eigen::MatrixXd& basis) {
  return evidence.residual() - basis * (basis.transpose() * evidence.residual());
}

/// Returns the evidence with the own noise of every observation, and nothing that observations share.
Evidence with_independent_noise(const Evidence& evidence) {
  Evidence independent = evidence;
  if (evidence.noise().independent()) return independent;
  fit::NoiseModel noise;
  noise.own = evidence.noise().own;
  independent.assume(noise);
  return independent;
}

/// An axis with moves that can have a variance of their own.
struct MovingAxis {
  std::size_t axis = 0, place = 0;  // index of the axis, and of its own location
  std::vector<Eigen::Index> moves;  // of each fit observation
};

std::vector<MovingAxis> moving_axes(const Evidence& evidence) {
  std::vector<MovingAxis> list;
  const effects::AxisPlaces axes(evidence.machine());
  for (std::size_t axis = 0; axis < evidence.machine().axes.size(); ++axis) {
    const std::optional<effects::DofPlace> place = axes.own(axis);
    if (!place) continue;
    MovingAxis one{axis, evidence.index_of(*place), moves_of(evidence, axis)};
    const auto count = static_cast<std::size_t>(one.moves.back() + 1);
    if (static_cast<double>(count) >= evidence.thresholds().shape.moves && count <= kMostMoves)
      list.push_back(std::move(one));
  }
  return list;
}

}  // namespace

std::string doubt_of_moves(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t item) {
  if (!evidence.noise_known()) return {};
  const std::vector<MovingAxis> axes = moving_axes(evidence);
  if (axes.empty()) return {};
  const Evidence independent = with_independent_noise(evidence);
  if (!independent.observations_are_independent()) return {};
  std::vector<std::size_t> others;
  for (const std::size_t other : items)
    if (other != item) others.push_back(other);
  // -2 log likelihood and the price of the parameters (BIC), without what both models have in common.
  const double price = std::log(static_cast<double>(evidence.rows().size()));
  const double with_item =
      residual_beside(evidence, basis_of(evidence, pool, items)).squaredNorm() + evidence.log_determinant() +
      price * (static_cast<double>(pool[item].scored.unknowns) + evidence.noise().price());
  const Eigen::MatrixXd beside = basis_of(independent, pool, others);
  const Eigen::VectorXd without = residual_beside(independent, beside);
  const double limit = with_item + evidence.thresholds().acceptance.distance;
  for (const MovingAxis& one : axes) {
    const double decrease = decrease_by(
        directions_of(independent, columns_of(independent, one.moves, one.place), beside, without));
    if (without.squaredNorm() - decrease + independent.log_determinant() + price > limit) continue;
    return fmt::format(
        "{} explains the readings no better than an offset of {} that changes at each of {} reversals "
        "(stick-slip)",
        pool.candidate(item).spoken, evidence.machine().axes[one.axis].name, one.moves.back());
  }
  return {};
}

}  // namespace vernier::diagnose
