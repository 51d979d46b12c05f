// SPDX-License-Identifier: Apache-2.0
// Part of the composition root: puts the devices of a board file together.
#include "firmware/daemon/devices.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include "firmware/daemon/device_trials.h"
#include "firmware/daemon/modbus_registers.h"
#include "firmware/daemon/open_devices.h"
#include "firmware/daemon/open_drives.h"
#include "firmware/daemon/open_positions.h"
#include "firmware/daemon/routing.h"
#include "firmware/daemon/settings/feature_settings.h"
#include "hal/linux/can/can_axes.h"
#include "hal/linux/can/canopen_axes.h"
#include "hal/linux/counter_axis.h"
#include "hal/linux/file_lock.h"
#include "hal/linux/hardware_watchdog.h"
#include "hal/linux/iio/iio_buffer.h"
#include "hal/linux/modbus/modbus_axes.h"
#include "hal/linux/modbus/modbus_input.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/output_device.h"
#include "hal/linux/sampled_input.h"
#include "hal/linux/wake_up.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"

namespace vernier {
namespace {

constexpr double kShareOfRangePerS = 0.1;    // speed of a simulated axis
constexpr std::int64_t kTicksToZero = 1000;  // at least, for the correction that a drive holds at the start
constexpr std::uint32_t kMostHandles = 64;   // of all links together
constexpr double kMostDelayMs = 10'000;      // of an output, for its budget
constexpr int kWatchdogSeconds = 10;  // many drivers know whole seconds only; the unit's watchdog is quicker

/// An output of the board file with its settings read. open: empty for a simulated output.
struct NamedOutput {
  std::vector<std::uint32_t> axes;  // of the board, in the device's order
  OutputOpener open;
};

}  // namespace

/// A real output of an axis.
struct RealOutput {
  std::size_t axis;  // of the board
  OutputDevice* device;
  std::uint32_t number;  // of the axis in the device
};

struct Devices::Parts {
  const BoardFile& file;
  MonotonicClock clock;
  std::unique_ptr<Roaming> motion;
  std::unique_ptr<SimPlant> plant;
  std::map<std::string, std::unique_ptr<CanAxes>> buses;  // by interface
  std::map<std::string, std::unique_ptr<CanopenAxes>> drives;
  std::map<std::string, std::unique_ptr<ModbusAxes>> register_axes;  // by block
  std::vector<std::unique_ptr<CounterAxis>> counters;
  std::vector<std::unique_ptr<OutputDevice>> output_devices;
  std::vector<RealOutput> real_outputs;
  ModbusLines lines;
  std::vector<std::unique_ptr<SampledInput>> sensors;
  std::map<std::string, std::unique_ptr<IioBuffer>> buffers;  // by device
  std::unique_ptr<RoutedAxes> axes;
  std::unique_ptr<RoutedInputs> inputs;
  std::unique_ptr<FeatureInputs> features;  // in front of the inputs
  std::unique_ptr<RoutedOutputs> outputs;
  std::unique_ptr<ProbeLine> probe;
  std::unique_ptr<TickSync> sync;
  std::unique_ptr<DigitalInput> enable;
  std::unique_ptr<DigitalOutput> healthy;
  std::vector<OpenLink> links;
  std::unique_ptr<HardwareWatchdog> watchdog;
  FileLock store_lock;
  std::vector<std::filesystem::path> made;  // folders of the store that were not there
  std::vector<DeviceFinding> findings;

