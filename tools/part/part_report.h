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

/// Returns the data for the HTML report improvement_report_html(). `result`: the JSON of part_json() for the
/// same job.
nlohmann::ordered_json part_report(const PartJob& job, const nlohmann::ordered_json& result);

/// Returns a list of name lists as text: "EA0Z and EA0C; EB0Z and EB0C"; "none" if the list is empty.
std::string joined_groups(const nlohmann::ordered_json& groups);

}  // namespace vernier::part
