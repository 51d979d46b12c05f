// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Shortest length along an axis over which the errors of this axis can change. An evaluation of the errors
/// needs positions at smaller distances than the shortest length over which errors change.
struct Detail {
  double period = 0;   // shortest period of a sine, cosine or tangent over the axis; infinite if there is no
                       // such term
  double station = 0;  // shortest distance between two stations of the axis' table; infinite if the axis has
                       // no table
  /// Ranges of the axis in which expressions of other kinds (steps, narrow peaks) change quickly.
  /// In a range of quick change, the errors are linear to 0.02 um or 2e-5 deg between positions at
  /// the distance `spacing`. Features narrower than 1/262144 of the range of the axis are not
  /// found.
  struct Sharp {
    double from = 0, to = 0, spacing = 0;
  };
  std::vector<Sharp> sharp;
};

/// Returns the Detail of an axis. The chain is evaluated for motion in the positive direction of the axis,
/// with the statics at their values. `at`: positions of the other axes and values of the inputs (only the
/// first state is used). The result of detail_along() is in the unit of the axis, mm or deg.
Detail detail_along(const Machine& machine, std::size_t axis, const States& at);

}  // namespace vernier::model
