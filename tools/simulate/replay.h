// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/compile/compile.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/model/measurement.h"
#include "tools/simulate/loop.h"

namespace vernier::simulate {

/// Readings of a measurement as they would be with the correction of the firmware.
struct ReplayResult {
  /// Reading minus the prediction of the nominal machine (with the BaseShift of the image's machine), one
  /// value per observation; mm or deg.
  Eigen::VectorXd before;
  /// Residual with the correction. The machine is moved by the correction that the firmware applied at the
  /// time of the reading.
  Eigen::VectorXd after;
  std::uint64_t ticks = 0, saturated = 0, slewing = 0, not_active = 0;
};

/// Runs the firmware along every run of a measurement, tick by tick between the rows (positions, motion and
/// inputs are linear between rows; a direction keeps its value). The function replay() changes each reading
/// by the effect of the correction on the nominal machine: reading' = reading + nominal(q + correction) -
/// nominal(q). The times in column t must increase within each run. In a file without a column t, also beside
/// files with one, every row is a pose at rest, and no term of the image may depend on time: otherwise
/// replay() throws InputError.
ReplayResult replay(const compile::LoadedImage& image, const model::Measurement& measurement,
                    const LoopOptions& options);

}  // namespace vernier::simulate
