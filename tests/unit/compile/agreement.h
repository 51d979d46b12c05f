#pragma once
#include <Eigen/Dense>

#include "tests/unit/compile/poses.h"

namespace vernier {

/// What a comparison of the executed fixed-point program with the double chain has seen.
struct Agreement {
  double worst_um = 0;     // |fixed point - double chain|
  double worst_share = 0;  // of the proved bound
  double largest_um = 0;   // deviation itself, so that agreement on zero counts for nothing
  std::size_t poses = 0;   // compared
};

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

/// Compares consecutive ticks, from a fresh start (the lags run through them). Linear axes: the deviation
/// along each of them. Least squares: what is left of the deviation at the tool point, where the correction
/// does not fade.
inline void compare_poses(const TestMachine& test, const std::vector<CycleInput>& inputs, Agreement& seen) {
  std::vector<std::size_t> axes;
  for (const Output& out : test.compiled.program.outputs) axes.push_back(out.axis);
  const auto& least = test.compiled.least_squares;
  const States states = test.states_of(inputs);
  const Eigen::Matrix3Xd exact_mm = deviation(test.machine, states);
  const std::vector<Eigen::Matrix3Xd> moved = nominal_directions(test.machine, states, axes);
  Compensator compensator(test.loaded->view.program());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    compensator.step(inputs[i]);
    const auto at = static_cast<Eigen::Index>(i);
    const auto n = static_cast<Eigen::Index>(axes.size());
    Eigen::Matrix3Xd directions(3, n), scaled(3, n);
    Eigen::VectorXd fixed(n);
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      directions.col(column) = moved[k].col(at);
      fixed[column] = test.deviation_units(compensator, k);
      if (least) scaled.col(column) = directions.col(column) / least->lever[k];
    }
    const auto take = [&](double error_um, double bound_um, double size_um) {
      seen.worst_um = std::max(seen.worst_um, error_um);
      seen.worst_share = std::max(seen.worst_share, error_um / bound_um);
      seen.largest_um = std::max(seen.largest_um, size_um);
    };
    if (least) {
      const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(scaled, Eigen::ComputeThinU);
      const auto rank = static_cast<Eigen::Index>(least->jacobian.size());
      if (svd.singularValues().head(rank).array().square().prod() < least->floor * 1.001) continue;
      const Eigen::Matrix3Xd basis = svd.matrixU().leftCols(rank);
      const Eigen::VectorXd left = basis.transpose() * (directions * fixed - exact_mm.col(at));
      take(1000 * left.norm(), test.compiled.bounds[0].total_um, 1000 * exact_mm.col(at).norm());
    } else {
      const Eigen::VectorXd exact = directions.completeOrthogonalDecomposition().solve(exact_mm.col(at));
      for (std::size_t k = 0; k < axes.size(); ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        // Of a rotary axis: as motion of the tool point.
        const double um = 1000 * (test.machine.axes[axes[k]].rotary ? directions.col(column).norm() : 1);
        take(um * std::abs(fixed[column] - exact[column]), test.compiled.bounds[k].total_um,
             um * std::abs(exact[column]));
      }
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
