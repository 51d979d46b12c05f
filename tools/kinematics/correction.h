// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/kinematics/inverse.h"

namespace vernier::kinematics {

struct CorrectionOptions {
  /// false: the linear axes correct the tool point. true: all axes correct the tool point and the tool
  /// direction.
  bool with_rotary = false;
  double tolerance_mm = 1e-9, tolerance_deg = 1e-9;
};

/// Correction of the axis commands, with a verification of its result.
struct CorrectionResult {
  std::vector<model::Column> offset;      // one column per axis of the machine, mm or deg; 0 for axes that do
                                          // not move
  Eigen::Matrix3Xd before, after;         // actual minus nominal tool point without and with the correction,
                                          // mm
  model::Column tilt_before, tilt_after;  // angle between the actual and the nominal tool direction, without
                                          // and with the correction, deg
  std::vector<Inverse> each;              // verification of each state; its residuals are those of `after`
};

/// Returns the angle between the tool directions (z axes of the last frame) in two lists of poses, deg.
model::Column tilt_between(const model::Poses& actual, const model::Poses& nominal);

/// Computes axis offsets that bring the actual tool point (and tool direction) of `machine` to the nominal
/// position at the same commands. The function correct() uses the forward kinematics of the whole chain. The
/// correction of an axis on the workpiece side therefore automatically has the correct sign. The motion and
/// the inputs of the states do not change. A component of the deviation that the axes cannot reach (the
/// height of an XY table) remains in `after`. If the iteration does not reach the target, the result is
/// marked as not converged.
CorrectionResult correct(const model::Machine& machine, const model::States& states,
                         const CorrectionOptions& options = {});

/// Returns the offsets of the linear axes for a table of deviations, as if the deviations were measured at
/// the commanded positions. The Jacobian of the nominal chain converts the deviations to axis offsets. The
/// offsets of first_order_offset() differ from those of correct() by the slope of the deviation times the
/// offset (second order). The result of first_order_offset() has one column per axis of the machine, mm; 0
/// for rotary axes.
std::vector<model::Column> first_order_offset(const model::Machine& machine, const model::States& states);

}  // namespace vernier::kinematics
