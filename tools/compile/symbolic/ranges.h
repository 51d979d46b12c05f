// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "comp/compensator.h"
#include "tools/compile/symbolic/interval.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Returns the range of a channel in the unit of the machine file: declared, or the default of
/// docs for its kind and unit.
Interval axis_range(const model::Machine& machine, std::size_t axis);
/// Without a declared range, the default extends over the last fit's rows and a tenth beyond.
Interval input_range(const model::Machine& machine, std::size_t input);
Interval channel_range(const model::Machine& machine, ChannelKind kind, std::size_t index);

}  // namespace vernier::compile
