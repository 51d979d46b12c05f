// SPDX-License-Identifier: Apache-2.0
// vernierd: the composition root, the only file of the firmware that names a backend.
#include <getopt.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "firmware/image_file.h"
#include "firmware/runner.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/realtime.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"

namespace {

using namespace vernier;

constexpr int kDone = 0, kBadInput = 1, kAnswerIsNo = 2;
constexpr int kPriority = 80;  // as cyclictest is usually run, above the kernel's threaded interrupts (50)
constexpr double kShareOfRangePerS = 0.1;

struct Arguments {
  std::string image, json;
  double seconds = 10;
  unsigned long seed = 1;
  bool simulate = false, realtime = true;
};

constexpr const char* kUsage =
    "usage: vernierd --image DIR --simulate [--seconds S] [--seed N] [--no-realtime] [--json FILE]\n"
    "Runs the 1 kHz compensation cycle with the image DIR/machine.vimg.\n"
    "  --image DIR     directory that `vernier compile` wrote\n"
    "  --simulate      on the simulated machine, in real time: every axis roams through its range.\n"
    "                  This is the only backend so far; without it vernierd refuses to run.\n"
    "  --seconds S     stop after S seconds (default 10)\n"
    "  --seed N        seed of the simulated motion (default 1)\n"
    "  --no-realtime   do not ask for SCHED_FIFO, locked memory and shallow idle states\n"
    "  --json FILE     result for programs; - is standard output\n"
    "Exit status: 0 done, 1 bad input or usage, 2 a fault latched or a limit was not met.\n";

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
      {"help", no_argument, nullptr, 'h'},          {nullptr, 0, nullptr, 0}};
  double number = 0;
  for (int c = 0; (c = getopt_long(argc, argv, "h", kOptions, nullptr)) != -1;) {
    if (c == 'i') arguments.image = optarg;
    if (c == 's') arguments.simulate = true;
    if (c == 'n') arguments.realtime = false;
    if (c == 'j') arguments.json = optarg;
    if (c == 't' && !parse_value(optarg, 0.5, 1e7, arguments.seconds)) return false;
    if (c == 'r' && !parse_value(optarg, 0, 1e15, number)) return false;
    if (c == 'r') arguments.seed = static_cast<unsigned long>(number);
    if (c == 'h') std::fputs(kUsage, stdout), std::exit(kDone);
    if (c == '?') return false;
  }
  return optind == argc && !arguments.image.empty();
}

void say_what_was_refused(const RealtimeGrant& grant) {
  const auto say = [](int error, const char* what) {
    if (error != 0) std::fprintf(stderr, "vernierd: note: no %s: %s\n", what, std::strerror(error));
  };
  say(grant.memory_error, "locked memory");
  say(grant.schedule_error, "SCHED_FIFO: wake-ups will be late");
  say(grant.idle_error, "shallow idle states");
}

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

void print_histogram(std::FILE* out, const char* name, const Histogram& h) {
  std::fprintf(out, "%-22s p50 %7.2f  p99 %7.2f  p99.9 %7.2f  max %9.2f us\n", name,
               us(h.percentile_ns(500000)), us(h.percentile_ns(990000)), us(h.percentile_ns(999000)),
               us(h.max_ns()));
}

void print_json(std::FILE* out, const Histogram& h) {
  std::fprintf(out, "{\"p50\": %.3f, \"p99\": %.3f, \"p999\": %.3f, \"max\": %.3f, \"count\": %llu}",
               us(h.percentile_ns(500000)), us(h.percentile_ns(990000)), us(h.percentile_ns(999000)),
               us(h.max_ns()), static_cast<unsigned long long>(h.count()));
}

struct Counter {
  const char* name;
  std::uint64_t value;
};

