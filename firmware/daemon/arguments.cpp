// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/arguments.h"

#include <getopt.h>

#include <cstdlib>

namespace vernier {
namespace {

bool parse_value(const char* text, double low, double high, double& value) {
  char* end = nullptr;
  value = std::strtod(text, &end);
  return end != text && *end == '\0' && value >= low && value <= high;
}

}  // namespace

const char* const kUsage =
    "usage: vernierd --board FILE [--check | --zero] [--seconds S] [--no-realtime] [--json FILE]\n"
    "       vernierd --board FILE --calibrate AXIS [--steps N | --measured CSV] [--json FILE]\n"
    "       vernierd --image DIR --simulate [--seconds S] [--seed N] [--no-realtime] [--json FILE]\n"
    "Runs the 1 kHz compensation cycle.\n"
    "  --board FILE    the board: its axes, sensors, outputs, links and store (tools/docs/board.md)\n"
    "  --check         test every file and every device that the board file names, list what is missing\n"
    "                  and what was not tested, and end\n"
    "  --zero          remove the corrections that an ended daemon left in the outputs, within the limits, "
    "and end\n"
    "  --calibrate AXIS  move the output of an axis through its range in steps, ask for the measured value "
    "at\n"
    "                  each code, and store gain and zero in the calibration file of the output\n"
    "  --steps N       number of codes from low to high, 2 to 1000 (default 11); then the same codes back\n"
    "  --measured CSV  read the points from a file (code,measured[um]); no axis moves\n"
    "  --image DIR     without a board file: run the image in this directory, which `vernier compile` wrote\n"
    "  --simulate      with --image: simulate the machine in real time; every axis moves through its range\n"
    "  --seconds S     stop after S seconds (default: never with --board, 10 with --simulate)\n"
    "  --seed N        seed of the simulated motion (default 1)\n"
    "  --no-realtime   do not ask for SCHED_FIFO, locked memory and shallow idle states\n"
    "  --json FILE     result as JSON, for programs; - is standard output\n"
    "  -V, --version   print the version and end\n"
    "Exit status: 0 done, 1 bad input or usage, 2 a fault latched, a device is missing or a limit was not "
    "met.\n";

const char* const kVersion = "vernierd " VERNIER_VERSION " (" VERNIER_COMMIT ")\n";

bool parse_arguments(int argc, char** argv, Arguments& arguments) {
  const option kOptions[] = {{"image", required_argument, nullptr, 'i'},
                             {"simulate", no_argument, nullptr, 's'},
                             {"seconds", required_argument, nullptr, 't'},
                             {"seed", required_argument, nullptr, 'r'},
                             {"no-realtime", no_argument, nullptr, 'n'},
                             {"json", required_argument, nullptr, 'j'},
                             {"board", required_argument, nullptr, 'b'},
                             {"check", no_argument, nullptr, 'c'},
                             {"calibrate", required_argument, nullptr, 'a'},
                             {"measured", required_argument, nullptr, 'm'},
                             {"steps", required_argument, nullptr, 'p'},
                             {"zero", no_argument, nullptr, 'z'},
                             {"help", no_argument, nullptr, 'h'},
                             {"version", no_argument, nullptr, 'V'},
                             {nullptr, 0, nullptr, 0}};
  double number = 0;
  for (int c = 0; (c = getopt_long(argc, argv, "hV", kOptions, nullptr)) != -1;) {
    if (c == 'i') arguments.image = optarg;
    if (c == 's') arguments.simulate = true;
    if (c == 'n') arguments.realtime = false;
    if (c == 'j') arguments.json = optarg;
    if (c == 'b') arguments.board = optarg;
    if (c == 'c') arguments.check = true;
    if (c == 'z') arguments.zero = true;
    if (c == 'a') arguments.calibrate = optarg;
    if (c == 'm') arguments.measured = optarg;
    if (c == 'p' && !parse_value(optarg, 2, 1000, number)) return false;
    if (c == 'p') arguments.steps = static_cast<int>(number);
    if (c == 't' && !parse_value(optarg, 0.1, 1e9, arguments.seconds)) return false;
    if (c == 'r' && !parse_value(optarg, 0, 1e15, number)) return false;
    if (c == 'r') arguments.seed = static_cast<unsigned long>(number);
    if (c == 'h') return arguments.help = true;
    if (c == 'V') return arguments.version = true;
    if (c == '?') return false;
  }
  if (!arguments.calibrate.empty() && arguments.board.empty()) return false;
  if (!arguments.measured.empty() && arguments.calibrate.empty()) return false;
  return optind == argc && arguments.image.empty() != arguments.board.empty();
}

}  // namespace vernier
