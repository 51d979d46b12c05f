// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// The arguments of the vernierd call.
struct Arguments {
  std::string image, board, json, calibrate, measured;
  int steps = 11;
  double seconds = 0;
  unsigned long seed = 1;
  bool simulate = false, realtime = true, check = false, zero = false, help = false, version = false;
};

extern const char* const kUsage;
/// "vernierd 0.1.0 (commit)".
extern const char* const kVersion;

/// False: not understood; kUsage is the help text. Not real-time safe.
bool parse_arguments(int argc, char** argv, Arguments& arguments);

}  // namespace vernier
