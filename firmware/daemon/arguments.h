// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Command line arguments of the program vernierd.
struct Arguments {
  std::string image, board, json, calibrate, measured;
  int steps = 11;
  double seconds = 0;
  unsigned long seed = 1;
  bool simulate = false, realtime = true, check = false, zero = false, help = false, version = false;
};

extern const char* const kUsage;
/// Text with the name and version of the program: "vernierd 0.1.0 (commit)".
extern const char* const kVersion;

/// Reads the command line arguments. Returns false if the command line arguments of vernierd are
/// not valid; kUsage is the help text. Not real-time safe.
bool parse_arguments(int argc, char** argv, Arguments& arguments);

}  // namespace vernier
