// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "comp/compensator.h"
#include "tools/compile/symbolic/interval.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Returns the range of an axis in the unit of the machine file: the declared range, or the documented
/// default for the kind and unit of the axis.
Interval axis_range(const model::Machine& machine, std::size_t axis);
/// Returns the range of an input: the declared range, if there is one. If no range is declared, the result is
/// the range of the rows of the last fit, extended by a tenth.
Interval input_range(const model::Machine& machine, std::size_t input);
Interval channel_range(const model::Machine& machine, ChannelKind kind, std::size_t index);

/// Returns a range of a column of a table at the positions of an interval: that of the stations of all
/// segments in it. `whole`: range of the column, the result for a cubic or periodic table.
Interval table_range(const model::Table& table, std::size_t column, const Interval& positions,
                     const Interval& whole);

}  // namespace vernier::compile
