// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/compile/compile.h"
#include "tools/fit/statistics.h"
#include "tools/model/measurement.h"
#include "tools/simulate/loop.h"

namespace vernier::simulate {

/// What a measurement would read if the firmware had run during it.
struct ReplayResult {
  /// Reading - what the nominal machine (with the image machine's BaseShift) should read, per observation; mm
  /// or deg.
  Eigen::VectorXd before;
  /// The same after the correction that the firmware applied at that moment moved the machine.
  Eigen::VectorXd after;
  std::uint64_t ticks = 0, saturated = 0, slewing = 0, not_active = 0;
};

/// Runs the firmware along every run of a measurement, tick by tick between its rows (positions, motion and
/// inputs linear between them, a sense held), and moves the readings by what the correction does to the
/// nominal machine: reading' = reading + nominal(q + correction) - nominal(q). Column t increases within each
/// run; without it every row is a pose at which the machine stands, if no term of the image depends on time.
/// Throws InputError otherwise. tool.
ReplayResult replay(const compile::LoadedImage& image, const model::Measurement& measurement,
                    const LoopOptions& options);

}  // namespace vernier::simulate
