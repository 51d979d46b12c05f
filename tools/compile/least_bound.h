// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "tools/compile/types.h"

namespace vernier::compile {

using Registers = std::set<std::uint32_t>;

/// Returns the gain from each register's error to the register `output`: reverse accumulation of the gains.
/// Registers that are given have no error, because later registers refer to their actual value.
std::vector<double> gains_to(const LoweredProgram& program, std::uint32_t output);

/// Error of a register against the exact function of the registers `given`. Their own errors do not count.
double error_from(const LoweredProgram& program, std::uint32_t target, const Registers& given);

/// Bound of the residual |J x - deviation| of the fixed-point least-squares solution, by matrix norms:
/// rounding in J' w, w, adj(J J'), det, J J' and J itself, each multiplied by the gain of the later steps.
/// Intervals would multiply the errors by the inverse's largest entries. The residual keeps the dependence
/// between the parts. The gains depend on the pose only through the determinant D of J J': with the trace t
/// of J J', |(J J')^-1| <= (t/2)^2 / D for three directions. The bound is therefore a function of an interval
/// of D, and the largest of several intervals is a bound for all poses.
class LeastSquaresBound {
 public:
  LeastSquaresBound(const Derivation& derivation, const LoweredProgram& program);

  /// Contributions at the poses whose determinant is in `determinant`. size_mm: |deviation| on the right
  /// side.
  std::vector<Contribution> terms(const Interval& determinant, double size_mm) const;
  /// Upper limit of |K' (K K')^-1|: motion of all axes, each multiplied by its lever, for a deviation of the
  /// length 1.
  double gain(const Interval& determinant) const;
  /// Intervals of the determinant, from the floor to its largest value, in a geometric series.
  std::vector<Interval> parts() const;

 private:
  std::pair<double, NodeId> bare(NodeId id) const;
  std::optional<std::uint32_t> place(NodeId id) const;
  void insert(Registers& set, NodeId id) const;
  Registers registers(const std::vector<std::vector<NodeId>>& matrix) const;
  double error_of(NodeId id, const Registers& given) const;
  double error_of(const std::vector<std::vector<NodeId>>& matrix, const Registers& given) const;
  void find_weights(const Registers& given);
  void find_deviation();

  const Graph& g_;
  const LeastSquares& least_;
  const std::vector<AxisDeviation>& outputs_;
  const LoweredProgram& p_;
  std::vector<Contribution> deviation_;  // errors of the deviation's own registers, mm in place of um
  double reciprocal_ = 0, determinant_ = 0, adjugate_ = 0, square_ = 0, jacobian_ = 0, solution_ = 0;
  double weights_ = 0;  // error of the weights beside that of the sums
  double sums_ = 0;     // error of adj(K K') times the deviation, which is multiplied by the reciprocal
};

}  // namespace vernier::compile
