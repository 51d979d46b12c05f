// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Over what length of an axis its errors may change: what a look at them must not step over.
struct Detail {
  double period = 0;   // shortest period of a sine, cosine or tangent over the axis; infinite: there is none
  double station = 0;  // shortest distance of two stations of its table; infinite: it has no table
};

/// Of the chain as it is (statics at their values). at: where the other axes and inputs are (its first
/// state). Result in mm or deg of the axis. tool.
Detail detail_along(const Machine& machine, std::size_t axis, const States& at);

}  // namespace vernier::model
