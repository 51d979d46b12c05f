// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/compile/lower.h"

namespace vernier::compile {

/// One cause of error in an output and the most it can be.
struct Contribution {
  std::string name;
  std::string source;  // "linearisation", "table", "function", "rounding", "input", "lag"
  double bound_um = 0;
};

/// Proved bound of |fixed-point correction - exact back solution| along one axis, over the declared ranges,
/// away from the steps of comparisons; before magnitude limit, ramp and slew limit. The exact back solution
/// is c with p_actual(q + c) = p_nominal(q). Of a rotary axis: as motion of the tool point at the axis'
/// longest lever; where least squares are solved, of all axes together. An axis that corrects the tool's
/// direction has `deviation_deg` alone: where it stands the linear axes put the point right, and TiltBound
/// says what is left of the tilt.
struct OutputBound {
  std::string axis;
  double total_um = 0;
  double linearisation_um = 0, table_um = 0, function_um = 0, rounding_um = 0, input_um = 0, lag_um = 0;
  /// What the correction itself leaves, because the deviation at the corrected position is another and the
  /// nominal motion is no straight line: of one step of Newton's iteration, or of two. A part of the total
  /// where it is there; none: no useful bound (least squares near flat poses).
  std::optional<double> second_order_um;
  double deviation_um = 0;                  // largest |deviation| over the declared ranges, by intervals
  std::optional<double> deviation_deg;      // of an axis that corrects the tool's direction: at most
  std::vector<Contribution> contributions;  // largest first, all of them
};

/// What is left of the tilt of the tool in poses where its correction is neither damped nor at a limit.
struct TiltBound {
  double deviation_deg = 0;     // tilt without correction, at most
  double fixed_point_deg = 0;   // by the program and what it neglects
  double second_order_deg = 0;  // as OutputBound::second_order_um
  double left_deg() const { return fixed_point_deg + second_order_deg; }
};

/// The bounds of all outputs. tool.
std::vector<OutputBound> bounds_of(const model::Machine& machine, const Derivation& derivation,
                                   const LoweredProgram& program);
/// The same of the tool's direction; nothing where it is not corrected. tool.
std::optional<TiltBound> tilt_bound_of(const Derivation& derivation, const LoweredProgram& program);

}  // namespace vernier::compile
