// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "tools/compile/compile.h"
#include "tools/maths/alignment.h"
#include "tools/simulate/loop.h"
#include "tools/simulate/path.h"

namespace vernier::simulate {

/// A simulated run (FORMATS section 3). Errors are p_truth(q + correction) - p_nominal(q) without BaseShift,
/// after the best rigid alignment of the whole path; mm, 3 x ticks.
struct SimulateResult {
  model::States states;  // of the image's machine
  LoopResult loop;
  Eigen::Matrix3Xd error_before, error_after;
  double rms_before_um = 0, rms_after_um = 0;  // over ticks and x, y, z
  double max_before_um = 0, max_after_um = 0;  // largest norm
  /// Angle between the true and the nominal direction of the tool, deg per tick. The angle is not aligned,
  /// because the points of a short path hardly determine the rotation of a rigid motion.
  model::Column tilt_before, tilt_after;
  /// Ticks in poses where the image's correction of direction is damped (compile.h).
  std::size_t damped = 0;
};

/// Runs the firmware with `image` on the true machine along a path. Axes and inputs of the two
/// machines are matched by name. Throws InputError if the image corrects an axis that the true
/// machine does not have, or if the path lacks an axis. Throws LimitNotMet if the firmware never
/// becomes Active.
SimulateResult simulate(const model::Machine& truth, const compile::LoadedImage& image, const Path& path,
                        const LoopOptions& options);

/// Returns the result with the keys of FORMATS and additional keys.
nlohmann::ordered_json simulate_json(const SimulateResult& result, const model::Machine& machine,
                                     const LoopOptions& options);
/// Returns every tick as CSV of the project's dialect: t, axes, corrections and errors.
std::string ticks_csv(const SimulateResult& result, const model::Machine& machine);

}  // namespace vernier::simulate
