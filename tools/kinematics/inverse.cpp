// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/inverse.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/kinematics/jacobian.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/maths/halton.h"
#include "tools/model/chain/evaluate.h"

namespace vernier::kinematics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Damping: start value, factors of increase and decrease, and limit beyond which no step is
/// tried.
constexpr double kFirstDamping = 1e-6, kGrow = 10, kShrink = 0.1, kMostDamping = 1e12, kLeastDamping = 1e-14;

std::vector<std::size_t> axes_of(const model::Machine& machine, const InverseOptions& options) {
  if (!options.axes.empty()) return options.axes;
  std::vector<std::size_t> all(machine.axes.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

/// One state during the iteration.
struct Walker {
  VectorXd residual;  // target - pose; mm and lever * rad
  double damping = kFirstDamping;
  bool done = false;
};

class InverseSolver {
 public:
  InverseSolver(const model::Machine& machine, const model::Poses& target, const model::States& start,
                const InverseOptions& options)
      : machine_(machine),
        target_(target),
        options_(options),
        axes_(axes_of(machine, options)),
        states_(start),
        walkers_(start.count),
        proofs_(start.count) {}

  InverseResult run() {
    iterate();
    // A chain may depend on the number of turns of an axis (a wound cable), so it is solved again
    // after whole turns.
    if (options_.keep_ranges && turn_into_ranges()) iterate();
    std::vector<Inverse> proofs = finish();
    return {std::move(states_), std::move(proofs)};
  }

 private:
  void iterate() {
    walkers_.assign(walkers_.size(), Walker{});
    measure(model::forward(machine_, states_));
    for (int i = 0; i < options_.most_iterations && step(); ++i) continue;
  }

  double length_of(const VectorXd& residual) const { return residual.norm(); }

  VectorXd residual_at(const model::Poses& poses, std::size_t i) const {
    return pose_error(poses, target_, i, options_.match, options_.lever_mm);
  }

  bool small(const VectorXd& residual) const {
    return residual.head<3>().norm() <= options_.tolerance_mm &&
           residual.tail(residual.size() - 3).norm() / options_.lever_mm * maths::kDegPerRad <=
               options_.tolerance_deg;
  }

  void measure(const model::Poses& poses) {
    for (std::size_t i = 0; i < walkers_.size(); ++i) {
      walkers_[i].residual = residual_at(poses, i);
      walkers_[i].done = small(walkers_[i].residual);
    }
  }

  /// Makes one damped Newton step of every active walker. Returns false if none is active.
  bool step() {
    if (std::all_of(walkers_.begin(), walkers_.end(), [](const Walker& w) { return w.done; })) return false;
    const std::vector<MatrixXd> jacobian =
        axis_jacobian(machine_, states_, axes_, options_.match, options_.lever_mm);
    model::States trial = states_;
    for (std::size_t i = 0; i < walkers_.size(); ++i)
      if (!walkers_[i].done) move(trial, i, damped_step(jacobian[i], walkers_[i]));
    const model::Poses poses = model::forward(machine_, trial);
    for (std::size_t i = 0; i < walkers_.size(); ++i)
      if (!walkers_[i].done) judge(trial, poses, jacobian[i], i);
    return true;
  }

  VectorXd damped_step(const MatrixXd& jacobian, const Walker& walker) const {
    const MatrixXd scaled = jacobian * axis_scales(machine_, axes_, options_.lever_mm).asDiagonal();
    MatrixXd normal = scaled.transpose() * scaled;
    normal.diagonal().array() += walker.damping;  // columns are scaled to about 1 mm per mm
    const VectorXd scaled_step = maths::solve_symmetric(normal, scaled.transpose() * walker.residual);
    return axis_scales(machine_, axes_, options_.lever_mm).cwiseProduct(scaled_step);
  }

  void move(model::States& states, std::size_t row, const VectorXd& by) const {
    for (std::size_t k = 0; k < axes_.size(); ++k)
      states.axis[axes_[k]][static_cast<Index>(row)] += by[static_cast<Index>(k)];
  }

  void judge(const model::States& trial, const model::Poses& poses, const MatrixXd& jacobian, std::size_t i) {
    Walker& walker = walkers_[i];
    ++proofs_[i].iterations;
    const VectorXd residual = residual_at(poses, i);
    const bool better = length_of(residual) < length_of(walker.residual);
    if (better) {
      for (const std::size_t axis : axes_)
        states_.axis[axis][static_cast<Index>(i)] = trial.axis[axis][static_cast<Index>(i)];
      walker.residual = residual;
      walker.damping = std::max(walker.damping * kShrink, kLeastDamping);
    } else {
      walker.damping *= kGrow;
    }
    const bool reached = options_.only_reachable ? reducible(jacobian, machine_, axes_, walker.residual,
                                                             options_) <= options_.tolerance_mm
                                                 : false;
    walker.done = small(walker.residual) || reached || walker.damping > kMostDamping;
  }

  std::vector<Inverse> finish() {
    const std::vector<MatrixXd> jacobian =
        axis_jacobian(machine_, states_, axes_, options_.match, options_.lever_mm);
    const model::Poses poses = model::forward(machine_, states_);
    for (std::size_t i = 0; i < walkers_.size(); ++i) {
      Inverse& proof = proofs_[i];
      const VectorXd residual = residual_at(poses, i);
      proof.residual_mm = residual.head<3>().norm();
      proof.residual_deg = residual.tail(residual.size() - 3).norm() / options_.lever_mm * maths::kDegPerRad;
      proof.reducible_mm = reducible(jacobian[i], machine_, axes_, residual, options_);
      proof.condition = condition_of(jacobian[i], machine_, axes_, options_);
      const bool met =
          options_.only_reachable ? proof.reducible_mm <= options_.tolerance_mm : small(residual);
      proof.fault = fault_of(proof, met, i);
      proof.converged = proof.fault == InverseFault::kNone;
    }
    return std::move(proofs_);
  }

  InverseFault fault_of(Inverse& proof, bool met, std::size_t row) {
    if (!options_.only_reachable && !(proof.condition <= options_.most_condition))
      return InverseFault::kSingular;
    if (!met) return InverseFault::kUnreachable;
    if (!options_.keep_ranges) return InverseFault::kNone;
    for (const std::size_t axis : axes_) {
      if (is_inside(states_.axis[axis][static_cast<Index>(row)], machine_.axes[axis])) continue;
      proof.axis = axis;
      return InverseFault::kBeyondRange;
    }
    return InverseFault::kNone;
  }

  /// Moves rotary axes by whole turns into their ranges. Returns false if no axis had to be moved.
  bool turn_into_ranges() {
    bool any = false;
    for (const std::size_t axis : axes_)
      for (double& value : states_.axis[axis]) {
        const double turned = turned_into_range(value, machine_.axes[axis]);
        any = any || turned != value;
        value = turned;
      }
    return any;
  }

  static bool is_inside(double value, const model::Axis& axis) {
    constexpr double kSlack = 1e-9;                 // of a target on the limit itself, mm or deg
    if (axis.rollover && axis.rotary) return true;  // it reaches every position within one turn
    return (!axis.min || value >= *axis.min - kSlack) && (!axis.max || value <= *axis.max + kSlack);
  }

  /// Returns the position in the range that differs by whole turns; the same position if there is
  /// none.
  static double turned_into_range(double value, const model::Axis& axis) {
    if (!axis.rotary) return value;
    const double near = std::remainder(value, 360.0);
    if (axis.rollover) return axis.min && near < *axis.min ? near + 360 : near;  // it has no other turn
    if (is_inside(value, axis)) return value;
    for (const double turn : {0.0, 360.0, -360.0, 720.0, -720.0})
      if (is_inside(near + turn, axis)) return near + turn;
    return value;
  }

  const model::Machine& machine_;
  const model::Poses& target_;
  const InverseOptions& options_;
  std::vector<std::size_t> axes_;
  model::States states_;
  std::vector<Walker> walkers_;
  std::vector<Inverse> proofs_;
};

/// Ordering of failures: the nearest one is reported.
bool better(const Inverse& a, const Inverse& b) {
  if (a.converged != b.converged) return a.converged;
  return a.residual_mm + a.residual_deg < b.residual_mm + b.residual_deg;
}

}  // namespace

const char* name_of(InverseFault fault) {
  switch (fault) {
    case InverseFault::kNone:
      return "none";
    case InverseFault::kSingular:
      return "singular";
    case InverseFault::kUnreachable:
      return "unreachable";
    case InverseFault::kBeyondRange:
      return "beyond-range";
  }
  return "";
}

InverseResult solve(const model::Machine& machine, const model::Poses& target, const model::States& start,
                    const InverseOptions& options) {
  return InverseSolver(machine, target, start, options).run();
}

InverseResult solve_anywhere(const model::Machine& machine, const model::Poses& target,
                             const model::States& start, const InverseOptions& options, int restarts) {
  constexpr std::array<std::size_t, 12> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  InverseResult best = solve(machine, target, start, options);
  const std::vector<std::size_t> axes = axes_of(machine, options);
  for (int i = 1; i <= restarts && !best.each[0].converged; ++i) {
    model::States other = start;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const model::Axis& axis = machine.axes[axes[k]];
      if (axis.min && axis.max)
        other.axis[axes[k]][0] =
            *axis.min + (*axis.max - *axis.min) *
                            maths::radical_inverse(static_cast<std::size_t>(i), kPrimes[k % kPrimes.size()]);
    }
    InverseResult next = solve(machine, target, other, options);
    if (better(next.each[0], best.each[0])) best = std::move(next);
  }
  return best;
}

std::vector<std::size_t> linear_axes(const model::Machine& machine) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (!machine.axes[i].rotary) result.push_back(i);
  return result;
}

}  // namespace vernier::kinematics
