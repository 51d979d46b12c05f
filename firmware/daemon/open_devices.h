// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "firmware/daemon/device_axes.h"
#include "firmware/daemon/settings/board_file.h"
#include "hal/command_link.h"
#include "hal/digital_line.h"
#include "hal/probe_line.h"
#include "hal/tick_sync.h"

namespace vernier {

class IioBuffer;
class ModbusLine;
class OutputDevice;
class SampledInput;

/// Lines that several sensors share, by device or address.
using ModbusLines = std::map<std::string, std::shared_ptr<ModbusLine>>;

// Each function opens one device of the board file. Null with `error` set if it is missing; a wrong kind or
// setting throws BoardError. setup.

/// Reads the settings of a line for one use: `device`, `baud` and `parity`, or `address` and `port`. wait:
/// longest time for an answer.
ModbusLineOpener modbus_line_of(const SignalSource& source, TimeUs wait);
/// Returns a text that is the same for all outputs of one device; empty: each output is a separate device.
std::string device_of_output(const SignalSource& source);
/// Reads the settings of the device of these axes, which is their number k for axes[k]: an output, or several
/// outputs that share a device. Opening an output can write to the machine: open it last.
OutputOpener output_of(const std::vector<OutputAxis>& axes);
/// Opens a sensor. lines: the open Modbus lines; a line that the sensor needs is added.
std::unique_ptr<SampledInput> open_sensor(const SignalSource& source, ModbusLines& lines, std::string& error);
/// Opens the buffer of the device that inputs of kind "iio-buffer" name, one channel per input. The trigger
/// and the rate of the first input apply.
std::unique_ptr<IioBuffer> open_iio_buffer(const std::vector<const SignalSource*>& channels,
                                           std::string& error);
/// A way in from outside.
std::unique_ptr<CommandLink> open_link(const SignalSource& source, std::string& error);
/// The sync of kind "can".
std::unique_ptr<TickSync> open_sync(const SignalSource& source, std::string& error);
/// Opens a line of kind "gpio": the line of a probe, a digital input or a digital output.
std::unique_ptr<ProbeLine> open_probe(const SignalSource& source, std::string& error);
std::unique_ptr<DigitalInput> open_digital_input(const SignalSource& source, std::string& error);
std::unique_ptr<DigitalOutput> open_digital_output(const SignalSource& source, std::string& error);

}  // namespace vernier
