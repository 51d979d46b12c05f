// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/kinematics/inverse.h"

namespace vernier::kinematics {

struct CorrectionOptions {
  /// false: linear axes put the tool point right. true: all axes put point and tool direction right.
  bool with_rotary = false;
  double tolerance_mm = 1e-9, tolerance_deg = 1e-9;
};

/// What to add to each axis command, and the proof that it does what it should.
struct CorrectionResult {
  std::vector<model::Column> offset;      // per axis of the machine, mm or deg; 0 for axes that do not move
  Eigen::Matrix3Xd before, after;         // actual - nominal tool point, mm
  model::Column tilt_before, tilt_after;  // angle between actual and nominal tool direction, deg
  std::vector<Inverse> each;              // of each state; residuals are those of `after`
};

/// Angle between the tool directions (the z axes of the last frame) of two lists of poses, deg. tool.
model::Column tilt_between(const model::Poses& actual, const model::Poses& nominal);

/// The axis offsets that put the actual tool point (and direction) of `machine` where its nominal chain has
/// it at the same commands. They are found on the forward solution of the whole chain, so that an axis on the
/// workpiece side gets its sign by itself. Motion and inputs stay as they are. What the axes cannot reach
/// (the height of an XY table) stays in `after`; an iteration that does not get there is not converged. tool.
CorrectionResult correct(const model::Machine& machine, const model::States& states,
                         const CorrectionOptions& options = {});

/// The offsets of the linear axes that a table of deviations measured at the commanded positions stands for:
/// the nominal chain's Jacobian takes the deviation back. They differ from those of correct() by the slope of
/// the deviation times the offset (second order). Per axis of the machine, mm; 0 for rotary axes. tool.
std::vector<model::Column> first_order_offset(const model::Machine& machine, const model::States& states);

}  // namespace vernier::kinematics
