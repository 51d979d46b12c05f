// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/evidence_of_change.h"

namespace vernier::check {

/// All checks of one machine, as stored in a file (JSON).
struct CheckHistory {
  std::string machine;  // name and parameters of the fit that they were made against
  std::vector<CheckRecord> checks;
};

/// What `machine` of a history must be for a fitted machine: other numbers make another history.
std::string identity_of(const model::Machine& machine);

/// Converts to the text of the file, and back. A file of version 1 has no usable record and is read as the
/// file of no machine. Throws InputError with the file and the error in it. tool.
std::string history_text(const CheckHistory& history);
CheckHistory parse_history(const std::string& text, const std::string& file);

}  // namespace vernier::check
