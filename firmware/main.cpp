// SPDX-License-Identifier: Apache-2.0
// vernierd: the composition root, the only file of the firmware that names a backend.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "firmware/arguments.h"
#include "firmware/board_file.h"
#include "firmware/device_settings.h"
#include "firmware/image_file.h"
#include "firmware/report.h"
#include "firmware/routing.h"
#include "firmware/runner.h"
#include "firmware/service.h"
#include "hal/linux/analogue_output.h"
#include "hal/linux/can_axes.h"
#include "hal/linux/file_slot_store.h"
#include "hal/linux/iio_device.h"
#include "hal/linux/iio_input.h"
#include "hal/linux/isotp_link.h"
#include "hal/linux/modbus_server.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/realtime.h"
#include "hal/linux/service_manager.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"

namespace {

using namespace vernier;

constexpr int kDone = 0, kBadInput = 1, kAnswerIsNo = 2;
constexpr int kPriority = 80;  // as cyclictest is usually run, above the kernel's threaded interrupts (50)
constexpr double kShareOfRangePerS = 0.1;
constexpr TimeUs kServeWait(20'000);
constexpr int kMostTicksToEnd = 30'000;
constexpr std::uint64_t kTicksBetweenSigns = 100;  // of life, to the service manager
constexpr std::int64_t kTicksToZero = 1000;        // at least, for what a drive holds at the start
constexpr TimeUs kSampleWait(10'000);              // between two samples of the sensors
constexpr std::int64_t kStaleTicks = 1000;         // ticks after which an unchanged sample is silence
constexpr TimeUs kPatience(1'000'000), kTrialWait(5'000);

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

GrantReport ask_for_realtime(bool wanted, int priority) {
  if (!wanted) return {};
  const RealtimeGrant grant = become_realtime(priority);
  const auto say = [](int error, const char* what) {
    if (error != 0) std::fprintf(stderr, "vernierd: note: no %s: %s\n", what, std::strerror(error));
  };
  say(grant.memory_error, "locked memory");
  say(grant.schedule_error, "SCHED_FIFO: wake-ups will be late");
  say(grant.idle_error, "shallow idle states");
  return {grant.schedule_error == 0, grant.memory_error == 0, grant.idle_error == 0};
}

int finish(const Arguments& arguments, const Cycle& cycle, const GrantReport& grant) {
  if (!report_run(cycle, grant, arguments.json)) return kBadInput;
  return cycle.latched() == Fault::kNone ? kDone : kAnswerIsNo;
}

// ---- without a board: an image on the simulated machine

Roaming motion_in(const ImageView& image, unsigned long seed) {
  std::vector<RoamingAxis> axes;
  std::vector<InputMicro> inputs;
  for (const AxisRecord& axis : image.axes()) axes.push_back({axis.low, axis.high});
  for (const InputRecord& input : image.inputs()) inputs.emplace_back(input.reference);
  return Roaming(axes, inputs, TimeUs(image.header().tick_us), kShareOfRangePerS, seed);
}

int run_image(const Arguments& arguments, const ImageView& image) {
  MonotonicClock clock;
  Roaming motion = motion_in(image, arguments.seed);
  const auto plant = std::make_unique<SimPlant>(motion, image.axes().size, image.inputs().size,
                                                PlantOptions{.seed = arguments.seed, .faults = {}});
  const Board board{clock, *plant, *plant, *plant};
  const auto cycle = std::make_unique<Cycle>(image, board);
  const GrantReport grant = ask_for_realtime(arguments.realtime, kPriority);
  plant->release();
  const TimeUs period(image.header().tick_us);
  const double seconds = arguments.seconds > 0 ? arguments.seconds : 10;
  const auto ticks = static_cast<std::int64_t>(seconds * 1e6) / period.count;
  Runner runner(*cycle, clock, period);
  for (std::int64_t tick = 0; tick < ticks && !stop_asked; ++tick) {
    plant->advance();
    const bool ready = cycle->mode() == Mode::kReady && cycle->weight() == WeightQ16{};
    runner.step(ready ? Command::kActivate : Command::kNone);
  }
  return finish(arguments, *cycle, grant);
}

int run_image(const Arguments& arguments) {
  if (!arguments.simulate) {
    std::fputs("vernierd: --image needs --simulate; a real machine is described by a board file (--board)\n",
               stderr);
    return kBadInput;
  }
  const std::string path = arguments.image + "/machine.vimg";
  std::vector<std::uint8_t> bytes;
  if (!read_bytes(path, bytes)) {
    std::fprintf(stderr, "vernierd: %s: cannot be read\n", path.c_str());
    return kBadInput;
  }
  const auto image = std::make_unique<ImageFile>();
  if (const ImageFault fault = image->open(bytes); fault != ImageFault::kNone) {
    std::fprintf(stderr, "vernierd: %s: %s\n", path.c_str(), describe(fault));
    return kBadInput;
  }
  return run_image(arguments, image->view());
}

// ---- a board

/// What `--check` says of a device.
struct Finding {
  std::string device;                    // "axis.X.output  pwm"
  std::string missing;                   // empty: it is there
  std::function<std::string()> attempt;  // tries it once more; what is missing, or empty
};

struct Output {
  std::size_t axis;
  std::unique_ptr<AnalogueOutput> device;
};

/// The devices of a board, alive as long as it runs.
struct Devices {
  MonotonicClock clock;
  std::unique_ptr<Roaming> motion;
  std::unique_ptr<SimPlant> plant;
  std::map<std::string, std::unique_ptr<CanAxes>> buses;  // by interface
  std::vector<Output> analogue;
  std::vector<std::unique_ptr<IioInput>> sensors;
  std::unique_ptr<RoutedAxes> axes;
  std::unique_ptr<RoutedInputs> inputs;
  std::unique_ptr<RoutedOutputs> outputs;
  std::vector<std::unique_ptr<CommandLink>> links;
  std::vector<Finding> findings;

  Board board() { return {clock, *axes, *inputs, *outputs}; }
  void note(const std::string& device, const std::string& missing,
            std::function<std::string()> attempt = {}) {
    findings.push_back({device, missing, std::move(attempt)});
  }
};

void make_plant(const BoardFile& file, unsigned long seed, Devices& devices) {
  std::vector<RoamingAxis> ranges;
  std::vector<InputMicro> inputs;
  for (const AxisEntry& axis : file.axes) {
    const double scale = axis.wiring.rotary ? static_cast<double>(kTurnCounts) / 360 : 1e6;
    ranges.push_back(
        {static_cast<std::int64_t>(axis.low * scale), static_cast<std::int64_t>(axis.high * scale)});
  }
  for (const InputEntry& input : file.inputs)
    inputs.emplace_back(static_cast<std::int64_t>(input.reference * 1e6));
  devices.motion =
      std::make_unique<Roaming>(ranges, inputs, file.service.upload.tick, kShareOfRangePerS, seed);
  devices.plant = std::make_unique<SimPlant>(*devices.motion, static_cast<std::uint32_t>(file.axes.size()),
                                             static_cast<std::uint32_t>(file.inputs.size()),
                                             PlantOptions{.seed = seed, .faults = {}});
}

/// Waits for one frame of an axis.
std::string hear_axis(Clock& clock, CanAxes& bus, std::uint32_t axis) {
  const InstantNs end = clock.now() + instant_ns(kPatience);
  for (AxisReading reading; clock.now() < end; clock.sleep_until(clock.now() + instant_ns(kTrialWait))) {
    bus.begin_tick();
    if (bus.read_axis(axis, reading) == HalFault::kNone) return {};
  }
  return bus.counts().frames + bus.counts().invalid + bus.counts().stalled == 0
             ? "no frame has come within 1 s"
             : "no valid frame within 1 s";
}

/// One bus for all axes that name its interface; routes of the axes are filled in.
void make_bus(const BoardFile& file, const std::string& interface, std::vector<Route<AxisReader>>& routes,
              Devices& devices) {
  std::vector<std::uint32_t> ids;
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < file.axes.size(); ++i) {
    const SignalSource& source = file.axes[i].position;
    if (source.kind != "can" || source.text("interface") != interface) continue;
    source.only({"interface", "id"});
    const auto id = static_cast<std::uint32_t>(source.whole("id", 0, (1 << 29) - 1));
    if (std::find(ids.begin(), ids.end(), id) != ids.end()) source.fail("another axis has this id");
    axes.push_back(i), ids.push_back(id);
  }
  std::string error;
  auto bus = CanAxes::open(interface, ids, error);
  for (std::uint32_t k = 0; k < axes.size(); ++k) {
    routes[axes[k]] = {bus.get(), k};
    char device[96];
    std::snprintf(device, sizeof(device), "can %s id 0x%x", interface.c_str(), ids[k]);
    devices.note("axis." + file.axes[axes[k]].wiring.name + ".position  " + device, error,
                 [&clock = devices.clock, bus = bus.get(), k] { return hear_axis(clock, *bus, k); });
  }
  devices.buses[interface] = std::move(bus);
}

std::vector<Route<AxisReader>> make_positions(const BoardFile& file, Devices& devices) {
  std::vector<Route<AxisReader>> routes(file.axes.size());
  for (std::uint32_t i = 0; i < file.axes.size(); ++i) {
    const SignalSource& source = file.axes[i].position;
    if (source.kind == "sim") {
      source.only({});
      routes[i] = {devices.plant.get(), i};
      devices.note("axis." + file.axes[i].wiring.name + ".position  sim", "");
    } else if (source.kind == "can") {
      const std::string interface = source.text("interface");
      if (!devices.buses.contains(interface)) make_bus(file, interface, routes, devices);
    } else {
      source.fail("no position of kind " + source.kind);
    }
  }
  return routes;
}

/// Opens a PWM channel or a converter; null with `error` set where it is missing.
std::unique_ptr<AnalogueOutput> open_analogue(const SignalSource& source, bool rotary, std::string& error) {
  if (source.kind == "pwm") {
    source.only({"path", "period_ns", "span", "zero_ns", "low_ns", "high_ns", "polarity"});
    const std::int64_t period = source.whole("period_ns", 2, 1'000'000'000);
    return AnalogueOutput::pwm(source.text("path"), period, analogue_scale(source, rotary, period, "_ns"),
                               error);
  }
  if (source.kind != "iio-dac") source.fail("no output of kind " + source.kind);
  source.only({"root", "device", "channel", "codes", "span", "zero", "low", "high", "polarity"});
  const AnalogueScale scale = analogue_scale(source, rotary, source.whole("codes", 1, (1 << 24) - 1), "");
  const auto channel = static_cast<unsigned>(source.whole("channel", 0, 0, 63));
  const std::string device = find_iio_device(source.text("root", kIioRoot), source.text("device"), error);
  return device.empty() ? nullptr : AnalogueOutput::iio_dac(device, channel, scale, error);
}

std::string try_output(AnalogueOutput& output) {
  const HalFault fault = output.rewrite();
  if (fault == HalFault::kRefused) return "refuses the value that it has";
  return fault == HalFault::kNone ? "" : "the value that it has cannot be read";
}

std::vector<Route<CorrectionWriter>> make_outputs(const BoardFile& file, Devices& devices) {
  std::vector<Route<CorrectionWriter>> routes(file.axes.size());
  for (std::uint32_t i = 0; i < file.axes.size(); ++i) {
    const AxisEntry& axis = file.axes[i];
    if (axis.output.kind.empty()) continue;
    const std::string name = "axis." + axis.wiring.name + ".output  " + axis.output.kind;
    if (axis.output.kind == "sim") {
      axis.output.only({});
      routes[i] = {devices.plant.get(), i};
      devices.note(name, "");
      continue;
    }
    std::string error;
    auto output = open_analogue(axis.output, axis.wiring.rotary, error);
    routes[i] = {output.get(), 0};
    devices.note(name, error, [output = output.get()] { return try_output(*output); });
    if (output) devices.analogue.push_back({i, std::move(output)});
  }
  return routes;
}

std::vector<Route<InputReader>> make_inputs(const BoardFile& file, Devices& devices) {
  std::vector<Route<InputReader>> routes(file.inputs.size());
  for (std::uint32_t i = 0; i < file.inputs.size(); ++i) {
    const SignalSource& source = file.inputs[i].source;
    const std::string name = "input." + file.inputs[i].name + "  " + source.kind;
    if (source.kind == "sim") {
      source.only({});
      routes[i] = {devices.plant.get(), i};
      devices.note(name, "");
      continue;
    }
    if (source.kind != "iio") source.fail("no input of kind " + source.kind);
    source.only({"root", "device", "attribute", "scale", "offset", "stale_ticks"});
    const IioScale scale{source.number("offset", 0), source.number("scale")};
    const auto stale = static_cast<std::uint32_t>(source.whole("stale_ticks", kStaleTicks, 1, 1'000'000));
    const std::string attribute = source.text("attribute");
    if (attribute.empty()) source.fail("attribute is empty");
    std::string error;
    const std::string device = find_iio_device(source.text("root", kIioRoot), source.text("device"), error);
    std::unique_ptr<IioInput> input;
    if (!device.empty()) input = IioInput::open(device + "/" + attribute, scale, stale, error);
    routes[i] = {input.get(), 0};
    devices.note(name, error, [input = input.get()] {
      return input->sample() == HalFault::kNone ? "" : "gives no number";
    });
    if (input) devices.sensors.push_back(std::move(input));
  }
  return routes;
}

void make_devices(const BoardFile& file, unsigned long seed, Devices& devices) {
  make_plant(file, seed, devices);
  devices.axes = std::make_unique<RoutedAxes>(make_positions(file, devices));
  devices.outputs = std::make_unique<RoutedOutputs>(make_outputs(file, devices));
  devices.inputs = std::make_unique<RoutedInputs>(make_inputs(file, devices));
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
    const std::string parity = source.text("parity", "E");
    if (parity != "E" && parity != "O" && parity != "N") source.fail("parity must be E, O or N");
    return ModbusServer::rtu(source.text("device"),
                             static_cast<int>(source.whole("baud", 115200, 1, 10'000'000)), parity[0],
                             static_cast<int>(source.whole("unit", 1, 1, 247)), layout, error);
  }
  if (source.kind != "isotp") source.fail("no link of kind " + source.kind);
  source.only({"interface", "receive", "transmit"});
  constexpr std::int64_t kLastId = (1 << 29) - 1;
  return IsotpLink::open(source.text("interface"),
                         static_cast<std::uint32_t>(source.whole("receive", 0, kLastId)),
                         static_cast<std::uint32_t>(source.whole("transmit", 0, kLastId)), error);
}

void make_links(const BoardFile& file, Devices& devices) {
  for (const SignalSource& source : file.links) {
    std::string error;
    auto link = open_link(source, error);
    devices.note("link  " + source.kind, error);
    if (link) devices.links.push_back(std::move(link));
  }
}

void make_store(const BoardFile& file, Devices& devices) {
  std::error_code failed;
  std::filesystem::create_directories(file.store, failed);
  std::string missing = failed ? failed.message() : "";
  if (missing.empty() && ::access(file.store.c_str(), R_OK | W_OK | X_OK) != 0)
    missing = std::strerror(errno);
  devices.note("store  " + file.store, missing);
}

int check_devices(Devices& devices) {
  int missing = 0;
  for (Finding& finding : devices.findings) {
    if (finding.missing.empty() && finding.attempt) finding.missing = finding.attempt();
    const bool there = finding.missing.empty();
    std::printf("%s  %s%s%s\n", there ? "ok     " : "missing", finding.device.c_str(), there ? "" : ": ",
                finding.missing.c_str());
    missing += there ? 0 : 1;
  }
  std::printf(missing == 0 ? "%zu devices: all there\n" : "%zu devices: %d missing\n",
              devices.findings.size(), missing);
  return missing == 0 ? kDone : kAnswerIsNo;
}

bool all_there(const Devices& devices) {
  bool all = true;
  for (const Finding& finding : devices.findings) {
    if (finding.missing.empty()) continue;
    std::fprintf(stderr, "vernierd: missing: %s: %s\n", finding.device.c_str(), finding.missing.c_str());
    all = false;
  }
  return all;
}

/// A correction that a killed daemon left in a drive, or the value that a converter wakes up with, is taken
/// out before the first tick: within the limits of the axis, and over a second at least.
void take_left_overs_out(const BoardFile& file, Devices& devices) {
  for (const Output& output : devices.analogue) {
    AxisTravel held;
    MotionLimit motion;
    MotionBounds bounds = file.service.limits.axis[output.axis].motion;
    if (output.device->read_back(held) == HalFault::kNone) motion.stop_at(held.count);
    bounds.slew = std::min(bounds.slew, std::abs(held.count) / kTicksToZero + 1);
    // The zero is written too, as some drivers do not say what they hold; a refusal shows in the first ticks.
    for (bool zero = false; !zero && !stop_asked;) {
      const AxisTravel next(motion.approach(0, bounds));
      zero = next == AxisTravel{} || output.device->write_correction(0, next) != HalFault::kNone;
      if (zero) output.device->write_correction(0, AxisTravel{});
      devices.clock.sleep_until(devices.clock.now() + instant_ns(file.service.upload.tick));
    }
  }
}

void say_image(const UploadResult& result, const Service& service) {
  if (result.fault != UploadFault::kNone)
    std::fprintf(stderr, "vernierd: the confirmed image is not used: %s\n", describe(result).c_str());
  else if (service.uploader().slots().confirmed() == kNoSlot)
    std::fputs("vernierd: no image has been confirmed yet: nothing is corrected\n", stderr);
  else
    std::fprintf(stderr, "vernierd: image %016llx\n",
                 static_cast<unsigned long long>(service.uploader().confirmed_fingerprint()));
}

/// Serves links and looks after programs until told to stop. The service manager hears of it only while the
/// tick moves on: a tick that hangs is a daemon that hangs.
void serve_until(const std::atomic<bool>& stop, Service& service, Devices& devices) {
  std::uint64_t ticks_told = 0;
  while (!stop) {
    if (const std::uint64_t ticks = service.exchange().ticks.count();
        ticks > ticks_told + kTicksBetweenSigns) {
      notify_service_manager("WATCHDOG=1");
      ticks_told = ticks;
    }
    for (auto& link : devices.links)
      service.serve(*link, TimeUs(kServeWait.count / static_cast<std::int64_t>(devices.links.size())));
    if (devices.links.empty()) {
      service.look_after_programs();
      devices.clock.sleep_until(devices.clock.now() + instant_ns(kServeWait));
    }
  }
}

/// A daemon that ends leaves no correction in the drives: it is ramped out first, within the limits of the
/// axes.
void take_correction_out(Service& service, Devices& devices) {
  const auto out = [&] {
    for (std::uint32_t axis = 0; axis < kMaxAxes; ++axis)
      if (service.cycle().written(axis) != AxisTravel{}) return false;
    return true;
  };
  service.end();
  for (int tick = 0; tick < kMostTicksToEnd && !out(); ++tick) {
    devices.plant->advance();
    service.tick();
  }
}

/// Sensors wait for their drivers, and are sampled beside the tick.
void sample_until(const std::atomic<bool>& stop, Devices& devices) {
  while (!stop && !devices.sensors.empty()) {
    for (auto& sensor : devices.sensors) sensor->sample();
    devices.clock.sleep_until(devices.clock.now() + instant_ns(kSampleWait));
  }
}

void say_held(const BoardFile& file, const Devices& devices) {
  for (const Output& output : devices.analogue)
    if (output.device->held_at_end() > 0)
      std::fprintf(stderr, "vernierd: axis.%s.output was held at the end of its range in %llu ticks\n",
                   file.axes[output.axis].wiring.name.c_str(),
                   static_cast<unsigned long long>(output.device->held_at_end()));
}

int run_board(const Arguments& arguments) {
  const BoardFile file = read_board_file(arguments.board);
  Devices devices;
  make_store(file, devices);
  make_devices(file, arguments.seed, devices);
  make_links(file, devices);
  if (arguments.check) return check_devices(devices);
  if (!all_there(devices)) return kAnswerIsNo;
  for (auto& sensor : devices.sensors) sensor->sample();
  take_left_overs_out(file, devices);
  FileSlotStore store(file.store, file.slot_bytes);
  const auto service = std::make_unique<Service>(file.service, devices.board(), store);
  say_image(service->boot(), *service);
  std::atomic<bool> stop_beside{false};
  std::thread server([&] { serve_until(stop_beside, *service, devices); });
  std::thread sampler([&] { sample_until(stop_beside, devices); });
  const GrantReport grant = ask_for_realtime(arguments.realtime, file.priority);
  devices.plant->release();
  if (!notify_service_manager("READY=1"))
    std::fputs("vernierd: note: the service manager cannot be told\n", stderr);
  const auto ticks = static_cast<std::int64_t>(arguments.seconds * 1e6) / file.service.upload.tick.count;
  for (std::int64_t tick = 0; (ticks == 0 || tick < ticks) && !stop_asked; ++tick) {
    devices.plant->advance();
    service->tick();
  }
  notify_service_manager("STOPPING=1");
  take_correction_out(*service, devices);
  stop_beside = true;
  server.join(), sampler.join();
  say_held(file, devices);
  return finish(arguments, service->cycle(), grant);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (!parse_arguments(argc, argv, arguments)) {
    std::fputs(kUsage, stderr);
    return kBadInput;
  }
  if (arguments.help) {
    std::fputs(kUsage, stdout);
    return kDone;
  }
  std::signal(SIGTERM, [](int) { stop_asked = true; });
  std::signal(SIGINT, [](int) { stop_asked = true; });
  try {
    return arguments.board.empty() ? run_image(arguments) : run_board(arguments);
  } catch (const BoardError& error) {
    std::fprintf(stderr, "vernierd: %s\n", error.what.c_str());
    return kBadInput;
  }
}
