// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/evidence_of_change.h"

namespace vernier::check {

/// All checks of one machine, as a file (JSON) stores them.
struct CheckHistory {
  std::string machine;  // name and parameters of the fit that they were made against
  std::vector<CheckRecord> checks;
};

/// Returns the identity of a fitted machine for a history: other fitted numbers need a new history.
std::string identity_of(const model::Machine& machine);

/// Converts a history to the text of its file, and back. A file of version 1 has no usable record and is read
/// as the file of no machine. Throws InputError with the file and the error in the file.
std::string history_text(const CheckHistory& history);
CheckHistory parse_history(const std::string& text, const std::string& file);

}  // namespace vernier::check
