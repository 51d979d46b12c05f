// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/kinematics/inverse.h"

namespace vernier::kinematics {

struct CorrectionOptions {
  /// false: linear axes correct the tool point. true: all axes correct point and tool direction.
  bool with_rotary = false;
  double tolerance_mm = 1e-9, tolerance_deg = 1e-9;
};

/// Addition to each axis command, and the verification of the additions.
struct CorrectionResult {
  std::vector<model::Column> offset;      // per axis of the machine, mm or deg; 0 for axes that do not move
  Eigen::Matrix3Xd before, after;         // actual - nominal tool point, mm
  model::Column tilt_before, tilt_after;  // angle between actual and nominal tool direction, deg
  std::vector<Inverse> each;              // of each state; residuals are those of `after`
};

/// Returns the angle between the tool directions (the z axes of the last frame) of two lists of
/// poses, deg.
model::Column tilt_between(const model::Poses& actual, const model::Poses& nominal);

/// Computes the axis offsets that bring the actual tool point (and direction) of `machine` to the position of
/// its nominal chain at the same commands. correct() uses the forward kinematics of the whole chain: an axis
/// on the workpiece side gets its sign automatically. Motion and inputs do not change. A component that the
/// axes cannot reach (the height of an XY table) remains in `after`. If the iteration does not reach the
/// target, the result is not converged.
CorrectionResult correct(const model::Machine& machine, const model::States& states,
                         const CorrectionOptions& options = {});

/// Returns the offsets of the linear axes for a table of deviations that were measured at the commanded
/// positions. The nominal chain's Jacobian converts the deviations. The offsets differ from those of
/// correct() by the slope of the deviation times the offset (second order). The result has one column per
/// axis of the machine, mm; 0 for rotary axes.
std::vector<model::Column> first_order_offset(const model::Machine& machine, const model::States& states);

}  // namespace vernier::kinematics
