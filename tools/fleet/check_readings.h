// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/evidence_of_change.h"
#include "tools/registry/registry.h"

namespace vernier::fleet {

/// Reads the output of `vernier check --json`, without machine and time. Throws InputError.
registry::FleetCheck parse_check(const std::string& json, const std::string& file);

/// Returns the result of one check for each tested parameter of a machine. A result is the change that
/// explains the readings best if only this parameter changed, with its standard uncertainty. Parameters of
/// the instrument, and parameters on which the readings of the check do not depend, are excluded.
std::vector<registry::FleetReading> readings_of(const check::CheckRecord& record, const std::string& machine,
                                                std::int64_t at_us);

}  // namespace vernier::fleet
