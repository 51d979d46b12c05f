// SPDX-License-Identifier: Apache-2.0
// Part of the composition root: opens the backends that a board file names.
#include "firmware/daemon/open_devices.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "firmware/daemon/modbus_registers.h"
#include "firmware/daemon/open_drives.h"
#include "firmware/daemon/settings/device_settings.h"
#include "hal/linux/analogue_output.h"
#include "hal/linux/can/can_sync.h"
#include "hal/linux/can/isotp_link.h"
#include "hal/linux/gpio_lines.h"
#include "hal/linux/iio/iio_buffer.h"
#include "hal/linux/iio/iio_device.h"
#include "hal/linux/iio/iio_input.h"
#include "hal/linux/modbus/modbus_input.h"
#include "hal/linux/modbus/modbus_output.h"
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

constexpr std::int64_t kOutputBaud = 19'200;  // of positions and outputs, unless stated

int baud(const SignalSource& source, std::int64_t otherwise) {
  // Of serial devices in Linux. libmodbus takes 9600 in place of any other number, without a word.
  constexpr std::int64_t kRates[] = {1200,      2400,      4800,      9600,      19'200,    38'400,
                                     57'600,    115'200,   230'400,   460'800,   500'000,   576'000,
                                     921'600,   1'000'000, 1'152'000, 1'500'000, 2'000'000, 2'500'000,
                                     3'000'000, 3'500'000, 4'000'000};
  const std::int64_t rate = source.whole("baud", otherwise, 1, 10'000'000);
  if (std::find(std::begin(kRates), std::end(kRates), rate) == std::end(kRates))
    source.fail_at(
        "baud", "baud: " + std::to_string(rate) + " is not a baud rate of a serial line, for example 19200");
  return static_cast<int>(rate);
}

/// A setting of a serial line has no effect over TCP, and the other way round.
void refuse_settings_of_other_line(const SignalSource& source) {
  const bool serial = is_serial(source);
  for (const char* const name : {"baud", "parity"})
    if (!serial && (source.numbers.contains(name) || source.texts.contains(name)))
      source.fail_at(name, std::string(name) +
                               " is a setting of a serial line, but this connection has an address (TCP)");
  if (serial && source.numbers.contains("port"))
    source.fail_at("port", "port is a setting of an address, and this line is a serial device");
}

constexpr int kBitsOfByte = 11;     // start, eight, parity, stop
constexpr int kWriteBytes = 9 + 8;  // of a request to write and its answer, beside the data

/// Refuses a time in which no answer can be there.
void require_time_on_line(const SignalSource& source, int bytes, TimeUs wait, const char* share) {
  if (!is_serial(source)) return;
  const double needed_ms = 1e3 * kBitsOfByte * bytes / baud(source, kOutputBaud);
  if (needed_ms * 1000 < static_cast<double>(wait.count)) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "timeout_ms: a request and its answer need %.0f ms on this line, and must end within %s timeout_ms",
      std::ceil(needed_ms), share);
  source.fail_at("timeout_ms", text);
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
  const std::string place = rtu ? serial_line(source) : modbus_address(source) + ":" + std::to_string(port);
  auto& line = lines[place];
  if (line == nullptr)
    line = rtu ? ModbusLine::rtu(place, baud(source, 9600), parity(source), wait, error)
               : ModbusLine::tcp(modbus_address(source), port, wait, error);
  else if (rtu)
    static_cast<void>(baud(source, 9600)), static_cast<void>(parity(source));
  if (line == nullptr && error.empty()) error = place + " is missing";
  return line;
}

/// A kind of device for a port of hal/: its name in board files, its settings, and how it is opened. Another
/// backend is its source in hal/linux and a line in the table of its port below.
template <class Open>
struct DeviceKind {
  const char* name;
  std::vector<const char*> settings;
  Open open;
  /// The same text for all entries of one device; null: each entry is a separate device.
  std::string (*device)(const SignalSource& source) = nullptr;
};

/// The entry for a device of the board file. Throws BoardError for another kind or setting.
template <class Open>
const DeviceKind<Open>& kind_of(const std::vector<DeviceKind<Open>>& kinds, const char* port,
                                const SignalSource& source) {
  std::string known;
  for (const DeviceKind<Open>& kind : kinds) {
    known += std::string(known.empty() ? "" : ", ") + kind.name;
    if (kind.name != source.kind) continue;
    source.only(kind.settings);
    return kind;
  }
  source.fail("no " + std::string(port) + " of kind " + source.kind + "; drivers: " + known);
}

