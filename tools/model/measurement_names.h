// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "tools/model/machine.h"

namespace vernier::model {

/// True if an axis must not have this name, because a column of the measurement format has the name.
/// `machine`: its axes have columns "correctionX" and so on.
bool is_no_axis_name(const Machine& machine, std::string_view name);
/// True if an input must not have this name, because a column of the measurement format has the name. An
/// input may have the name of a column of a later version of the format.
bool is_no_input_name(const Machine& machine, std::string_view name);
/// Returns the option that adds the constant position of an axis: --set "Y[mm]=POSITION".
std::string set_of_axis(const Axis& axis);
/// The message about a name that a measured column has.
inline constexpr const char* kMeasuredName = "measurement files use this name for a measured column";

}  // namespace vernier::model
