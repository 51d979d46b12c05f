// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "tools/compile/compile.h"
#include "tools/maths/alignment.h"
#include "tools/simulate/loop.h"
#include "tools/simulate/path.h"

namespace vernier::simulate {

/// Result of a simulated run of the firmware (FORMATS section 3). The errors are p_truth(q + correction) -
/// p_nominal(q) without BaseShift, after the best rigid alignment of the whole path; mm, 3 x ticks.
struct SimulateResult {
  model::States states;  // states of the image's machine
  LoopResult loop;
  Eigen::Matrix3Xd error_before, error_after;
  double rms_before_um = 0, rms_after_um = 0;  // rms over all ticks and x, y, z
  double max_before_um = 0, max_after_um = 0;  // largest norm of the error
  /// Angle between the true and the nominal direction of the tool for each tick, deg. The directions are not
  /// aligned, because the points of a short path hardly determine the rotation of a rigid motion.
  model::Column tilt_before, tilt_after;
  /// Number of ticks in poses at which the image damps its correction of the tool direction (compile.h).
  std::size_t damped = 0;
};

/// Runs the firmware with `image` on the true machine along a path, in simulated time. Axes and inputs of the
/// two machines are matched by their names. Throws InputError if the image corrects an axis that the true
/// machine does not have, or if the path does not contain an axis. Throws LimitNotMet if the firmware does
/// not reach the mode Active.
SimulateResult simulate(const model::Machine& truth, const compile::LoadedImage& image, const Path& path,
                        const LoopOptions& options);

/// Returns the result of a simulation as JSON, with the keys of FORMATS and additional keys.
nlohmann::ordered_json simulate_json(const SimulateResult& result, const model::Machine& machine,
                                     const LoopOptions& options);
/// Returns every tick of a simulation as CSV in the form of this project: t, axes, corrections and errors.
std::string ticks_csv(const SimulateResult& result, const model::Machine& machine);

}  // namespace vernier::simulate
