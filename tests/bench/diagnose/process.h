// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::bench {

struct ProcessResult {
  int status = 0;  // exit status; 128 + signal where one ended it
  std::string output;
  double seconds = 0;
};

/// Runs a program and waits for it; standard output is returned, standard error goes to `error_file`.
/// Throws std::runtime_error where it cannot be started.
ProcessResult run_process(const std::vector<std::string>& arguments, const std::string& error_file);

}  // namespace vernier::bench
