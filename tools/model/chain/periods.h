// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Length along an axis over which the errors of the axis may change. An evaluation of the errors needs
/// positions at smaller distances.
struct Detail {
  double period = 0;   // shortest period of a sine, cosine or tangent over the axis; infinite: no such term
  double station = 0;  // shortest distance of two stations of its table; infinite: it has no table
  /// Ranges in which expressions of other kinds (steps, narrow peaks) change quickly. In these ranges the
  /// errors are straight to 0.02 um or 2e-5 deg only between positions that are `spacing` apart. Features
  /// narrower than 1/262144 of the range are not found.
  struct Sharp {
    double from = 0, to = 0, spacing = 0;
  };
  std::vector<Sharp> sharp;
};

/// Evaluates the chain with the statics at their values, for motion in the positive direction of the axis.
/// at: positions of the other axes and inputs (its first state). Result in mm or deg of the axis.
Detail detail_along(const Machine& machine, std::size_t axis, const States& at);

}  // namespace vernier::model
