// SPDX-License-Identifier: Apache-2.0
// vernierd: with devices.cpp and open_devices.cpp the composition root, which alone names backends.
#include <sys/random.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "firmware/core/cycle/runner.h"
#include "firmware/core/service.h"
#include "firmware/daemon/arguments.h"
#include "firmware/daemon/calibrate_output.h"
#include "firmware/daemon/devices.h"
#include "firmware/daemon/duties.h"
#include "firmware/daemon/image_file.h"
#include "firmware/daemon/open_devices.h"
#include "firmware/daemon/report.h"
#include "firmware/daemon/settings/board_file.h"
#include "firmware/daemon/settings/board_key.h"
#include "firmware/daemon/settings/device_settings.h"
#include "hal/linux/file_slot_store.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/output_device.h"
#include "hal/linux/realtime.h"
#include "hal/linux/service_manager.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"

namespace {

using namespace vernier;

constexpr int kDone = 0, kBadInput = 1, kAnswerIsNo = 2;
constexpr int kPriority = 80;  // as cyclictest is usually run, above the kernel's threaded interrupts (50)
constexpr double kShareOfRangePerS = 0.1;
constexpr int kMostTicksToEnd = 30'000;
constexpr int kMostTicksStill = 1000;     // of outputs that refuse: one second
constexpr int kMostTicksOnTheWay = 1000;  // of the last zero to a drive that uses it at a SYNC

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

GrantReport ask_for_realtime(bool wanted, int priority) {
  if (!wanted) return {};
  const RealtimeGrant grant = become_realtime(priority);
  const auto say = [](int error, const char* what) {
    if (error != 0)
      std::fprintf(stderr, "vernierd: note: the system does not grant %s: %s\n", what, std::strerror(error));
  };
  say(grant.memory_error, "locked memory");
  say(grant.schedule_error, "SCHED_FIFO: wake-ups will be late");
  say(grant.idle_error, "shallow idle states");
  return {grant.schedule_error == 0, grant.memory_error == 0, grant.idle_error == 0};
}

int finish(const Arguments& arguments, const Runner& runner, const Cycle& cycle, const GrantReport& grant) {
  if (!report_run(runner, cycle, grant, arguments.json)) return kBadInput;
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
  return finish(arguments, runner, *cycle, grant);
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

int check_devices(Devices& devices, const BoardFile& file) {
  int missing = 0, missing_files = 0;
  const auto files = static_cast<std::size_t>(std::count_if(
      devices.findings().begin(), devices.findings().end(), [](const auto& one) { return one.is_file; }));
  for (DeviceFinding& finding : devices.findings()) {
    if (finding.missing.empty() && finding.attempt) finding.missing = finding.attempt();
    const bool there = finding.missing.empty();
    std::printf("%s  %s%s%s\n", there ? "ok     " : "missing", finding.device.c_str(), there ? "" : ": ",
                finding.missing.c_str());
    (finding.is_file ? missing_files : missing) += there ? 0 : 1;
  }
  for (const std::string& line : devices.output_budget()) std::printf("budget   %s\n", line.c_str());
  for (const AxisEntry& axis : file.axes)
    if (!axis.default_step.empty())
      std::printf("default  axis.%s: not set; a default is %s\n", axis.wiring.name.c_str(),
                  axis.default_step.c_str());
  for (const std::string& line : devices.not_looked_at()) std::printf("not looked at  %s\n", line.c_str());
  const auto total = [](std::size_t count, const char* what, int away) {
    std::printf(away == 0 ? "%zu %s: all there\n" : "%zu %s: %d missing\n", count, what, away);
  };
  if (files > 0) total(files, files == 1 ? "file" : "files", missing_files);
  total(devices.findings().size() - files, "devices", missing);
  return missing + missing_files == 0 ? kDone : kAnswerIsNo;
}

int say_left_over() {
  std::fputs(
      "vernierd: an output is not at zero: the program ended before the outputs had removed the values of an "
      "earlier run\n",
      stderr);
  return kAnswerIsNo;
}

/// Removes the corrections that an ended daemon left in the outputs, if the outputs are present.
int take_to_zero(Devices& devices) {
  if (!devices.take_left_overs_out(stop_asked)) return say_left_over();
  int missing = 0;
  for (const DeviceFinding& finding : devices.findings())
    if (finding.device.find(".output ") != std::string::npos && !finding.missing.empty()) {
      std::fprintf(stderr, "vernierd: an output is not at zero: %s: %s\n", finding.device.c_str(),
                   finding.missing.c_str());
      ++missing;
    }
  return missing == 0 ? kDone : kAnswerIsNo;
}

bool all_there(Devices& devices) {
  bool all = true;
  for (const DeviceFinding& finding : devices.findings()) {
    if (finding.missing.empty()) continue;
    std::fprintf(stderr, "vernierd: missing: %s: %s\n", finding.device.c_str(), finding.missing.c_str());
    all = false;
  }
  return all;
}

void say_image(const UploadResult& result, const Service& service, const BoardFile& file) {
  if (service.uploader().damaged())
    std::fprintf(
        stderr,
        "vernierd: a record of the images (%s/record0, record1) is damaged or missing: the image may "
        "be one that was replaced, and the correction stays deactivated; compare the fingerprint "
        "and test the medium of the store, then upload the image again or activate the correction "
        "(vernier board activate)\n",
        file.store.c_str());
  if (result.fault != UploadFault::kNone)
    std::fprintf(stderr, "vernierd: the confirmed image is not used: %s\n", describe(result).c_str());
  else if (service.uploader().record().confirmed == kNoSlot)
    std::fputs(
        "vernierd: no image is confirmed: the board corrects nothing until an image is uploaded and "
        "confirmed\n",
        stderr);
  else
    std::fprintf(stderr, "vernierd: image %016llx\n",
                 static_cast<unsigned long long>(service.uploader().record().confirmed_fingerprint));
}

void say_operator(const Service& service, const BoardFile& file) {
  const StoredPair found = service.operator_memory().found();
  if (found == StoredPair::kDamaged)
    std::fprintf(
        stderr,
        "vernierd: a stored setting of the operator (%s/record2, record3) is damaged or missing: the "
        "correction stays deactivated, and the weights may be older; test the weights and the medium "
        "of the store, then activate the correction (vernier board activate)\n",
        file.store.c_str());
  else if (found == StoredPair::kNothing && file.service.activate &&
           service.uploader().record().confirmed != kNoSlot)
    std::fputs(
        "vernierd: no setting of an operator is stored: the correction is activated (activate = true)\n",
        stderr);
  else if (service.cycle().latched() != Fault::kNone)
    std::fprintf(stderr, "vernierd: the fault %s from before the start is latched; clear it\n",
                 name_of(service.cycle().latched()));
  else if (file.service.activate && service.deactivated())
    std::fputs("vernierd: the correction was deactivated or held before the start; activate it\n", stderr);
}

/// The first deactivation must not fail because the medium became full meanwhile.
void reserve_settings(FileSlotStore& store) {
  for (std::uint32_t place = kOperatorPlace; place < kOperatorPlace + kOperatorRecordCount; ++place)
    if (store.reserve_record(place, sizeof(OperatorRecord)) != HalFault::kNone)
      std::fputs(
          "vernierd: the store has no space for the settings of an operator: a setting acts, but is not "
          "stored\n",
          stderr);
}

/// A board without a key corrects its machine as well; it only cannot prove its identity.
std::unique_ptr<BoardKey> key_of_board(const std::string& store) {
  try {
    auto key = std::make_unique<BoardKey>(store);
    std::fprintf(stderr, "vernierd: key of this board: %s\n", key->text().c_str());
    return key;
  } catch (const BoardError& error) {
    std::fprintf(stderr, "vernierd: note: this board cannot prove its identity: %s\n", error.what.c_str());
    return nullptr;
  }
}

/// Sends the last zeros until each drive has used its zero: a drive takes an offset with a SYNC only, and a
/// frame that waits for a busy CAN bus is lost with its sender.
void wait_for_last_zeros(Service& service, Devices& devices) {
  for (int tick = 0; !devices.corrections_have_arrived(); ++tick) {
    if (tick == kMostTicksOnTheWay) {
      std::fputs("vernierd: a drive did not confirm the offset zero: it may still have a correction\n",
                 stderr);
      return;
    }
    devices.advance();
    service.tick();
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
  AxisTravel before[kMaxAxes] = {};
  for (int tick = 0, still = 0; tick < kMostTicksToEnd && !out(); ++tick) {
    devices.advance();
    service.tick();
    bool moved = false;
    for (std::uint32_t axis = 0; axis < kMaxAxes; ++axis) {
      moved = moved || service.cycle().written(axis) != before[axis];
      before[axis] = service.cycle().written(axis);
    }
    still = moved ? 0 : still + 1;
    if (still < kMostTicksStill) continue;
    std::fputs("vernierd: an output refuses every value: its correction was not removed\n", stderr);
    return;
  }
  wait_for_last_zeros(service, devices);
}

std::vector<CalibrationPoint> measured_points(const Arguments& arguments, const AxisEntry& axis,
                                              std::int64_t codes) {
  if (!arguments.measured.empty()) return read_calibration_points(arguments.measured, axis.wiring.rotary);
  std::string error;
  // One count of the axis is less than a code, so that every code can be had.
  SignalSource source = axis.output;
  source.numbers["span"] = static_cast<double>(codes) * (axis.wiring.rotary ? 1e-6 : 4e-6);
  const AnalogueScale scale =
      analogue_scale(source, axis.wiring.rotary, codes, source.kind == "pwm" ? "_ns" : "");
  const auto output = output_of({{&source, axis.wiring.rotary, INT32_MAX, {}}})(error);
  if (!output) throw BoardError{std::string("axis.") + axis.wiring.name.c_str() + ".output: " + error};
  if (!output->lock())
    throw BoardError{std::string("axis.") + axis.wiring.name.c_str() + ".output: in use by another process"};
  AxisTravel held;
  const bool known = output->read_back(0, held) == HalFault::kNone;
  MonotonicClock clock;
  return calibrate_output(*output, scale, known ? scale.code_for(held) : scale.zero, arguments.steps, clock,
                          std::cin, std::cerr, stop_asked);
}

int calibrate(const Arguments& arguments, const BoardFile& file) {
  const auto axis = std::find_if(file.axes.begin(), file.axes.end(), [&](const AxisEntry& entry) {
    return entry.wiring.name == arguments.calibrate;
  });
  if (axis == file.axes.end()) throw BoardError{file.path + ": no axis " + arguments.calibrate};
  const SignalSource& source = axis->output;
  const bool pwm = source.kind == "pwm";
  if (!pwm && source.kind != "iio-dac")
    throw BoardError{file.path + ": axis." + arguments.calibrate +
                     " has no analogue output; only an analogue output can be calibrated"};
  const std::string path = source.text("calibration");
  const std::int64_t codes =
      pwm ? source.whole("period_ns", 2, 1'000'000'000) : source.whole("codes", 1, (1 << 24) - 1);
  const std::vector<CalibrationPoint> points = measured_points(arguments, *axis, codes);
  if (arguments.measured.empty() && points.size() != static_cast<std::size_t>(2 * arguments.steps - 1)) {
    std::fputs("vernierd: the calibration ended before its last point, so no file is written\n", stderr);
    return kAnswerIsNo;
  }
  const Calibration found = fit_calibration(points, codes, axis->wiring.rotary);
  write_calibration(path, found, axis->wiring.name.c_str());
  std::fprintf(arguments.json == "-" ? stderr : stdout,
               "%s: span %.6f +- %.6f %s, zero %.2f +- %.2f, residual %.3f rms\n", path.c_str(), found.span,
               found.span_std, axis->wiring.rotary ? "deg" : "mm", found.zero, found.zero_std,
               found.residual);
  return write_result(arguments.json, calibration_json(found, axis->wiring.name.c_str())) ? kDone : kBadInput;
}

int run_board(const Arguments& arguments) {
  BoardFile file = read_board_file(arguments.board);
  if (!arguments.calibrate.empty()) return calibrate(arguments, file);
  Devices devices(file, arguments.seed);
  if (arguments.check) return check_devices(devices, file);
  if (arguments.zero) return take_to_zero(devices);
  if (!all_there(devices)) return kAnswerIsNo;
  devices.sample();
  if (!devices.take_left_overs_out(stop_asked)) return say_left_over();
  const std::unique_ptr<BoardKey> own_key = key_of_board(file.store);
  FileSlotStore store(file.store, file.slot_bytes);
  reserve_settings(store);
  {
    std::vector<std::uint32_t> memory(kWordsBeyondCaches);
    file.service.upload.budget = measured_work_budget(devices.clock(), file.service.upload.tick, memory);
  }
  const auto fill = [](auto& bytes) {
    return ::getrandom(bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
  };
  if (!fill(file.service.nonce) || !fill(file.service.seed)) {
    std::fputs("vernierd: the system gives no random numbers: signed requests are not possible\n", stderr);
    return kAnswerIsNo;
  }
  Board board = devices.board();
  board.identity = own_key.get();
  const auto service = std::make_unique<Service>(file.service, board, store);
  say_image(service->boot(), *service, file);
  say_operator(*service, file);
  ServiceManager manager;
  keep_stacks_small();
  const GrantReport grant = ask_for_realtime(arguments.realtime, file.priority);
  if (const std::string missing = devices.start_watchdog(); !missing.empty()) {
    std::fprintf(stderr, "vernierd: the watchdog is missing: %s\n", missing.c_str());
    return kAnswerIsNo;
  }
  auto duties = std::make_unique<Duties>(*service, devices, manager, grant.fifo ? file.priority - 1 : 0);
  devices.release();
  if (!manager.notify("READY=1"))
    std::fputs("vernierd: note: the service manager cannot be notified\n", stderr);
  const auto ticks = static_cast<std::int64_t>(arguments.seconds * 1e6) / file.service.upload.tick.count;
  for (std::int64_t tick = 0; (ticks == 0 || tick < ticks) && !stop_asked; ++tick) {
    devices.advance();
    service->tick();
  }
  manager.notify("STOPPING=1");
  take_correction_out(*service, devices);
  devices.disarm_watchdog();
  duties = nullptr;
  devices.say_held();
  if (service->runner().lost_syncs() > 0)
    std::fprintf(stderr, "vernierd: the sync signal was lost %llu times\n",
                 static_cast<unsigned long long>(service->runner().lost_syncs()));
  return finish(arguments, service->runner(), service->cycle(), grant);
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
  if (arguments.version) {
    std::fputs(kVersion, stdout);
    return kDone;
  }
  // A medium or a peer that refuses bytes is reported by the call; the signal would end the daemon.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  // Each of these would else end the daemon and leave the corrections in the outputs.
  for (const int end : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM})
    std::signal(end, [](int) { stop_asked = true; });
  try {
    return arguments.board.empty() ? run_image(arguments) : run_board(arguments);
  } catch (const BoardError& error) {
    std::fprintf(stderr, "vernierd: %s\n", error.what.c_str());
    return kBadInput;
  }
}
