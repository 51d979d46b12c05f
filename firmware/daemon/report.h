// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "firmware/core/cycle/runner.h"

namespace vernier {

/// Realtime settings that the operating system granted to the program, for the report.
struct GrantReport {
  bool fifo = false, locked = false, awake = false;
};

/// Writes the result of a run for people (to standard output, or to standard error if json is "-") and for
/// programs (json: a file, "-" or empty). Returns false if the file cannot be written.
bool report_run(const Runner& runner, const Cycle& cycle, const GrantReport& grant, const std::string& json);

/// Writes a result for programs. `json` is the name of a file, "-" for standard output, or empty for no
/// output. Returns false, with a message on standard error, if the result cannot be written.
bool write_result(const std::string& json, const std::string& text);

}  // namespace vernier
