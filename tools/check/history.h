// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/evidence_of_change.h"

namespace vernier::check {

/// The checks of one machine so far, as they are kept in a file (JSON).
struct CheckHistory {
  std::string machine;  // name and parameters of the fit that they were made against
  std::vector<CheckRecord> checks;
};

/// What `machine` of a history must be for a fitted machine: other numbers make another history.
std::string identity_of(const model::Machine& machine);

/// The file as text, and back; a file of version 1 has no record that can be used and reads as one of no
/// machine. Throws InputError naming the file and what is wrong in it. tool.
std::string history_text(const CheckHistory& history);
CheckHistory parse_history(const std::string& text, const std::string& file);

}  // namespace vernier::check