  explicit Parts(const BoardFile& board_file) : file(board_file) {}
  /// A board that did not run has put nothing into its store: no empty folder stays behind.
  ~Parts() {
    std::error_code failed;
    for (const std::filesystem::path& folder : made)
      if (std::filesystem::is_empty(folder, failed)) std::filesystem::remove(folder, failed);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  void note(const std::string& device, const std::string& missing,
            std::function<std::string()> attempt = {}) {
    findings.push_back({device, missing, std::move(attempt)});
  }
  void note_file(const std::string& name, const std::string& missing) {
    findings.push_back({name, missing, {}, true});
  }
  /// Moves the findings from `first` to the end to the place `to`.
  void list_at(std::size_t to, std::size_t first) {
    const auto at = [&](std::size_t i) { return findings.begin() + static_cast<std::ptrdiff_t>(i); };
    std::rotate(at(to), at(first), findings.end());
  }
  void make_plant(unsigned long seed);
  void make_bus(const std::string& interface, std::vector<Route<AxisReader>>& routes);
  void make_drives(const std::string& interface, std::vector<Route<AxisReader>>& routes);
  void make_register_axes(const std::string& block, std::vector<Route<AxisReader>>& routes);
  void make_counter(std::uint32_t axis, std::vector<Route<AxisReader>>& routes);
  std::vector<Route<AxisReader>> make_positions();
  std::vector<NamedOutput> read_outputs() const;
  NamedOutput read_output(std::uint32_t first) const;
  std::vector<Route<CorrectionWriter>> open_outputs(const std::vector<NamedOutput>& named);
  void open_output(const NamedOutput& output, std::vector<Route<CorrectionWriter>>& routes);
  std::vector<Route<InputReader>> make_inputs();
  void make_buffer(const std::string& device, std::vector<Route<InputReader>>& routes);
  void vibrate(std::uint32_t input, const SignalSource& source);
  void make_features();
  void make_sync();
  void make_lines();
  void make_links();
  void make_store();
  void look_at_files();
  void look_for_calibration(const AxisEntry& axis);
};

void Devices::Parts::make_plant(unsigned long seed) {
  std::vector<RoamingAxis> ranges;
  std::vector<InputMicro> references;
  for (const AxisEntry& axis : file.axes) {
    const double scale = axis.wiring.rotary ? static_cast<double>(kTurnCounts) / 360 : 1e6;
    ranges.push_back(
        {static_cast<std::int64_t>(axis.low * scale), static_cast<std::int64_t>(axis.high * scale)});
  }
  for (const InputEntry& input : file.inputs)
    references.emplace_back(static_cast<std::int64_t>(input.reference * 1e6));
  motion = std::make_unique<Roaming>(ranges, references, file.service.upload.tick, kShareOfRangePerS, seed);
  plant = std::make_unique<SimPlant>(*motion, static_cast<std::uint32_t>(file.axes.size()),
                                     static_cast<std::uint32_t>(file.inputs.size()),
                                     PlantOptions{.seed = seed, .faults = {}});
}

/// One bus for all axes that name its interface; routes of the axes are filled in.
void Devices::Parts::make_bus(const std::string& interface, std::vector<Route<AxisReader>>& routes) {
  std::vector<std::uint32_t> ids;
  std::vector<std::size_t> served;
  for (std::size_t i = 0; i < file.axes.size(); ++i) {
    const SignalSource& source = file.axes[i].position;
    if (source.kind != "can" || source.text("interface") != interface) continue;
    source.only({"interface", "id"});
    const auto id = static_cast<std::uint32_t>(source.whole("id", 0, (1 << 29) - 1));
    if (std::find(ids.begin(), ids.end(), id) != ids.end())
      source.fail("another axis uses this CAN identifier");
    served.push_back(i), ids.push_back(id);
  }
  std::string error;
  auto bus = CanAxes::open(interface, ids, error);
  for (std::uint32_t k = 0; k < served.size(); ++k) {
    routes[served[k]] = {bus.get(), k};
    char device[96];
    std::snprintf(device, sizeof(device), "can %s id 0x%x", interface.c_str(), ids[k]);
    note(std::string("axis.") + file.axes[served[k]].wiring.name.c_str() + ".position  " + device, error,
         [this, bus = bus.get(), k] { return hear_axis(clock, *bus, k); });
  }
  buses[interface] = std::move(bus);
}

/// The drives of one CANopen bus; routes of their axes are filled in.
void Devices::Parts::make_drives(const std::string& interface, std::vector<Route<AxisReader>>& routes) {
  std::vector<PositionAxis> named;
  std::vector<std::size_t> served;
  for (std::size_t i = 0; i < file.axes.size(); ++i) {
    const SignalSource& source = file.axes[i].position;
    if (source.kind != "canopen" || source.text("interface") != interface) continue;
    named.push_back({&source, file.axes[i].wiring.rotary});
    served.push_back(i);
  }
  std::string error;
  auto bus = open_canopen_axes(named, error);
  for (std::uint32_t k = 0; k < served.size(); ++k) {
    routes[served[k]] = {bus.get(), k};
    note(std::string("axis.") + file.axes[served[k]].wiring.name.c_str() + ".position  canopen " + interface +
             " node " + std::to_string(named[k].source->whole("node", 1, 127)),
         error, [this, bus = bus.get(), k] {
           return hear_position(clock, *bus, k) ? ""
                                                : "no TPDO with statusword and position has come within 1 s";
         });
  }
  drives[interface] = std::move(bus);
}

/// The axes whose positions one request to a controller reads; their routes are filled in.
void Devices::Parts::make_register_axes(const std::string& block, std::vector<Route<AxisReader>>& routes) {
  std::vector<PositionAxis> named;
  std::vector<TimeUs> missing;
  std::vector<std::size_t> served;
  for (std::size_t i = 0; i < file.axes.size(); ++i) {
    const SignalSource& source = file.axes[i].position;
    if (source.kind != "modbus" || modbus_axes_block(source) != block) continue;
    named.push_back({&source, file.axes[i].wiring.rotary});
    missing.emplace_back(file.service.limits.axis[i].limits.missing_ticks * file.service.upload.tick.count);
    served.push_back(i);
  }
  std::string error;
  auto axes_of_block = open_modbus_axes(named, missing, error);
  for (std::uint32_t k = 0; k < served.size(); ++k) {
    routes[served[k]] = {axes_of_block.get(), k};
    note(std::string("axis.") + file.axes[served[k]].wiring.name.c_str() + ".position  modbus", error,
         [this, device = axes_of_block.get(), k] {
           return hear_position(clock, *device, k)
                      ? ""
                      : "the controller does not answer, or its sequence number does not change";
         });
  }
  register_axes[block] = std::move(axes_of_block);
}

void Devices::Parts::make_counter(std::uint32_t axis, std::vector<Route<AxisReader>>& routes) {
  std::string error;
  const SignalSource& source = file.axes[axis].position;
  auto counter =
      open_counter_axis({&source, file.axes[axis].wiring.rotary}, file.service.limits.axis[axis].limits,
                        file.service.upload.tick, clock, error);
  for (const auto& other : counters)
    if (counter && other->place() == counter->place())
      source.fail_at("device", "device: another axis has the counter " + counter->place());
  routes[axis] = {counter.get(), 0};
  note(std::string("axis.") + file.axes[axis].wiring.name.c_str() + ".position  counter", error,
       [this, counter = counter.get()] {
         return hear_position(clock, *counter, 0) ? "" : "the counter gives no count within its range";
       });
  if (counter) counters.push_back(std::move(counter));
}

std::vector<Route<AxisReader>> Devices::Parts::make_positions() {
  std::vector<Route<AxisReader>> routes(file.axes.size());
  for (std::uint32_t i = 0; i < file.axes.size(); ++i) {
    const SignalSource& source = file.axes[i].position;
    if (source.kind == "sim") {
      source.only({});
      routes[i] = {plant.get(), i};
      note(std::string("axis.") + file.axes[i].wiring.name.c_str() + ".position  sim", "");
    } else if (source.kind == "can") {
      const std::string interface = source.text("interface");
      if (!buses.contains(interface)) make_bus(interface, routes);
    } else if (source.kind == "canopen") {
      const std::string interface = source.text("interface");
      if (!drives.contains(interface)) make_drives(interface, routes);
    } else if (source.kind == "modbus") {
      const std::string block = modbus_axes_block(source);
      if (!register_axes.contains(block)) make_register_axes(block, routes);
    } else if (source.kind == "counter") {
      make_counter(i, routes);
    } else {
      source.fail("no position of kind " + source.kind + "; drivers: can, canopen, modbus, counter");
    }
  }
  return routes;
}

/// Reads the settings of all outputs. No device is opened: a board file with an error elsewhere must not
/// write to the machine.
std::vector<NamedOutput> Devices::Parts::read_outputs() const {
  std::vector<NamedOutput> named;
  std::set<std::uint32_t> known;
  for (std::uint32_t i = 0; i < file.axes.size(); ++i) {
    const SignalSource& source = file.axes[i].output;
    if (source.kind.empty()) continue;
    if (const double delay = source.number("delay_ms", 0); !(delay >= 0 && delay <= kMostDelayMs))
      source.fail("delay_ms must be between 0 and 10000");
    if (known.contains(i)) continue;
    if (source.kind == "sim") {
      source.only({});
      named.push_back({{i}, {}});
      continue;
    }
    named.push_back(read_output(i));
    known.insert(named.back().axes.begin(), named.back().axes.end());
  }
  return named;
}

/// The device of an output, for all axes that share the device.
NamedOutput Devices::Parts::read_output(std::uint32_t first) const {
  const std::string shared = device_of_output(file.axes[first].output);
  std::vector<OutputAxis> sharing;
  NamedOutput output;
  for (std::uint32_t i = first; i < file.axes.size(); ++i) {
    const AxisEntry& axis = file.axes[i];
    if (i != first && (shared.empty() || axis.output.kind != file.axes[first].output.kind ||
                       device_of_output(axis.output) != shared))
      continue;
    sharing.push_back({&axis.output, axis.wiring.rotary, file.service.limits.axis[i].motion.slew,
                       file.service.upload.tick});
    output.axes.push_back(i);
  }
  output.open = output_of(sharing);
  return output;
}

std::vector<Route<CorrectionWriter>> Devices::Parts::open_outputs(const std::vector<NamedOutput>& named) {
  std::vector<Route<CorrectionWriter>> routes(file.axes.size());
  for (const NamedOutput& output : named) open_output(output, routes);
  return routes;
}

void Devices::Parts::open_output(const NamedOutput& output, std::vector<Route<CorrectionWriter>>& routes) {
  std::string error;
  std::unique_ptr<OutputDevice> device;
  if (output.open) device = output.open(error);
  if (device && !device->lock()) error = "in use by another axis or another process";
  for (std::uint32_t k = 0; k < output.axes.size(); ++k) {
    const std::uint32_t i = output.axes[k];
    const AxisEntry& axis = file.axes[i];
    const std::string name = std::string("axis.") + axis.wiring.name.c_str() + ".output  " + axis.output.kind;
    if (!output.open) {
      routes[i] = {plant.get(), i};
      note(name, "");
      continue;
    }
    look_for_calibration(axis);
    routes[i] = {device.get(), k};
    note(name, error, [device = device.get(), k] { return device->attempt(k); });
    if (device) real_outputs.push_back({i, device.get(), k});
  }
  if (device) output_devices.push_back(std::move(device));
}

/// The calibration that an output names. If the board file has a separate span, the output is opened without
/// the calibration, so that --zero can remove the correction; no correction runs, because the calibration is
/// missing.
void Devices::Parts::look_for_calibration(const AxisEntry& axis) {
  const std::string path = axis.output.text("calibration", "");
  if (path.empty()) return;
  const std::string name = axis.wiring.name.c_str();
  note_file("axis." + name + ".output  calibration " + path,
            std::filesystem::is_regular_file(path)
                ? ""
                : "the calibration file does not exist; make this file with vernierd --calibrate " + name);
}

std::vector<Route<InputReader>> Devices::Parts::make_inputs() {
  std::vector<Route<InputReader>> routes(file.inputs.size());
  for (std::uint32_t i = 0; i < file.inputs.size(); ++i) {
    const SignalSource& source = file.inputs[i].source;
    const std::string name = "input." + file.inputs[i].name + "  " + source.kind;
    if (source.kind == "sim") {
      vibrate(i, source);
      routes[i] = {plant.get(), i};
      note(name, "");
      continue;
    }
    if (source.kind == "feature") continue;  // served in front of the routes
    if (source.kind == "iio-buffer") {
      const std::string& device = source.text("device");
      if (!buffers.contains(device)) make_buffer(device, routes);
      continue;
    }
    std::string error;
    auto input = open_sensor(source, lines, error);
    routes[i] = {input.get(), 0};
    note(name, error, [input = input.get()] {
      return input->sample() == HalFault::kNone ? "" : "the sensor gives no number";
    });
    if (input) sensors.push_back(std::move(input));
  }
  return routes;
}

/// One buffer for all inputs that name its device; their routes are filled in.
void Devices::Parts::make_buffer(const std::string& device, std::vector<Route<InputReader>>& routes) {
  std::vector<const SignalSource*> channels;
  std::vector<std::size_t> served;
  for (std::size_t i = 0; i < file.inputs.size(); ++i) {
    const SignalSource& source = file.inputs[i].source;
    if (source.kind != "iio-buffer" || source.text("device") != device) continue;
    for (const SignalSource* const other : channels)
      if (other->text("channel") == source.text("channel")) source.fail("another input uses this channel");
    served.push_back(i), channels.push_back(&source);
  }
  std::string error;
  auto buffer = open_iio_buffer(channels, error);
  for (std::uint32_t k = 0; k < served.size(); ++k) {
    routes[served[k]] = {buffer.get(), k};
    note("input." + file.inputs[served[k]].name + "  iio-buffer", error,
         [this, buffer = buffer.get(), k] { return hear_scan(clock, *buffer, k); });
  }
  buffers[device] = std::move(buffer);
}

/// A simulated input that swings, as an accelerometer does.
void Devices::Parts::vibrate(std::uint32_t input, const SignalSource& source) {
  source.only({"amplitude", "frequency_Hz"});
  const double amplitude = source.number("amplitude", 0), frequency_Hz = source.number("frequency_Hz", 0);
  if (!(std::abs(amplitude) <= 1e9)) source.fail("amplitude must be at most 1e9");
  if (!(frequency_Hz >= 0 && frequency_Hz <= 1e6)) source.fail("frequency_Hz must be between 0 and 1e6");
  motion->vibrate(input, amplitude * 1e6, frequency_Hz);
}

void Devices::Parts::make_features() {
  const std::vector<FeatureRequest> requests = feature_requests(file);
  features = std::make_unique<FeatureInputs>(*inputs, static_cast<std::uint32_t>(file.inputs.size()),
                                             requests, file.service.upload.tick);
  if (features->refused() != kNoInput)
    file.inputs[requests[features->refused()].input].source.fail(
        "the settings `window` or `corner_Hz` are outside their limits, so the feature has neither a window "
        "nor a filter");
  for (const FeatureRequest& request : requests) {
    const InputEntry& input = file.inputs[request.input];
    note("input." + input.name + "  " + input.source.text("feature") + " of " + input.source.text("of"), "");
  }
}

void Devices::Parts::make_sync() {
  if (file.sync.kind.empty()) return;
  std::string error;
  sync = open_sync(file.sync, error);
  note("board.sync  " + file.sync.kind, error, [this] {
    const InstantNs end = clock.now() + instant_ns(kPatience);
    return sync->wait_for_sync(end) == HalFault::kNone ? "" : "no sync signal has come within 1 s";
  });
}

void Devices::Parts::make_lines() {
  std::string error;
  if (!file.probe.kind.empty()) {
    probe = open_probe(file.probe, error);
    note("probe.line  " + file.probe.kind, error);
  }
  if (!file.enable.kind.empty()) {
    error.clear();
    enable = open_digital_input(file.enable, error);
    note("digital.enable  " + file.enable.kind, error, [this] {
      bool on = false;
      return enable->read_line(on) == HalFault::kNone ? "" : "cannot be read";
    });
  }
  if (!file.healthy.kind.empty()) {
    error.clear();
    healthy = open_digital_output(file.healthy, error);
    note("digital.healthy  " + file.healthy.kind, error,
         [this] { return healthy->write_line(false) == HalFault::kNone ? "" : "cannot be written"; });
  }
}

void Devices::Parts::make_links() {
  for (const LinkEntry& entry : file.links) {
    std::string error;
    auto link = open_link(entry.source, error);
    note("link  " + entry.source.kind, error);
    if (link) links.push_back({std::move(link), entry.rights});
  }
}

void Devices::Parts::make_store() {
  std::error_code failed;
  for (std::filesystem::path folder(file.store);
       !folder.empty() && folder.has_relative_path() && !std::filesystem::exists(folder, failed);
       folder = folder.parent_path())
    made.push_back(folder);
  std::filesystem::create_directories(file.store, failed);
  std::string missing = failed ? failed.message() : "";
  if (missing.empty() && ::access(file.store.c_str(), R_OK | W_OK | X_OK) != 0)
    missing = std::strerror(errno);
  if (missing.empty()) missing = store_lock.take(file.store);
  note("store  " + file.store, missing);
}

/// Files and devices that are named and not opened here. A watchdog begins to count when it is opened.
void Devices::Parts::look_at_files() {
  for (const std::string& key : file.key_files) note_file("key  " + key, "");
  if (file.watchdog.empty()) return;
  std::error_code failed;
  std::string missing;
  if (std::filesystem::is_directory(file.watchdog, failed))
    missing = "is a directory";
  else if (::access(file.watchdog.c_str(), W_OK) != 0)
    missing = std::strerror(errno);
  note("board.watchdog  " + file.watchdog, missing);
}

Devices::Devices(const BoardFile& file, unsigned long seed) : parts_(std::make_unique<Parts>(file)) {
  refuse_shared_registers(file);
  require_sync_of_drives(file);
  parts_->make_plant(seed);
  const std::vector<NamedOutput> outputs = parts_->read_outputs();
  parts_->axes = std::make_unique<RoutedAxes>(parts_->make_positions());
  const std::size_t before_outputs = parts_->findings.size();
  parts_->inputs = std::make_unique<RoutedInputs>(parts_->make_inputs());
  parts_->make_features();
  parts_->make_sync();
  parts_->make_lines();
  parts_->make_links();
  parts_->look_at_files();
  // Every setting is read now. The store makes its folder, and the outputs can write to the machine.
  std::size_t others = parts_->findings.size();
  parts_->outputs = std::make_unique<RoutedOutputs>(parts_->open_outputs(outputs));
  parts_->list_at(before_outputs, others);
  others = parts_->findings.size();
  parts_->make_store();
  parts_->list_at(0, others);
}

std::vector<std::string> Devices::not_looked_at() const {
  std::vector<std::string> lines;
  const BoardFile& file = parts_->file;
  for (const AxisEntry& axis : file.axes) {
    const std::string name = std::string("axis.") + axis.wiring.name.c_str();
    if (axis.position.kind != "sim")
      lines.push_back(
          name +
          ".position: a reading has arrived, but the check cannot test whether this position is right");
    const auto output = std::find_if(parts_->real_outputs.begin(), parts_->real_outputs.end(),
                                     [&](const RealOutput& one) { return &file.axes[one.axis] == &axis; });
    if (output != parts_->real_outputs.end())
      lines.push_back(name + ".output: what reaches the drive; " + output->device->trial());
  }
  if (!file.probe.kind.empty())
    lines.emplace_back("probe.line: whether the signal line of the probe changes at a touch");
  if (!file.enable.kind.empty()) lines.emplace_back("digital.enable: whether the line changes");
  if (!file.healthy.kind.empty())
    lines.emplace_back("digital.healthy: whether the machine controller reads this output line");
  if (!file.watchdog.empty())
    lines.emplace_back(
        "board.watchdog: whether the watchdog resets the computer; opening the device would start the "
        "watchdog");
  if (!file.links.empty())
    lines.emplace_back("link: whether a client can connect to the board over this link");
  lines.emplace_back("store: whether the confirmed image can be loaded");
  lines.emplace_back("priority: whether the operating system grants the real-time priority");
  return lines;
}

Devices::~Devices() = default;

Board Devices::board() noexcept {
  return {.clock = parts_->clock,
          .axes = *parts_->axes,
          .inputs = *parts_->features,
          .corrections = *parts_->outputs,
          .probe = parts_->probe.get(),
          .sync = parts_->sync.get(),
          .enable = parts_->enable.get(),
          .healthy = parts_->healthy.get()};
}

// It begins to count when it is opened, so that happens last and not for a trial.
std::string Devices::start_watchdog() {
  std::string error;
  if (!parts_->file.watchdog.empty())
    parts_->watchdog = HardwareWatchdog::open(parts_->file.watchdog, kWatchdogSeconds, error);
  return error;
}

void Devices::feed_watchdog() noexcept {
  if (parts_->watchdog) parts_->watchdog->feed();
}

void Devices::disarm_watchdog() noexcept {
  if (parts_->watchdog) parts_->watchdog->disarm();
}

Clock& Devices::clock() noexcept { return parts_->clock; }
std::vector<OpenLink>& Devices::links() noexcept { return parts_->links; }
std::vector<DeviceFinding>& Devices::findings() noexcept { return parts_->findings; }
void Devices::release() noexcept { parts_->plant->release(); }
void Devices::advance() noexcept { parts_->plant->advance(); }
bool Devices::has_sensors() const noexcept { return !parts_->sensors.empty(); }

// All links are waited for together: a quiet link does not delay a request of another link.
void Devices::wait_for_request(TimeUs wait, WakeUp& wake_up) noexcept {
  pollfd waiting[kMostHandles + 1];
  std::uint32_t count = 0;
  for (const auto& link : parts_->links) {
    int handles[kMostHandles];
    const std::uint32_t added = link.device->handles(handles, kMostHandles - count);
    for (std::uint32_t i = 0; i < added; ++i) waiting[count++] = {handles[i], POLLIN, 0};
  }
  waiting[count++] = {wake_up.handle(), POLLIN, 0};
  ::poll(waiting, count, static_cast<int>(wait.count / 1000));
  wake_up.clear();
}

void Devices::sample() noexcept {
  for (auto& sensor : parts_->sensors) sensor->sample();
}

bool Devices::take_left_overs_out(const std::atomic<bool>& stop) noexcept {
  constexpr InstantNs kAfterStop(10'000'000'000);
  struct OnItsWay {
    const RealOutput* output;
    MotionLimit motion;
    MotionBounds bounds;
    bool at_zero = false;
  };
  std::vector<OnItsWay> all;
  for (const RealOutput& output : parts_->real_outputs) {
    OnItsWay one{&output, {}, parts_->file.service.limits.axis[output.axis].motion};
    AxisTravel held;
    if (output.device->read_back(output.number, held) == HalFault::kNone) one.motion.stop_at(held.count);
    one.bounds.slew = std::min(one.bounds.slew, std::abs(held.count) / kTicksToZero + 1);
    all.push_back(one);
  }
  // A request to end does not leave a value: it only limits the time.
  InstantNs last(INT64_MAX);
  for (bool left = !all.empty(); left;) {
    left = false;
    for (OnItsWay& one : all) {
      if (one.at_zero) continue;
      OutputDevice& device = *one.output->device;
      const AxisTravel next(one.motion.approach(0, one.bounds));
      one.at_zero =
          next == AxisTravel{} || device.write_correction(one.output->number, next) != HalFault::kNone;
      // The zero is written too, because some drivers do not report their value; a refusal appears in the
      // first ticks.
      if (one.at_zero) device.write_correction(one.output->number, AxisTravel{});
      left = left || !one.at_zero;
    }
    const InstantNs now = parts_->clock.now();
    if (stop && last.count == INT64_MAX) last = now + kAfterStop;
    if (left && now > last) return false;
    parts_->clock.sleep_until(now + instant_ns(parts_->file.service.upload.tick));
  }
  return true;
}

std::vector<std::string> Devices::output_budget() const {
  std::vector<std::string> lines;
  for (const RealOutput& output : parts_->real_outputs) {
    const AxisEntry& axis = parts_->file.axes[output.axis];
    const AnalogueScale& scale = output.device->scale(output.number);
    // um or 0.001 deg
    const double unit = axis.wiring.rotary ? static_cast<double>(kTurnCounts) / 360e3 : 1e3;
    const auto of = [&](std::int64_t code) {
      return static_cast<double>(scale.correction_of(code).count) / unit;
    };
    const double step = static_cast<double>(scale.span) / static_cast<double>(scale.codes) / unit;
    const char* const name = axis.wiring.rotary ? "mdeg" : "um";
    char text[240];
    int used = std::snprintf(
        text, sizeof text, "axis.%s.output: %.6g to %.6g %s, step %.4g, error at most %.4g (rms %.4g)",
        axis.wiring.name.c_str(), std::min(of(scale.low), of(scale.high)),
        std::max(of(scale.low), of(scale.high)), name, step, step / 2, step / std::sqrt(12.0));
    const MotionBounds& motion = parts_->file.service.limits.axis[output.axis].motion;
    const double slew = static_cast<double>(motion.slew) / unit;
    const auto add = [&](const char* form, auto... values) {
      used += std::snprintf(text + used, sizeof text - static_cast<std::size_t>(used), form, values...);
    };
    add("; at most %.4g %s a tick", slew, name);
    if (motion.acceleration != kAnyAcceleration)
      add(", %.4g more in each", static_cast<double>(motion.acceleration) / unit);
    if (const double delay_ms = axis.output.number("delay_ms", 0); delay_ms > 0) {
      const double tick_ms = static_cast<double>(parts_->file.service.upload.tick.count) * 1e-3;
      add("; delay %.4g ms: at most %.4g more at the largest speed of the correction", delay_ms,
          slew / tick_ms * delay_ms);
    }
    lines.emplace_back(text);
  }
  return lines;
}

bool Devices::corrections_have_arrived() const noexcept {
  const auto& outputs = parts_->real_outputs;
  return std::all_of(outputs.begin(), outputs.end(),
                     [](const RealOutput& output) { return output.device->has_arrived(output.number); });
}

void Devices::say_held() const {
  for (const RealOutput& output : parts_->real_outputs)
    if (output.device->held_at_end(output.number) > 0)
      std::fprintf(stderr, "vernierd: axis.%s.output was held at the end of its range in %llu ticks\n",
                   parts_->file.axes[output.axis].wiring.name.c_str(),
                   static_cast<unsigned long long>(output.device->held_at_end(output.number)));
  for (const auto& device : parts_->output_devices)
    if (const std::string account = device->account(); !account.empty())
      std::fprintf(stderr, "vernierd: %s\n", account.c_str());
  for (const auto& [block, axes] : parts_->register_axes)
    if (axes) std::fprintf(stderr, "vernierd: %s\n", axes->account().c_str());
  for (const auto& [place, line] : parts_->lines)
    if (line && line->wrong_answers() > 0)
      std::fprintf(stderr,
                   "vernierd: Modbus at %s: %llu answers were damaged or did not belong to the request\n",
                   place.c_str(), static_cast<unsigned long long>(line->wrong_answers()));
  for (const auto& [device, buffer] : parts_->buffers) {
    const IioBufferCounts& counts = buffer->counts();
    if (counts.skipped + counts.missing + counts.malformed + counts.broken == 0) continue;
    std::fprintf(
        stderr,
        "vernierd: buffer of %s: %llu scans, %llu skipped, %llu ticks without a scan, %llu malformed scans, "
        "%llu ticks with a broken buffer\n",
        device.c_str(), static_cast<unsigned long long>(counts.scans),
        static_cast<unsigned long long>(counts.skipped), static_cast<unsigned long long>(counts.missing),
        static_cast<unsigned long long>(counts.malformed), static_cast<unsigned long long>(counts.broken));
  }
}

}  // namespace vernier
