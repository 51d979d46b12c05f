// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/evidence_of_change.h"

namespace vernier::check {

/// All checks of one machine, in the form of the history file (JSON).
struct CheckHistory {
  std::string machine;  // identity of the fitted machine: name, and parameters of the fit
  std::vector<CheckRecord> checks;
};

/// Returns the identity of a fitted machine. If the fitted values change, a new history is necessary.
std::string identity_of(const model::Machine& machine);

/// Convert a history to the text of its file, and the text of a file to a history. A file of version 1
/// contains no usable record. A history file of version 1 is read as a history without a machine. Throws
/// InputError with the name of the file and the error in the file.
std::string history_text(const CheckHistory& history);
CheckHistory parse_history(const std::string& text, const std::string& file);

}  // namespace vernier::check
