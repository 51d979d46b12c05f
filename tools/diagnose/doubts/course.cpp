// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/doubts/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/doubts/moves.h"
#include "tools/diagnose/doubts/shape.h"
#include "tools/maths/chance.h"

namespace vernier::diagnose {
namespace {

using Index = Eigen::Index;
using model::SymbolKind;

/// Returns the states of the rows with constant quantities, so that a term depends on the positions only.
model::States held_states(const Evidence& evidence, const effects::Candidate& candidate) {
  model::States states = evidence.measurement().states;
  bool first = true;  // of a difference of two inputs, only one differs from its reference
  for (const auto& [kind, index] : drivers_of(evidence.machine(), candidate)) {
    if (kind < 0) {
      if (candidate.choice.runs.empty()) continue;
      const auto& names = states.run_names;
      const auto named = std::find(names.begin(), names.end(), candidate.choice.runs.front());
      std::fill(states.run.begin(), states.run.end(), static_cast<std::size_t>(named - names.begin()));
      continue;
    }
    switch (static_cast<SymbolKind>(kind)) {
      case SymbolKind::kInput:
        states.input[index].setConstant(
            first ? candidate.choice.reference.value_or(evidence.reference_of(index)) + 1
                  : evidence.reference_of(index));
        first = false;
        break;
      case SymbolKind::kTime:
        states.time.setConstant(states.time.maxCoeff());
        break;
      case SymbolKind::kVisit:
        states.visit.setConstant(std::max(1.0, states.visit.maxCoeff()));
        break;
      case SymbolKind::kDirection:
        states.direction[index].setConstant(1);
        break;
      case SymbolKind::kSince:
        states.since[index].setZero();
        break;
      default:
        break;
    }
  }
  return states;
}

/// Returns the columns of a candidate while its quantity is constant, before whitening: its dependence on the
/// positions.
Eigen::MatrixXd held_columns(const Evidence& evidence, const Pool& pool, std::size_t item) {
  const effects::Candidate& candidate = pool.candidate(item);
  ColumnMaker maker(evidence);
  return maker.raw_at(candidate, pool[item].scored.scanned, held_states(evidence, candidate));
}

/// Half-waves over the order of the rows, then over the time if it was recorded: a quantity follows the time,
/// or begins anew with each run.
Eigen::MatrixXd courses(const Evidence& evidence, int count) {
  const model::States& states = evidence.measurement().states;
  const auto last = static_cast<Index>(states.count);
  std::vector<Eigen::ArrayXd> over = {
      evidence.at_readings(model::Column::LinSpaced(last, 0, static_cast<double>(last - 1)))};
  if (const Eigen::ArrayXd time = evidence.at_readings(states.time); time.maxCoeff() > time.minCoeff())
    over.push_back(time);
  Eigen::MatrixXd waves(over.front().size(), count * static_cast<int>(over.size()));
  Index at = 0;
  for (const Eigen::ArrayXd& x : over)
    for (int m = 1; m <= count; ++m)
      waves.col(at++) =
          (std::numbers::pi * m * (x - x.minCoeff()) / std::max(x.maxCoeff() - x.minCoeff(), 1e-300)).cos();
  return waves;
}

/// The previous move of one axis, for each fit observation: its share of the whole move, and its length as a
/// fraction of the measured range of the axis. 0 for the first row of a run.
Eigen::MatrixXd previous_moves(const Evidence& evidence, std::size_t axis) {
  const model::Machine& machine = evidence.machine();
  const model::States& states = evidence.measurement().states;
  const auto move = [&](std::size_t one, std::size_t row) {
    const auto i = static_cast<Index>(row);
    return evidence.position(one)[i] - evidence.position(one)[i - 1];
  };
  const Evidence::Range range = evidence.range_of(axis);
  Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(static_cast<Index>(evidence.rows().size()), 2);
  for (Index i = 0; i < moves.rows(); ++i) {
    const std::size_t row = evidence.rows()[static_cast<std::size_t>(i)];
    if (row == 0 || states.run[row] != states.run[row - 1]) continue;
    double square = 0;
    for (std::size_t one = 0; one < machine.axes.size(); ++one)
      if (machine.axes[one].rotary == machine.axes[axis].rotary) square += std::pow(move(one, row), 2);
    if (square <= 0) continue;
    moves(i, 0) = move(axis, row) / std::sqrt(square);
    moves(i, 1) = move(axis, row) / std::max(range.high - range.low, 1e-300);
  }
  return moves;
}

Eigen::MatrixXd products(const Eigen::MatrixXd& shape, const Eigen::MatrixXd& course) {
  Eigen::MatrixXd all(shape.rows(), shape.cols() * course.cols());
  for (Index i = 0; i < shape.cols(); ++i)
    for (Index j = 0; j < course.cols(); ++j)
      all.col(i * course.cols() + j) = shape.col(i).cwiseProduct(course.col(j));
  return all;
}

struct Beside {
  double share = 0;  // of what effect and replacement explain together
  double log_p = 0;  // logarithm of the probability that noise alone makes the replacement explain as much
};

/// Compares an effect with a replacement of its quantity.
Beside beside_of(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                 std::size_t item, Eigen::MatrixXd replacement) {
  std::vector<std::size_t> others;
  for (const std::size_t other : items)
    if (other != item) others.push_back(other);
  evidence.whiten(replacement);
  const Gain more = gain_of(evidence, replacement, pool.columns(items));
  if (more.rank == 0) return {};
  const Eigen::MatrixXd own = evidence.columns(pool.candidate(item), pool[item].scored.scanned);
  Eigen::MatrixXd both(own.rows(), own.cols() + replacement.cols());
  both << own, replacement;
  const Gain all = gain_of(evidence, both, pool.columns(others));
  return {more.chi_square / std::max(all.chi_square, 1e-300),
          maths::log_chi_square_tail(more.chi_square, more.rank)};
}

}  // namespace

std::string doubt_of_course(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                            std::size_t item) {
  // Without a given uncertainty the residual is not known to be noise. It may contain other effects.
  if (!evidence.noise_known()) return {};
  const auto drivers = drivers_of(evidence.machine(), pool.candidate(item));
  const ShapeThresholds& limits = evidence.thresholds().shape;
  const Eigen::MatrixXd shape = held_columns(evidence, pool, item);
  if (shape.norm() == 0) return {};
  const auto doubted = [&](const Eigen::MatrixXd& course, double chance) {
    const Beside beside = beside_of(evidence, pool, items, item, products(shape, course));
    return beside.share > limits.course_share && beside.log_p < chance ? beside.share : 0.0;
  };
  // An effect that follows nothing in time must keep its size; every effect is asked, so the level is strict.
  const bool of_time = change_in_time(drivers);
  if (const double share =
          doubted(courses(evidence, static_cast<int>(evidence.thresholds().search.shape.most_half_waves)),
                  of_time ? limits.course_chance : limits.change_chance);
      share > 0)
    return fmt::format(
        "{} explains the error at its location only in part: {:.0f} % of this error has another course over "
        "the rows. The error depends on a quantity that no column records",
        pool.candidate(item).spoken, 100 * share);
  for (const auto& [kind, index] : drivers)
    if (static_cast<SymbolKind>(kind) == SymbolKind::kDirection)
      if (const double share = doubted(previous_moves(evidence, index), limits.course_chance); share > 0)
        return fmt::format(
            "{} depends on the approach direction only, but {:.0f} % of the error at its location depends on "
            "the previous move (its length, or its share of the whole move)",
            pool.candidate(item).spoken, 100 * share);
  return {};
}

std::string doubt_of(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                     std::size_t item) {
  for (const auto doubt : {doubt_of_shape, doubt_of_course, doubt_of_moves})
    if (std::string reason = doubt(evidence, pool, items, item); !reason.empty()) return reason;
  return {};
}

}  // namespace vernier::diagnose
