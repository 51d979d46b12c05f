// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Over what length of an axis its errors may change: what a look at them must not step over.
struct Detail {
  double period = 0;   // shortest period of a sine, cosine or tangent over the axis; infinite: no such term
  double station = 0;  // shortest distance of two stations of its table; infinite: it has no table
  /// Stretches in which expressions of other kinds (steps, narrow bumps) are straight to 0.02 um or 2e-5 deg
  /// only between positions that are `spacing` apart. What is narrower than 1/262144 of the range is not
  /// seen.
  struct Sharp {
    double from = 0, to = 0, spacing = 0;
  };
  std::vector<Sharp> sharp;
};

/// Of the chain as it is (statics at their values), for motion in the positive direction of the axis. at:
/// where the other axes and inputs are (its first state). Result in mm or deg of the axis. tool.
Detail detail_along(const Machine& machine, std::size_t axis, const States& at);

}  // namespace vernier::model
