// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/moved.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/orthonormal.h"
#include "tools/model/chain/prediction.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Number of rows that are tried first. The same number is then tried between the neighbours of
/// the best row, and once more.
constexpr std::size_t kSplits = 16;
constexpr int kNarrowings = 3;
/// Limit of readings times parameters squared. Of more rows, every k-th is used.
constexpr double kMostProducts = 4e8;
/// Minimum number of rows on either side of a split, so that nine shifts are determined.
constexpr std::size_t kLeastApart = 8;
/// Share of the residual that a move must remove, and logarithm of the probability that it does so
/// by chance.
constexpr double kMostOfTheRest = 0.5, kLogChance = -20;
/// Share of the common decrease that a single cause must reach to be reported.
constexpr double kAlone = 0.9;
constexpr Index kToolShifts = 3, kSetUpShifts = 6;

void append_probe(model::Machine& machine, std::vector<model::Transform>& branch, std::size_t count) {
  model::Transform transform;
  transform.n = branch.empty() ? 1 : branch.back().n + 1;
  for (std::size_t d = 0; d < 6; ++d) {
    model::Expr expr;
    if (d < count) {
      model::Static probe;
      probe.name = "move " + std::to_string(machine.statics.size());
      expr.op = model::Op::kSymbol;
      expr.name = probe.name;
      expr.symbol = {model::SymbolKind::kStatic, machine.statics.size()};
      machine.statics.push_back(probe);
    }
    transform.dof[d] = std::make_shared<const model::Expr>(expr);
  }
  branch.push_back(transform);
}

/// Returns the influence of the tool point's shift and of the workpiece's shift and rotation on
/// each reading.
MatrixXd motion_columns(const model::Machine& fitted, const model::Measurement& rows) {
  model::Machine probed = fitted;
  for (model::Freedom& one : model::freedoms_of(probed)) one.set_free(false);
  append_probe(probed, probed.tool, kToolShifts);
  append_probe(probed, probed.workpiece, kSetUpShifts);
  const model::ParameterSet probes(probed, {});
  return MatrixXd(model::linearise(probed, rows, probes).jacobian);
}

class MoveSearch {
 public:
  MoveSearch(const model::Machine& fitted, const model::Measurement& rows,
             const model::ParameterSet& parameters, const VectorXd& centre, const VectorXd& scale,
             const VectorXd& nominal)
      : measurement_(rows) {
    const VectorXd weights = fit_weights(rows);
    const auto p = static_cast<double>(parameters.size());
    const std::vector<std::size_t> all = fitted_readings(weights);
    const auto stride = static_cast<std::size_t>(
        std::max(1.0, std::ceil(static_cast<double>(all.size()) * (p + 60) * (p + 60) / kMostProducts)));
    for (std::size_t i = 0; i < all.size(); i += stride) kept_.push_back(all[i]);
    std::vector<Index> kept(kept_.begin(), kept_.end());
    const model::Linearisation linear = model::linearise(fitted, rows, parameters);
    const VectorXd w = weights(kept);
    motion_ = w.asDiagonal() * motion_columns(fitted, rows)(kept, Eigen::all);
    nominal_ = w.cwiseProduct(nominal(kept));
    VectorXd rest(w.size());
    for (Index i = 0; i < w.size(); ++i) {
      const std::size_t at = kept_[static_cast<std::size_t>(i)];
      rest[i] = w[i] * (rows.observations[at].value - linear.predicted[static_cast<Index>(at)]);
    }
    make_basis(w.asDiagonal() * MatrixXd(linear.jacobian)(kept, Eigen::all),
               (centre - parameters.get(fitted)).cwiseQuotient(scale), scale, rest);
  }

  std::optional<Move> run() {
    const std::size_t n = kept_.size();
    if (static_cast<double>(n) < static_cast<double>(basis_.cols()) / 2 + 60) return std::nullopt;
    std::size_t low = 0, high = n;
    for (int round = 0; round < kNarrowings && high - low > 1; ++round) {
      try_between(low, high);
      if (!best_.row) return std::nullopt;
      const std::size_t step = (high - low) / kSplits + 1;
      low = best_.at - std::min(best_.at, step);
      high = std::min(n, best_.at + step);
    }
    return believed();
  }

 private:
  struct Split {
    std::optional<std::size_t> row;
    std::size_t at = 0;
    double gain = 0;
  };

