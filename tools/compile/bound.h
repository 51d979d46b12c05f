#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/compile/lower.h"

namespace vernier {

/// One cause of error in an output and the most it can be.
struct Contribution {
  std::string name;
  std::string source;  // "linearisation", "table", "function", "rounding", "input", "lag"
  double bound_um = 0;
};

/// Proved bound of |fixed-point correction - exact correction| along one axis, over the declared ranges, away
/// from the steps of comparisons; before magnitude limit, ramp and slew limit. Of a rotary axis: as motion of
/// the tool point at the axis' longest lever; where least squares are solved, of all axes together.
struct OutputBound {
  std::string axis;
  double total_um = 0;
  double linearisation_um = 0, table_um = 0, function_um = 0, rounding_um = 0, input_um = 0, lag_um = 0;
  /// What the correction itself adds, because the deviation at the corrected position is another and the
  /// nominal motion is no straight line. No part of the total: it is of the linearised correction, not of the
  /// fixed-point program.
  std::optional<double> second_order_um;    // none: no useful bound (least squares near flat poses)
  double deviation_um = 0;                  // largest |deviation| over the declared ranges, by intervals
  std::vector<Contribution> contributions;  // largest first, all of them
};

/// The bounds of all outputs. tool.
std::vector<OutputBound> bounds_of(const Machine& machine, const Derivation& derivation,
                                   const LoweredProgram& program);

}  // namespace vernier