void print_result(std::FILE* out, const Cycle& cycle, const RealtimeGrant& grant, bool realtime) {
  const Health& h = cycle.health();
  std::fprintf(out, "{\n \"mode\": \"%s\",\n \"fault\": \"%s\",\n", name_of(cycle.mode()),
               name_of(cycle.latched()));
  const Counter counters[] = {{"ticks", h.ticks},
                              {"active_ticks", h.active_ticks},
                              {"overruns", h.overruns},
                              {"skipped", h.skipped},
                              {"missing_readings", h.missing_readings},
                              {"missing_inputs", h.missing_inputs},
                              {"failed_writes", h.failed_writes},
                              {"saturated", h.saturated},
                              {"slewing", h.slewing},
                              {"beyond_range", h.beyond_range},
                              {"faults", h.faults}};
  for (const Counter& counter : counters)
    std::fprintf(out, " \"%s\": %llu,\n", counter.name, static_cast<unsigned long long>(counter.value));
  std::fprintf(out, " \"realtime\": {\"fifo\": %s, \"locked\": %s, \"awake\": %s},\n",
               realtime && grant.schedule_error == 0 ? "true" : "false",
               realtime && grant.memory_error == 0 ? "true" : "false",
               realtime && grant.idle_error == 0 ? "true" : "false");
  std::fputs(" \"latency_us\": ", out);
  print_json(out, h.latency);
  std::fputs(",\n \"execution_us\": ", out);
  print_json(out, h.execution);
  std::fputs("\n}\n", out);
}

int write_result(const Arguments& arguments, const Cycle& cycle, const RealtimeGrant& grant) {
  const Health& health = cycle.health();
  std::FILE* const people = arguments.json == "-" ? stderr : stdout;
  std::fprintf(
      people, "%llu ticks, %llu overruns, mode %s, fault %s\n", static_cast<unsigned long long>(health.ticks),
      static_cast<unsigned long long>(health.overruns), name_of(cycle.mode()), name_of(cycle.latched()));
  print_histogram(people, "wake-up latency", health.latency);
  print_histogram(people, "execution of a tick", health.execution);
  if (arguments.json == "-") print_result(stdout, cycle, grant, arguments.realtime);
  if (!arguments.json.empty() && arguments.json != "-") {
    std::FILE* const file = std::fopen(arguments.json.c_str(), "w");
    if (file == nullptr) {
      std::fprintf(stderr, "vernierd: %s: %s\n", arguments.json.c_str(), std::strerror(errno));
      return kBadInput;
    }
    print_result(file, cycle, grant, arguments.realtime);
    if (std::fclose(file) != 0) return kBadInput;
  }
  return cycle.latched() == Fault::kNone ? kDone : kAnswerIsNo;
}

Roaming motion_in(const ImageView& image, unsigned long seed) {
  std::vector<RoamingAxis> axes;
  std::vector<InputMicro> inputs;
  for (const AxisRecord& axis : image.axes()) axes.push_back({axis.low, axis.high});
  for (const InputRecord& input : image.inputs()) inputs.emplace_back(input.reference);
  return Roaming(axes, inputs, TimeUs(image.header().tick_us), kShareOfRangePerS, seed);
}

int run(const Arguments& arguments, const ImageView& image) {
  MonotonicClock clock;
  Roaming motion = motion_in(image, arguments.seed);
  const auto plant = std::make_unique<SimPlant>(motion, image.axes().size, image.inputs().size,
                                                PlantOptions{.seed = arguments.seed, .faults = {}});
  const Board board{clock, *plant, *plant, *plant};
  const auto cycle = std::make_unique<Cycle>(image, board);
  RealtimeGrant grant;
  if (arguments.realtime) {
    grant = become_realtime(kPriority);
    say_what_was_refused(grant);
  }
  plant->release();
  const TimeUs period(image.header().tick_us);
  const auto ticks = static_cast<std::int64_t>(arguments.seconds * 1e6) / period.count;
  Runner runner(*cycle, clock, period);
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    plant->advance();
    const bool ready = cycle->mode() == Mode::kReady && cycle->weight() == WeightQ16{};
    runner.step(ready ? Command::kActivate : Command::kNone);
  }
  return write_result(arguments, *cycle, grant);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) {
    std::fputs(kUsage, stderr);
    return kBadInput;
  }
  if (!arguments.simulate) {
    std::fputs("vernierd: no backend but --simulate exists so far\n", stderr);
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
  return run(arguments, image->view());
}
