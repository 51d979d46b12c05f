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
  std::optional<model::Machine> machine;  // where nothing is an error
};

/// Reads a machine file to its end, past what is wrong with it (a broken word is taken out and the rest read
/// again), then looks for what is right in form and odd in meaning: a unit that nobody knows or that does not
/// scale, an axis, static, input or table that no transform uses, a missing range or nominal. tool.
MachineLint lint_machine(const std::string& text, const std::string& file);

}  // namespace vernier::lint
