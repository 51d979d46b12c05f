// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/evidence_of_change.h"
#include "tools/registry/registry.h"

namespace vernier::fleet {

/// What `vernier check --json` wrote, without machine and time. Throws InputError. tool.
registry::FleetCheck parse_check(const std::string& json, const std::string& file);

/// What one check reads of each suspect of a machine: the change that explains it best, each as if it alone
/// had changed, with its standard uncertainty; suspects of the instrument and those that it does not see are
/// left out. tool.
std::vector<registry::FleetReading> readings_of(const check::CheckRecord& record, const std::string& machine,
                                                std::int64_t at_us);

}  // namespace vernier::fleet
