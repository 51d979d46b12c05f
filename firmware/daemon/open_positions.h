// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "firmware/core/cycle/axis_monitor.h"
#include "firmware/daemon/device_axes.h"

namespace vernier {

class Clock;
class CounterAxis;
class ModbusAxes;

/// Opens the counter for the position of an axis of kind "counter". `clock`: must exist longer than the
/// result. Returns null, and the reason in `error`, if the counter is missing, or has too few bits for the
/// speed of the axis. Throws BoardError if a setting is wrong. Not real-time safe.
std::unique_ptr<CounterAxis> open_counter_axis(const PositionAxis& axis, const AxisLimits& limits,
                                               TimeUs tick, Clock& clock, std::string& error);

/// Returns a text that is equal for all axes of kind "modbus" that one request reads: peer, unit and sequence
/// register. Throws BoardError if the settings are not valid. Not real-time safe.
std::string modbus_axes_block(const SignalSource& source);

/// Opens the Modbus registers for the positions of the axes in one block. Axis k of the result belongs to
/// axes[k]. `missing`: for each axis, the longest permitted time without a reading. The errors are reported
/// as in open_counter_axis(). Not real-time safe.
std::unique_ptr<ModbusAxes> open_modbus_axes(const std::vector<PositionAxis>& axes,
                                             const std::vector<TimeUs>& missing, std::string& error);

}  // namespace vernier