  /// Writes readings and, below them, the terms that hold each parameter near its centre, as one
  /// least-squares problem.
  void make_basis(const MatrixXd& jacobian, const VectorXd& off, const VectorXd& scale,
                  const VectorXd& rest) {
    const Index n = jacobian.rows(), p = jacobian.cols();
    const double spread =
        std::max(1e-12, has_uncertainty(measurement_) ? 1 : rest.norm() / std::sqrt(static_cast<double>(n)));
    MatrixXd all(n + p, p);
    all.topRows(n) = jacobian * scale.asDiagonal();
    all.bottomRows(p) = spread * MatrixXd::Identity(p, p);
    rest_.resize(n + p);
    rest_ << rest, spread * off;
    basis_ = maths::thin_q(all);
    rest_ -= basis_ * (basis_.transpose() * rest_);
  }

  std::size_t row_at(std::size_t at) const { return measurement_.observations[kept_[at]].row; }

  MatrixXd from(std::size_t at, Index first, Index count) const {
    MatrixXd columns = MatrixXd::Zero(rest_.size(), count);
    const auto top = static_cast<Index>(at), n = static_cast<Index>(kept_.size());
    columns.middleRows(top, n - top) = motion_.block(top, first, n - top, count);
    return columns;
  }

  double gain_of(std::size_t at, Index first, Index count) const {
    MatrixXd columns = from(at, first, count);
    columns -= basis_ * (basis_.transpose() * columns);
    const MatrixXd own = maths::orthonormal(columns, 1e-6, nullptr);
    return (own.transpose() * rest_).squaredNorm();
  }

  void try_between(std::size_t low, std::size_t high) {
    for (std::size_t k = 1; k < kSplits; ++k) {
      std::size_t at = low + (high - low) * k / kSplits;
      while (at > 0 && row_at(at - 1) == row_at(at)) --at;  // a row is not divided
      if (at == 0 || row_at(at) < kLeastApart + row_at(0) ||
          row_at(kept_.size() - 1) < kLeastApart + row_at(at))
        continue;
      if (best_.row == row_at(at)) continue;
      const double gain = gain_of(at, 0, kToolShifts + kSetUpShifts);
      if (!best_.row || gain > best_.gain) best_ = {row_at(at), at, gain};
    }
  }

  std::optional<Move> believed() const {
    const double all = rest_.squaredNorm();
    constexpr double kShifts = kToolShifts + kSetUpShifts;
    const double freedom = static_cast<double>(kept_.size()) - kShifts;
    const double left = std::max(all - best_.gain, 1e-300);
    if (best_.gain < kMostOfTheRest * all) return std::nullopt;
    if (maths::log_f_tail((best_.gain / kShifts) / (left / freedom), kShifts, freedom) > kLogChance)
      return std::nullopt;
    // For the nominal machine: the residual beside the move and the set-up of all rows.
    const MatrixXd moved = maths::orthonormal(beside_set_up(), 1e-9, nullptr);
    const MatrixXd still = maths::orthonormal(MatrixXd(motion_.rightCols(kSetUpShifts)), 1e-9, nullptr);
    const double with = (nominal_ - moved * (moved.transpose() * nominal_)).squaredNorm();
    const double without = (nominal_ - still * (still.transpose() * nominal_)).squaredNorm();
    Move move;
    move.share = std::sqrt(std::max(0.0, without - with) / std::max(with, 1e-300));
    const double tool = gain_of(best_.at, 0, kToolShifts),
                 set_up = gain_of(best_.at, kToolShifts, kSetUpShifts);
    const bool of_tool = tool > kAlone * best_.gain, of_set_up = set_up > kAlone * best_.gain;
    move.words = fmt::format("{} moved before {}",
                             of_tool == of_set_up ? "tool or set-up"
                             : of_tool            ? "the tool"
                                                  : "the set-up",
                             place_of(*best_.row));
    return move;
  }

  std::string place_of(std::size_t row) const {
    if (row >= measurement_.line.size()) return fmt::format("row {}", row + 1);
    return fmt::format("{}:{}", measurement_.files[measurement_.file[row]], measurement_.line[row]);
  }

  MatrixXd beside_set_up() const {
    const Index n = motion_.rows();
    MatrixXd columns(n, kToolShifts + 2 * kSetUpShifts);
    columns << motion_.rightCols(kSetUpShifts), from(best_.at, 0, kToolShifts + kSetUpShifts).topRows(n);
    return columns;
  }

  const model::Measurement& measurement_;
  std::vector<std::size_t> kept_;  // observations
  MatrixXd motion_, basis_;
  VectorXd rest_, nominal_;
  Split best_;
};

}  // namespace

std::optional<Move> find_move(const model::Machine& fitted, const model::Measurement& rows,
                              const model::ParameterSet& parameters, const VectorXd& centre,
                              const VectorXd& scale, const VectorXd& nominal) {
  return MoveSearch(fitted, rows, parameters, centre, scale, nominal).run();
}

}  // namespace vernier::fit
