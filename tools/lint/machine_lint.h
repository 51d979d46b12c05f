// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/lint/finding.h"
#include "tools/model/machine.h"

namespace vernier::lint {

struct MachineLint {
  std::vector<LintFinding> findings;
  std::optional<model::Machine> machine;  // the machine, if the file has no error
};

/// Reads a machine file to its end, also if it contains errors: a wrong word is removed, and the rest is read
/// again. After it has read the machine file to its end, lint_machine reports entries that are valid but
/// doubtful. Examples are a unit that is unknown or does not scale, an axis, static, input or table that no
/// transform uses, and a missing range or nominal.
MachineLint lint_machine(const std::string& text, const std::string& file);

}  // namespace vernier::lint
