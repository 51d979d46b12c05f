// SPDX-License-Identifier: Apache-2.0
// vernierd: the composition root, the only file of the firmware that names a backend.
#include <getopt.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "firmware/board_file.h"
#include "firmware/image_file.h"
#include "firmware/report.h"
#include "firmware/routing.h"
#include "firmware/runner.h"
#include "firmware/service.h"
#include "hal/linux/file_slot_store.h"
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

struct Arguments {
  std::string image, board, json;
  double seconds = 0;
  unsigned long seed = 1;
  bool simulate = false, realtime = true, check = false;
};

constexpr const char* kUsage =
    "usage: vernierd --board FILE [--check] [--seconds S] [--no-realtime] [--json FILE]\n"
    "       vernierd --image DIR --simulate [--seconds S] [--seed N] [--no-realtime] [--json FILE]\n"
    "Runs the 1 kHz compensation cycle.\n"
    "  --board FILE    the board: its axes, sensors, outputs, links and store (tools/docs/board.md)\n"
    "  --check         try every device of the board file once, say what is missing, and end\n"
    "  --image DIR     without a board: the directory that `vernier compile` wrote ...\n"
    "  --simulate      ... on the simulated machine, in real time: every axis roams through its range\n"
    "  --seconds S     stop after S seconds (default: never with --board, 10 with --simulate)\n"
    "  --seed N        seed of the simulated motion (default 1)\n"
    "  --no-realtime   do not ask for SCHED_FIFO, locked memory and shallow idle states\n"
    "  --json FILE     result for programs; - is standard output\n"
    "Exit status: 0 done, 1 bad input or usage, 2 a fault latched, a device is missing or a limit was not "
    "met.\n";

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

bool parse_value(const char* text, double low, double high, double& value) {
  char* end = nullptr;
  value = std::strtod(text, &end);
  return end != text && *end == '\0' && value >= low && value <= high;
}

bool parse(int argc, char** argv, Arguments& arguments) {
  const option kOptions[] = {
      {"image", required_argument, nullptr, 'i'},   {"simulate", no_argument, nullptr, 's'},
      {"seconds", required_argument, nullptr, 't'}, {"seed", required_argument, nullptr, 'r'},
      {"no-realtime", no_argument, nullptr, 'n'},   {"json", required_argument, nullptr, 'j'},
      {"board", required_argument, nullptr, 'b'},   {"check", no_argument, nullptr, 'c'},
      {"help", no_argument, nullptr, 'h'},          {nullptr, 0, nullptr, 0}};
  double number = 0;
  for (int c = 0; (c = getopt_long(argc, argv, "h", kOptions, nullptr)) != -1;) {
    if (c == 'i') arguments.image = optarg;
    if (c == 's') arguments.simulate = true;
    if (c == 'n') arguments.realtime = false;
    if (c == 'j') arguments.json = optarg;
    if (c == 'b') arguments.board = optarg;
    if (c == 'c') arguments.check = true;
    if (c == 't' && !parse_value(optarg, 0.1, 1e9, arguments.seconds)) return false;
    if (c == 'r' && !parse_value(optarg, 0, 1e15, number)) return false;
    if (c == 'r') arguments.seed = static_cast<unsigned long>(number);
    if (c == 'h') std::fputs(kUsage, stdout), std::exit(kDone);
    if (c == '?') return false;
  }
  return optind == argc && arguments.image.empty() != arguments.board.empty();
}

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

/// The devices of a board, alive as long as it runs.
struct Devices {
  MonotonicClock clock;
  std::unique_ptr<Roaming> motion;
  std::unique_ptr<SimPlant> plant;
  std::unique_ptr<RoutedAxes> axes;
  std::unique_ptr<RoutedInputs> inputs;
  std::unique_ptr<RoutedOutputs> outputs;
  std::vector<std::unique_ptr<CommandLink>> links;

  Board board() { return {clock, *axes, *inputs, *outputs}; }
};

[[noreturn]] void refuse(const BoardFile& file, const SignalSource& source, const std::string& why) {
  throw BoardError{file.path + ":" + std::to_string(source.line) + ": " + why};
}

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

void make_devices(const BoardFile& file, unsigned long seed, Devices& devices) {
  make_plant(file, seed, devices);
  std::vector<Route<AxisReader>> axes;
  std::vector<Route<InputReader>> inputs;
  std::vector<Route<CorrectionWriter>> outputs;
  for (const AxisEntry& axis : file.axes) {
    const auto index = static_cast<std::uint32_t>(axes.size());
    if (axis.position.kind != "sim") refuse(file, axis.position, "no position of kind " + axis.position.kind);
    axes.push_back({devices.plant.get(), index});
    if (axis.output.kind.empty())
      outputs.push_back({});
    else if (axis.output.kind == "sim")
      outputs.push_back({devices.plant.get(), index});
    else
      refuse(file, axis.output, "no output of kind " + axis.output.kind);
  }
  for (const InputEntry& input : file.inputs) {
    if (input.source.kind != "sim") refuse(file, input.source, "no input of kind " + input.source.kind);
    inputs.push_back({devices.plant.get(), static_cast<std::uint32_t>(inputs.size())});
  }
  devices.axes = std::make_unique<RoutedAxes>(std::move(axes));
  devices.inputs = std::make_unique<RoutedInputs>(std::move(inputs));
  devices.outputs = std::make_unique<RoutedOutputs>(std::move(outputs));
}

std::unique_ptr<CommandLink> make_link(const BoardFile& file, const SignalSource& source) {
  const ModbusLayout layout{kMailboxRegister, kMailboxRegisters, kLiveRegisters};
  std::string error;
  std::unique_ptr<CommandLink> link;
  if (source.kind == "modbus-tcp") {
    const std::string address = source.text("address", "127.0.0.1");
    auto server = ModbusServer::tcp(address, static_cast<int>(source.number("port", 1502)), layout, error);
    if (server) std::fprintf(stderr, "vernierd: Modbus TCP on %s:%d\n", address.c_str(), server->port());
    link = std::move(server);
  } else if (source.kind == "modbus-rtu") {
    link = ModbusServer::rtu(source.text("device"), static_cast<int>(source.number("baud", 115200)),
                             source.text("parity", "E")[0], static_cast<int>(source.number("unit", 1)),
                             layout, error);
  } else if (source.kind == "isotp") {
    link = IsotpLink::open(source.text("interface"), static_cast<std::uint32_t>(source.number("receive")),
                           static_cast<std::uint32_t>(source.number("transmit")), error);
  } else {
    error = "no link of kind " + source.kind;
  }
  if (!link) refuse(file, source, error);
  return link;
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

int run_board(const Arguments& arguments) {
  BoardFile file = read_board_file(arguments.board);
  std::filesystem::create_directories(file.store);
  Devices devices;
  make_devices(file, arguments.seed, devices);
  for (const SignalSource& link : file.links) devices.links.push_back(make_link(file, link));
  if (arguments.check) {
    std::printf("%zu axes, %zu inputs, %zu links: all there\n", file.axes.size(), file.inputs.size(),
                devices.links.size());
    return kDone;
  }
  FileSlotStore store(file.store, file.slot_bytes);
  const auto service = std::make_unique<Service>(file.service, devices.board(), store);
  say_image(service->boot(), *service);
  std::atomic<bool> stop_serving{false};
  std::thread server([&] { serve_until(stop_serving, *service, devices); });
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
  stop_serving = true;
  server.join();
  return finish(arguments, service->cycle(), grant);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) {
    std::fputs(kUsage, stderr);
    return kBadInput;
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
