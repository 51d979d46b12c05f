// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "comp/compensator.h"
#include "tools/compile/symbolic/interval.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Returns the range of an axis in the unit of the machine file: the declared range, or the documented
/// default for its kind and unit.
Interval axis_range(const model::Machine& machine, std::size_t axis);
/// Returns the range of an input. Without a declared range: the range of the last fit's rows, widened by a
/// tenth.
Interval input_range(const model::Machine& machine, std::size_t input);
Interval channel_range(const model::Machine& machine, ChannelKind kind, std::size_t index);

}  // namespace vernier::compile
