// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/evidence_of_change.h"
#include "tools/registry/registry.h"

namespace vernier::fleet {

/// Reads the JSON result of `vernier check`, which does not contain the machine and the time. Throws
/// InputError if the JSON is not a result of `vernier check`.
registry::FleetCheck parse_check(const std::string& json, const std::string& file);

/// Returns the results of one check of a machine, one result for each tested parameter. A result is the
/// change of the parameter that explains the readings best if only this parameter changed, with its standard
/// uncertainty. Parameters of the instrument, and parameters on which the readings of the check do not
/// depend, are excluded.
std::vector<registry::FleetReading> readings_of(const check::CheckRecord& record, const std::string& machine,
                                                std::int64_t at_us);

}  // namespace vernier::fleet
