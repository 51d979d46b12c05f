// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/registry/registry.h"

namespace vernier::registry {

/// Time at which a machine must be checked, and the reason.
struct DueMachine {
  std::string machine, verdict, why;            // verdict: of the last check; why: reason why a check is due,
                                                // or empty if no check is due
  std::optional<std::int64_t> last_us, due_us;  // last_us: no value if the machine was never checked; due_us:
                                                // no value if no checks are requested
};

/// Returns all machines; the machine whose check is most overdue is first. A check of a machine is due in
/// four cases: the time of the next check has come; no check was ever made; the last check was not
/// conclusive; or the running image was loaded after the last check.
std::vector<DueMachine> due_machines(Registry& registry, std::int64_t at_us);

}  // namespace vernier::registry
