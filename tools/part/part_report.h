// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tools/part/identify.h"
#include "tools/part/measured_part.h"
#include "tools/part/part_json.h"
#include "tools/part/part_path.h"

namespace vernier::part {

/// What improvement_report_html() draws: `result` is part_json() of the same job.
nlohmann::ordered_json part_report(const PartJob& job, const nlohmann::ordered_json& result);

/// "EA0Z and EA0C; EB0Z and EB0C" of a list of lists of names; "none" of an empty one.
std::string joined_groups(const nlohmann::ordered_json& groups);

}  // namespace vernier::part