OutputOpener pwm_of(const std::vector<OutputAxis>& axes) {
  const auto& [source, rotary, most_per_tick, tick] = axes.front();
  const std::int64_t period = source->whole("period_ns", 2, 1'000'000'000);
  const AnalogueScale scale = analogue_scale(*source, rotary, period, "_ns");
  return [path = source->text("path"), period, scale](std::string& error) {
    return AnalogueOutput::pwm(path, period, scale, error);
  };
}

OutputOpener iio_dac_of(const std::vector<OutputAxis>& axes) {
  const auto& [source, rotary, most_per_tick, tick] = axes.front();
  const AnalogueScale scale = analogue_scale(*source, rotary, source->whole("codes", 1, (1 << 24) - 1), "");
  const auto channel = static_cast<unsigned>(source->whole("channel", 0, 0, 63));
  return [root = source->text("root", kIioRoot), name = source->text("device"), channel,
          scale](std::string& error) -> std::unique_ptr<OutputDevice> {
    const std::string device = find_iio_device(root, name, error);
    return device.empty() ? nullptr : AnalogueOutput::iio_dac(device, channel, scale, error);
  };
}

OutputOpener modbus_out_of(const std::vector<OutputAxis>& axes) {
  const SignalSource& first = *axes.front().source;
  ModbusOutputSettings settings;
  constexpr std::int64_t kLast = 65535;
  settings.unit = static_cast<int>(first.whole("unit", 1, 1, 247));
  settings.echo = static_cast<int>(first.whole("echo", 0, kLast));
  settings.period = TimeUs(1000 * first.whole("period_ms", 5, 1, ModbusOutputSettings::kLongestPeriod_ms));
  settings.timeout = TimeUs(1000 * first.whole("timeout_ms", 100, 2, 10'000));
  if (settings.timeout.count < 4 * settings.period.count)
    first.fail("timeout_ms must be at least four times period_ms");
  settings.tick = axes.front().tick;
  int places = 0;
  for (const OutputAxis& axis : axes) {
    const auto place = static_cast<int>(axis.source->whole("place", 0, 0, ModbusOutputSettings::kPlaces - 1));
    for (const auto& other : settings.axes)
      if (other.place == place)
        axis.source->fail("another axis uses the same `place` (position of a value in the register block)");
    settings.axes.push_back({number_scale(*axis.source, axis.rotary), place, axis.most_per_tick});
    places = std::max(places, place + 1);
  }
  settings.address =
      static_cast<int>(first.whole("register", 0, kLast + 1 - ModbusOutputSettings::kValues - 2 * places));
  if (settings.echo >= settings.address &&
      settings.echo < settings.address + ModbusOutputSettings::kValues + 2 * places)
    first.fail("echo is among the registers that the board writes");
  const TimeUs wait = ModbusOutput::wait_for_answer(settings.timeout, is_serial(first));
  require_time_on_line(first, kWriteBytes + 2 * (ModbusOutputSettings::kValues + 2 * places), wait,
                       "a quarter of");
  return [open_line = modbus_line_of(first, wait),
          settings](std::string& error) -> std::unique_ptr<OutputDevice> {
    const auto line = open_line(error);
    return line ? ModbusOutput::open(line, settings, error) : nullptr;
  };
}

using OutputOf = decltype(&pwm_of);
const std::vector<DeviceKind<OutputOf>> kOutputs = {
    {"pwm",
     {"path", "period_ns", "span", "zero_ns", "low_ns", "high_ns", "polarity", "calibration", "delay_ms"},
     pwm_of},
    {"iio-dac",
     {"root", "device", "channel", "codes", "span", "zero", "low", "high", "polarity", "calibration",
      "delay_ms"},
     iio_dac_of},
    {"modbus-out",
     {"address", "port", "device", "baud", "parity", "unit", "register", "echo", "place", "resolution",
      "range", "polarity", "period_ms", "timeout_ms", "delay_ms"},
     modbus_out_of,
     modbus_block},
    {"canopen", canopen_output_settings(), canopen_output_of},
};

std::unique_ptr<SampledInput> open_modbus(const SignalSource& source, ModbusLines& lines,
                                          std::string& error) {
  const ModbusValue value = modbus_value(source);
  const auto line = modbus_line(source, lines, error);
  return line ? std::make_unique<ModbusInput>(line, value, stale_ticks(source)) : nullptr;
}

std::unique_ptr<SampledInput> open_iio(const SignalSource& source, ModbusLines&, std::string& error) {
  const IioScale scale{source.number("offset", 0), source.number("scale")};
  const std::string attribute = source.text("attribute");
  if (attribute.empty()) source.fail("attribute is empty");
  const std::string device = find_iio_device(source.text("root", kIioRoot), source.text("device"), error);
  return device.empty() ? nullptr
                        : IioInput::open(device + "/" + attribute, scale, stale_ticks(source), error);
}

const std::vector<const char*> kModbusSettings = {"device",     "baud",   "parity",     "address",   "port",
                                                  "timeout_ms", "unit",   "register",   "registers", "type",
                                                  "scale",      "offset", "stale_ticks"};
using OpenInput = decltype(&open_modbus);
const std::vector<DeviceKind<OpenInput>> kInputs = {
    {"iio", {"root", "device", "attribute", "scale", "offset", "stale_ticks"}, open_iio},
    {"modbus-rtu", kModbusSettings, open_modbus},
    {"modbus-tcp", kModbusSettings, open_modbus},
};

constexpr ModbusLayout kMailbox{kMailboxRegister, kMailboxRegisters, kLiveRegisters};

std::unique_ptr<CommandLink> open_tcp_link(const SignalSource& source, std::string& error) {
  const std::string address = listening_address(source);
  auto server =
      ModbusServer::tcp(address, static_cast<int>(source.whole("port", 1502, 0, 65535)), kMailbox, error);
  if (server) std::fprintf(stderr, "vernierd: Modbus TCP on %s:%d\n", address.c_str(), server->port());
  return server;
}

std::unique_ptr<CommandLink> open_rtu_link(const SignalSource& source, std::string& error) {
  return ModbusServer::rtu(source.text("device"), baud(source, 115200), parity(source),
                           static_cast<int>(source.whole("unit", 1, 1, 247)), kMailbox, error);
}

std::unique_ptr<CommandLink> open_isotp_link(const SignalSource& source, std::string& error) {
  constexpr std::int64_t kLastId = (1 << 29) - 1;
  return IsotpLink::open(source.text("interface"),
                         static_cast<std::uint32_t>(source.whole("receive", 0, kLastId)),
                         static_cast<std::uint32_t>(source.whole("transmit", 0, kLastId)), error);
}

using OpenLinkKind = decltype(&open_tcp_link);
const std::vector<DeviceKind<OpenLinkKind>> kLinks = {
    {"modbus-tcp", {"address", "port"}, open_tcp_link},
    {"modbus-rtu", {"device", "baud", "parity", "unit"}, open_rtu_link},
    {"isotp", {"interface", "receive", "transmit"}, open_isotp_link},
};

}  // namespace

ModbusLineOpener modbus_line_of(const SignalSource& source, TimeUs wait) {
  refuse_settings_of_other_line(source);
  if (const std::string device = source.text("device", ""); !device.empty())
    return [device, rate = baud(source, kOutputBaud), bit = parity(source), wait](std::string& error) {
      return ModbusLine::rtu(device, rate, bit, wait, error);
    };
  return [address = modbus_address(source), port = static_cast<int>(source.whole("port", 502, 1, 65535)),
          wait](std::string& error) { return ModbusLine::tcp(address, port, wait, error); };
}

std::string device_of_output(const SignalSource& source) {
  const auto& kind = kind_of(kOutputs, "output", source);
  return kind.device == nullptr ? "" : kind.device(source);
}

OutputOpener output_of(const std::vector<OutputAxis>& axes) {
  OutputOf settings_of = nullptr;
  for (const OutputAxis& axis : axes) settings_of = kind_of(kOutputs, "output", *axis.source).open;
  return settings_of(axes);
}

std::unique_ptr<SampledInput> open_sensor(const SignalSource& source, ModbusLines& lines,
                                          std::string& error) {
  return kind_of(kInputs, "input", source).open(source, lines, error);
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
  return kind_of(kLinks, "link", source).open(source, error);
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
