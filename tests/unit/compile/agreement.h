// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Dense>
#include <memory>
#include <stdexcept>
#include <vector>

#include "tests/unit/compile/poses.h"
#include "tools/maths/decompositions.h"

namespace vernier {

using namespace vernier::compile;
using namespace vernier::model;

/// What a comparison of the executed fixed-point program with the double chain has seen.
struct Agreement {
  double worst_um = 0;     // |fixed point - double chain|
  double worst_share = 0;  // of the proved bound
  double largest_um = 0;   // deviation itself, so that agreement on zero counts for nothing
  double whole_um = 0;     // as worst_um, with the second order that the bound does not contain
  std::size_t poses = 0;   // compared
  std::size_t at_steps =
      0;  // beyond the bound and not counted above: the machine has steps, some within a correction
};

/// The shares of the compensator's last step.
inline void shares_of(const Compensator& compensator, const ShareProgram& shares, const Program& program,
                      Correction* corrections) {
  EquationState state;
  std::vector<std::int32_t> registers(kMaxRegisters);
  compensator.state(state);
  if (!run_shares(shares, program, state, registers.data(), corrections)) throw std::logic_error("no shares");
}

/// Nominal motion of the tool point per mm or deg of each axis, for every state: by differences, a derivation
/// that shares nothing with the compiler's.
inline std::vector<Eigen::Matrix3Xd> nominal_directions(const Machine& machine, const States& states,
                                                        const std::vector<std::size_t>& axes) {
  const Machine nominal = nominal_machine(machine);
  std::vector<Eigen::Matrix3Xd> directions;
  for (const std::size_t axis : axes) {
    const double step = machine.axes[axis].rotary ? 1e-3 : 1.0;
    States ahead = states, behind = states;
    ahead.axis[axis] += step;
    behind.axis[axis] -= step;
    directions.push_back((forward(nominal, ahead).position - forward(nominal, behind).position) / (2 * step));
  }
  return directions;
}

/// p_actual where the axes stand corrected - p_nominal at the command, mm.
inline Eigen::Matrix3Xd left_over_mm(const Machine& machine, const States& corrected,
                                     const Eigen::Matrix3Xd& nominal_mm) {
  return forward(machine, corrected).position - nominal_mm;
}

/// Compares consecutive ticks, from a fresh start (the lags run through them), with the exact back solution c
/// of p_actual(q + c) = p_nominal(q). Linear axes: along each of them, where the axes that correct the
/// direction stand as the program has it. Least squares: what is left at the tool point, where the correction
/// does not fade; if the bound does not contain the second order, against as many steps of Newton's iteration
/// in double precision as the program has evaluations.
inline void compare_poses(const TestMachine& test, const std::vector<CycleInput>& inputs, Agreement& seen) {
  std::vector<std::size_t> axes, places;
  for (std::size_t k = 0; k < test.compiled.bounds.size(); ++k)
    if (!test.compiled.bounds[k].deviation_deg)
      axes.push_back(test.compiled.program.outputs[k].axis), places.push_back(k);
  const auto& least = test.compiled.least_squares;
  const States states = test.states_of(inputs);
  const Eigen::Matrix3Xd nominal_mm = forward(nominal_machine(test.machine), states).position,
                         before_mm = left_over_mm(test.machine, states, nominal_mm);
  const std::vector<Eigen::Matrix3Xd> moved = nominal_directions(test.machine, states, axes);
  const auto n = static_cast<Eigen::Index>(axes.size());
  const auto count = static_cast<Eigen::Index>(inputs.size());
  Compensator compensator(test.loaded->view.program()), dense(test.loaded->view.program());
  std::vector<DenseCell> cells(dense_size(test.loaded->view.program().equation));
  const auto frame = std::make_unique<DenseFrame>();
  dense.use_dense({cells.data(), static_cast<std::uint32_t>(cells.size()), frame.get()});
  Eigen::MatrixXd fixed(n, count);
  States turned = states, corrected = states;
  for (Eigen::Index i = 0; i < count; ++i) {
    compensator.step(inputs[static_cast<std::size_t>(i)]);
    dense.step(inputs[static_cast<std::size_t>(i)]);
    for (const Output& out : test.loaded->view.program().outputs)
      if (dense.register_value(out.source) != compensator.register_value(out.source))
        throw std::runtime_error("the dense form differs from the interpreted program");
    for (std::size_t k = 0; k < test.compiled.bounds.size(); ++k) {
      const std::size_t axis = test.compiled.program.outputs[k].axis;
      corrected.axis[axis][i] -= test.deviation_units(compensator, k);
      if (test.compiled.bounds[k].deviation_deg) turned.axis[axis][i] = corrected.axis[axis][i];
    }
    for (Eigen::Index k = 0; k < n; ++k)
      fixed(k, i) = test.deviation_units(compensator, places[static_cast<std::size_t>(k)]);
  }
  const auto directions_at = [&](Eigen::Index i) {
    Eigen::Matrix3Xd directions(3, n);
    for (Eigen::Index k = 0; k < n; ++k) directions.col(k) = moved[static_cast<std::size_t>(k)].col(i);
    return directions;
  };
  const auto take = [&](double error_um, double bound_um, double size_um) {
    seen.worst_um = std::max(seen.worst_um, error_um);
    seen.worst_share = std::max(seen.worst_share, error_um / bound_um);
    seen.largest_um = std::max(seen.largest_um, size_um);
  };
  if (least) {
    const Eigen::Matrix3Xd left_mm = left_over_mm(test.machine, corrected, nominal_mm);
    const bool with_second_order = test.compiled.bounds[0].second_order_um.has_value();
    const auto lever = Eigen::Map<const Eigen::VectorXd>(least->lever.data(), n);
    Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(n, count);
    for (int step = 0; step < test.compiled.evaluations && !with_second_order; ++step) {
      States there = states;
      for (Eigen::Index k = 0; k < n; ++k)
        there.axis[axes[static_cast<std::size_t>(k)]] -= steps.row(k).transpose().array();
      const Eigen::Matrix3Xd now_mm = left_over_mm(test.machine, there, nominal_mm);
      for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::MatrixXd scaled = directions_at(i) * lever.cwiseInverse().asDiagonal();
        steps.col(i) += maths::least_norm(scaled, now_mm.col(i)).cwiseQuotient(lever);
      }
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::MatrixXd scaled = directions_at(i) * lever.cwiseInverse().asDiagonal();
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU);
      const auto rank = static_cast<Eigen::Index>(least->jacobian.size());
      if (svd.singularValues().head(rank).array().square().prod() < least->floor * 1.001) continue;
      const Eigen::Matrix3Xd basis = svd.matrixU().leftCols(rank);
      const double whole_um = 1000 * (basis.transpose() * left_mm.col(i)).norm(),
                   program_um =
                       1000 * (basis.transpose() * directions_at(i) * (fixed.col(i) - steps.col(i))).norm();
      seen.whole_um = std::max(seen.whole_um, whole_um);
      take(with_second_order ? whole_um : program_um, test.compiled.bounds[0].total_um,
           1000 * before_mm.col(i).norm());
      ++seen.poses;
    }
    return;
  }
  // Newton's iteration with the nominal directions; far below a picometre after eight steps.
  Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(n, count);
  for (int step = 0; step < 8; ++step) {
    States there = turned;
    for (Eigen::Index k = 0; k < n; ++k)
      there.axis[axes[static_cast<std::size_t>(k)]] -= exact.row(k).transpose().array();
    const Eigen::Matrix3Xd left_mm = left_over_mm(test.machine, there, nominal_mm);
    for (Eigen::Index i = 0; i < count; ++i)
      exact.col(i) += maths::least_norm(directions_at(i), left_mm.col(i));
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    // Of a rotary axis: as motion of the tool point.
    const auto um_per_unit = [&](std::size_t at) {
      return 1000 * (test.machine.axes[axes[at]].rotary ? moved[at].col(i).norm() : 1);
    };
    bool beyond = false;
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      beyond = beyond || um_per_unit(at) * std::abs(fixed(k, i) - exact(k, i)) >
                             test.compiled.bounds[places[at]].total_um;
    }
    if (beyond && !test.compiled.switching.empty() && ++seen.at_steps > 0) continue;
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double um = um_per_unit(at);
      take(um * std::abs(fixed(k, i) - exact(k, i)), test.compiled.bounds[places[at]].total_um,
           um * std::abs(exact(k, i)));
    }
    ++seen.poses;
  }
}

/// Compares random poses, a batch at a time.
inline Agreement compare(const TestMachine& test, std::size_t batches, std::size_t batch, unsigned seed) {
  Agreement seen;
  std::mt19937_64 random(seed);
  for (std::size_t b = 0; b < batches; ++b) compare_poses(test, test.random_poses(batch, random), seen);
  return seen;
}

inline double largest_bound_um(const CompiledMachine& compiled) {
  double bound = 0;
  for (const OutputBound& b : compiled.bounds) bound = std::max(bound, b.total_um);
  return bound;
}

}  // namespace vernier
