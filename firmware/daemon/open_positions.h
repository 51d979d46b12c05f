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

/// Opens the counter of an axis of kind "counter". clock: outlives the result. Null with `error` set if it is
/// missing, or too narrow for the speed of the axis; a wrong setting throws BoardError. Not real-time safe.
std::unique_ptr<CounterAxis> open_counter_axis(const PositionAxis& axis, const AxisLimits& limits,
                                               TimeUs tick, Clock& clock, std::string& error);

/// Returns a text that is the same for all axes of kind "modbus" that are read in one request: peer, unit and
/// sequence register. Throws BoardError. Not real-time safe.
std::string modbus_axes_block(const SignalSource& source);

/// Opens the registers of the axes of one block. Axis k of the result is axes[k]. missing: of each axis, the
/// longest time without a reading that is no fault. Errors as for open_counter_axis(). Not real-time safe.
std::unique_ptr<ModbusAxes> open_modbus_axes(const std::vector<PositionAxis>& axes,
                                             const std::vector<TimeUs>& missing, std::string& error);

}  // namespace vernier
