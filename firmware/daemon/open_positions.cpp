// SPDX-License-Identifier: Apache-2.0
// Part of the composition root: opens the counters and registers that give positions.
#include "firmware/daemon/open_positions.h"

#include <cstdlib>

#include "firmware/daemon/modbus_registers.h"
#include "firmware/daemon/open_devices.h"
#include "firmware/daemon/settings/device_settings.h"
#include "hal/linux/counter_axis.h"
#include "hal/linux/iio/iio_device.h"
#include "hal/linux/modbus/modbus_axes.h"

namespace vernier {
namespace {

constexpr std::int64_t kLastRegister = 65535, kLastCount = 63, kMostBits = 40;
constexpr std::int64_t kPeriodsWithout =
    2;  // at least, that are no fault: a request can just miss a new number

}  // namespace

std::unique_ptr<CounterAxis> open_counter_axis(const PositionAxis& axis, const AxisLimits& limits,
                                               TimeUs tick, Clock& clock, std::string& error) {
  const SignalSource& source = *axis.source;
  source.only({"root", "device", "count", "bits", "scale", "offset"});
  const PositionScale scale = position_scale(source, axis.rotary);
  const std::int64_t number = source.whole("count", 0, 0, kLastCount);
  const auto bits = static_cast<int>(source.whole("bits", 0, 0, kMostBits));
  if (bits == 1) source.fail_at("bits", "bits must be 2 to 40, or 0: the driver states the range");
  // A counter has its name where a device of IIO has it.
  const std::string device = find_iio_device(source.text("root", kCounterRoot), source.text("device"), error);
  if (device.empty()) return nullptr;
  return CounterAxis::open(device + "/count" + std::to_string(number), bits, scale,
                           {limits.step, tick, limits.missing_ticks}, clock, error);
}

std::string modbus_axes_block(const SignalSource& source) {
  return modbus_peer(source) + " unit " + std::to_string(source.whole("unit", 1, 1, 247)) + " sequence " +
         std::to_string(source.whole("sequence", 0, kLastRegister)) + " " +
         source.text("registers", "holding");
}

std::unique_ptr<ModbusAxes> open_modbus_axes(const std::vector<PositionAxis>& axes,
                                             const std::vector<TimeUs>& missing, std::string& error) {
  const SignalSource& first = *axes.front().source;
  ModbusAxesSettings settings;
  const std::string kind = first.text("registers", "holding");
  if (kind != "input" && kind != "holding") first.fail_at("registers", "registers must be input or holding");
  if (kind == "input") settings.kind = ModbusLine::Registers::kInput;
  settings.unit = static_cast<int>(first.whole("unit", 1, 1, 247));
  settings.sequence = static_cast<int>(first.whole("sequence", 0, kLastRegister));
  settings.period = TimeUs(1000 * first.whole("period_ms", 5, 1, 50));
  if (axes.size() > ModbusAxesSettings::kMostAxes)
    first.fail("too many axes with the same setting sequence: at most " +
               std::to_string(ModbusAxesSettings::kMostAxes) +
               " axes may share the register of a sequence number");
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const SignalSource& source = *axes[k].source;
    source.only({"address", "port", "device", "baud", "parity", "unit", "register", "sequence", "registers",
                 "scale", "offset", "period_ms", "timeout_ms"});
    const auto address = static_cast<int>(source.whole("register", 0, kLastRegister - 1));
    for (const ModbusAxesSettings::Axis& other : settings.axes)
      if (std::abs(other.address - address) < 2)
        source.fail_at("register", "register: another axis has this register");
    if (settings.sequence == address || settings.sequence == address + 1)
      source.fail_at("sequence", "sequence is a register of the position");
    if (missing[k].count < kPeriodsWithout * settings.period.count)
      source.fail("missing_ticks must be at least " + std::to_string(kPeriodsWithout) +
                  " periods (period_ms), because positions arrive only once in each period: here " +
                  std::to_string(kPeriodsWithout * settings.period.count / 1000) + " ms, in ticks");
    settings.axes.push_back({address, position_scale(source, axes[k].rotary)});
  }
  if (settings.count() > ModbusAxesSettings::kMostRegisters)
    first.fail_at("sequence", "sequence is too far from the positions: one request reads at most " +
                                  std::to_string(ModbusAxesSettings::kMostRegisters) + " registers");
  const TimeUs wait(1000 * first.whole("timeout_ms", 100, 2, 10'000));
  const auto line = modbus_line_of(first, wait)(error);
  return line ? std::make_unique<ModbusAxes>(line, settings) : nullptr;
}

}  // namespace vernier
