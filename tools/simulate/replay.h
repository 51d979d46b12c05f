// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/compile/compile.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/model/measurement.h"
#include "tools/simulate/loop.h"

namespace vernier::simulate {

/// Predicted readings of a measurement with the firmware active.
struct ReplayResult {
  /// Reading minus the prediction of the nominal machine (with the image machine's BaseShift), per
  /// observation; mm or deg.
  Eigen::VectorXd before;
  /// Residual after the correction: the machine is moved by the correction that the firmware applied at that
  /// moment.
  Eigen::VectorXd after;
  std::uint64_t ticks = 0, saturated = 0, slewing = 0, not_active = 0;
};

/// Runs the firmware along every run of a measurement, tick by tick between its rows (positions, motion and
/// inputs linear between rows, a direction keeps its value). replay() changes the readings by the effect of
/// the correction on the nominal machine: reading' = reading + nominal(q + correction) - nominal(q). Column t
/// must increase within each run. If the file has no column t, every row is a pose at rest; in this case no
/// term of the image may depend on time. Throws InputError if column t is missing and a term depends on time.
ReplayResult replay(const compile::LoadedImage& image, const model::Measurement& measurement,
                    const LoopOptions& options);

}  // namespace vernier::simulate
