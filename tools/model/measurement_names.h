// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "tools/model/machine.h"

namespace vernier::model {

/// True if `name` is not permitted as the name of an axis, because a column of the measurement format has
/// this name. `machine`: its axes determine the reserved column names "correctionX" and so on.
bool is_no_axis_name(const Machine& machine, std::string_view name);
/// True if `name` is not permitted as the name of an input, because a column of the measurement format has
/// this name. The names of columns of a later version of the format are permitted for inputs.
bool is_no_input_name(const Machine& machine, std::string_view name);
/// Returns the command-line option that adds a constant position of an axis: --set "Y[mm]=POSITION".
std::string set_of_axis(const Axis& axis);
/// Error message for a name of an axis or input that is also the name of a measured column.
inline constexpr const char* kMeasuredName = "measurement files use this name for a measured column";

}  // namespace vernier::model
