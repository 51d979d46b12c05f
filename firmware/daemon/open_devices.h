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

/// Open Modbus lines, by device or address. Several sensors can use one line.
using ModbusLines = std::map<std::string, std::shared_ptr<ModbusLine>>;

// Each function of this file opens one device of the board file. If the device is missing, the function
// returns null and sets `error`. If the kind of a device or a setting is wrong, the function throws
// BoardError. Not real-time safe.

/// Reads the settings of a Modbus line for one use: `device`, `baud` and `parity`, or `address` and `port`.
/// `wait`: longest time to wait for an answer.
ModbusLineOpener modbus_line_of(const SignalSource& source, TimeUs wait);
/// Returns a text that is equal for all outputs of one device; empty if each output is a separate device.
std::string device_of_output(const SignalSource& source);
/// Reads the settings of the output device of these axes: one output, or several outputs of one device.
/// Output k of the device belongs to axes[k]. Opening an output can write to the machine. Outputs are opened
/// last, because opening an output can write to the machine.
OutputOpener output_of(const std::vector<OutputAxis>& axes);
/// Opens a sensor of the board file. `lines`: the open Modbus lines; a line that the sensor needs is added.
std::unique_ptr<SampledInput> open_sensor(const SignalSource& source, ModbusLines& lines, std::string& error);
/// Opens the IIO buffer for inputs of kind "iio-buffer", with one channel per input. The trigger and the rate
/// of the first input are used.
std::unique_ptr<IioBuffer> open_iio_buffer(const std::vector<const SignalSource*>& channels,
                                           std::string& error);
/// Opens a link over which requests come to the board.
std::unique_ptr<CommandLink> open_link(const SignalSource& source, std::string& error);
/// Opens the sync signal of kind "can".
std::unique_ptr<TickSync> open_sync(const SignalSource& source, std::string& error);
/// Opens a line of kind "gpio": the line of a probe, a digital input or a digital output.
std::unique_ptr<ProbeLine> open_probe(const SignalSource& source, std::string& error);
std::unique_ptr<DigitalInput> open_digital_input(const SignalSource& source, std::string& error);
std::unique_ptr<DigitalOutput> open_digital_output(const SignalSource& source, std::string& error);

}  // namespace vernier
