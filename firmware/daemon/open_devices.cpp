// SPDX-License-Identifier: Apache-2.0
// Part of the composition root: opens the backends that a board file names.
#include "firmware/daemon/open_devices.h"

#include <cstdio>
#include <filesystem>

#include "firmware/daemon/settings/device_settings.h"
#include "hal/linux/analogue_output.h"
#include "hal/linux/can/can_sync.h"
#include "hal/linux/can/isotp_link.h"
#include "hal/linux/gpio_lines.h"
#include "hal/linux/iio/iio_buffer.h"
#include "hal/linux/iio/iio_device.h"
#include "hal/linux/iio/iio_input.h"
#include "hal/linux/modbus/modbus_input.h"
#include "hal/linux/modbus/modbus_server.h"
#include "tables/link_format.h"

namespace vernier {
namespace {

constexpr std::int64_t kStaleTicks = 1000;  // ticks after which an unchanged sample is silence
constexpr std::int64_t kMostLines = 4096;   // of a GPIO chip

GpioAddress gpio_address(const SignalSource& source) {
  if (source.kind != "gpio") source.fail("no line of kind " + source.kind);
  return {source.text("chip"), static_cast<unsigned>(source.whole("line", 0, kMostLines - 1)),
          is_inverted(source)};
}

std::uint32_t stale_ticks(const SignalSource& source) {
  return static_cast<std::uint32_t>(source.whole("stale_ticks", kStaleTicks, 1, 1'000'000));
}

char parity(const SignalSource& source) {
  const std::string word = source.text("parity", "E");
  if (word != "E" && word != "O" && word != "N") source.fail("parity must be E, O or N");
  return word[0];
}

int baud(const SignalSource& source, std::int64_t otherwise) {
  return static_cast<int>(source.whole("baud", otherwise, 1, 10'000'000));
}

ModbusValue modbus_value(const SignalSource& source) {
  using Type = ModbusValue::Type;
  static const std::map<std::string, Type> kTypes = {{"int16", Type::kInt16},
                                                     {"uint16", Type::kUint16},
                                                     {"int32", Type::kInt32},
                                                     {"float32", Type::kFloat32}};
  ModbusValue value;
  value.unit = static_cast<int>(source.whole("unit", 1, 1, 247));
  value.address = static_cast<int>(source.whole("register", 0, 65534));
  const std::string kind = source.text("registers", "input"), type = source.text("type", "int16");
  if (kind != "input" && kind != "holding") source.fail("registers must be input or holding");
  if (kind == "holding") value.kind = ModbusLine::Registers::kHolding;
  if (!kTypes.contains(type)) source.fail("type must be int16, uint16, int32 or float32");
  value.type = kTypes.at(type);
  value.offset = source.number("offset", 0);
  value.scale = source.number("scale");
  return value;
}

/// The line of a sensor; several sensors of one device share it with the settings of the first.
std::shared_ptr<ModbusLine> modbus_line(const SignalSource& source, ModbusLines& lines, std::string& error) {
  const TimeUs wait(1000 * source.whole("timeout_ms", 200, 1, 10'000));
  const bool rtu = source.kind == "modbus-rtu";
  const auto port = rtu ? 0 : static_cast<int>(source.whole("port", 502, 1, 65535));
  const std::string place = rtu ? source.text("device") : source.text("address") + ":" + std::to_string(port);
  auto& line = lines[place];
  if (line == nullptr)
    line = rtu ? ModbusLine::rtu(place, baud(source, 9600), parity(source), wait, error)
               : ModbusLine::tcp(source.text("address"), port, wait, error);
  else if (rtu)
    static_cast<void>(baud(source, 9600)), static_cast<void>(parity(source));
  if (line == nullptr && error.empty()) error = place + " is missing";
  return line;
}

}  // namespace

std::unique_ptr<AnalogueOutput> open_analogue(const SignalSource& source, bool rotary, std::string& error) {
  if (source.kind == "pwm") {
    source.only(
        {"path", "period_ns", "span", "zero_ns", "low_ns", "high_ns", "polarity", "calibration", "delay_ms"});
    const std::int64_t period = source.whole("period_ns", 2, 1'000'000'000);
    return AnalogueOutput::pwm(source.text("path"), period, analogue_scale(source, rotary, period, "_ns"),
                               error);
  }
  if (source.kind != "iio-dac") source.fail("no output of kind " + source.kind);
  source.only({"root", "device", "channel", "codes", "span", "zero", "low", "high", "polarity", "calibration",
               "delay_ms"});
  const AnalogueScale scale = analogue_scale(source, rotary, source.whole("codes", 1, (1 << 24) - 1), "");
  const auto channel = static_cast<unsigned>(source.whole("channel", 0, 0, 63));
  const std::string device = find_iio_device(source.text("root", kIioRoot), source.text("device"), error);
  return device.empty() ? nullptr : AnalogueOutput::iio_dac(device, channel, scale, error);
}

std::unique_ptr<SampledInput> open_sensor(const SignalSource& source, ModbusLines& lines,
                                          std::string& error) {
  if (source.kind == "modbus-rtu" || source.kind == "modbus-tcp") {
    source.only({"device", "baud", "parity", "address", "port", "timeout_ms", "unit", "register", "registers",
                 "type", "scale", "offset", "stale_ticks"});
    const ModbusValue value = modbus_value(source);
    const auto line = modbus_line(source, lines, error);
    return line ? std::make_unique<ModbusInput>(line, value, stale_ticks(source)) : nullptr;
  }
  if (source.kind != "iio") source.fail("no input of kind " + source.kind);
  source.only({"root", "device", "attribute", "scale", "offset", "stale_ticks"});
  const IioScale scale{source.number("offset", 0), source.number("scale")};
  const std::string attribute = source.text("attribute");
  if (attribute.empty()) source.fail("attribute is empty");
  const std::string device = find_iio_device(source.text("root", kIioRoot), source.text("device"), error);
  return device.empty() ? nullptr
                        : IioInput::open(device + "/" + attribute, scale, stale_ticks(source), error);
}

std::unique_ptr<IioBuffer> open_iio_buffer(const std::vector<const SignalSource*>& channels,
                                           std::string& error) {
  const SignalSource& first = *channels.front();
  IioBufferSettings settings;
  for (const SignalSource* const source : channels) {
    source->only({"root", "devices", "device", "channel", "scale", "offset", "trigger", "rate_Hz"});
    const std::string& channel = source->text("channel");
    if (channel.empty() || channel.find('/') != std::string::npos)
      source->fail("channel must be a name in scan_elements, for example accel_x");
    settings.channels.push_back({channel, {source->number("offset", 0), source->number("scale")}});
  }
  settings.trigger = first.text("trigger", "");
  if (first.numbers.contains("rate_Hz"))
    settings.frequency = std::to_string(first.whole("rate_Hz", 1, 100'000));
  settings.directory = find_iio_device(first.text("root", kIioRoot), first.text("device"), error);
  if (settings.directory.empty()) return nullptr;
  settings.device =
      first.text("devices", "/dev") + "/" + std::filesystem::path(settings.directory).filename().string();
  return IioBuffer::open(settings, error);
}

std::unique_ptr<CommandLink> open_link(const SignalSource& source, std::string& error) {
  const ModbusLayout layout{kMailboxRegister, kMailboxRegisters, kLiveRegisters};
  if (source.kind == "modbus-tcp") {
    source.only({"address", "port"});
    const std::string address = source.text("address", "127.0.0.1");
    auto server =
        ModbusServer::tcp(address, static_cast<int>(source.whole("port", 1502, 0, 65535)), layout, error);
    if (server) std::fprintf(stderr, "vernierd: Modbus TCP on %s:%d\n", address.c_str(), server->port());
    return server;
  }
  if (source.kind == "modbus-rtu") {
    source.only({"device", "baud", "parity", "unit"});
    return ModbusServer::rtu(source.text("device"), baud(source, 115200), parity(source),
                             static_cast<int>(source.whole("unit", 1, 1, 247)), layout, error);
  }
  if (source.kind != "isotp") source.fail("no link of kind " + source.kind);
  source.only({"interface", "receive", "transmit"});
  constexpr std::int64_t kLastId = (1 << 29) - 1;
  return IsotpLink::open(source.text("interface"),
                         static_cast<std::uint32_t>(source.whole("receive", 0, kLastId)),
                         static_cast<std::uint32_t>(source.whole("transmit", 0, kLastId)), error);
}

std::unique_ptr<TickSync> open_sync(const SignalSource& source, std::string& error) {
  if (source.kind != "can") source.fail("no sync of kind " + source.kind);
  source.only({"interface", "id", "timeout_ms"});
  return CanSync::open(source.text("interface"),
                       static_cast<std::uint32_t>(source.whole("id", 0x80, 0, (1 << 29) - 1)), error);
}

std::unique_ptr<ProbeLine> open_probe(const SignalSource& source, std::string& error) {
  source.only({"chip", "line", "polarity"});
  return GpioProbeLine::open(gpio_address(source), error);
}

std::unique_ptr<DigitalInput> open_digital_input(const SignalSource& source, std::string& error) {
  source.only({"chip", "line", "polarity"});
  return GpioInput::open(gpio_address(source), error);
}

std::unique_ptr<DigitalOutput> open_digital_output(const SignalSource& source, std::string& error) {
  source.only({"chip", "line", "polarity", "toggle_ms"});
  return GpioOutput::open(gpio_address(source), error);
}

}  // namespace vernier
