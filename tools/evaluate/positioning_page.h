// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/evaluate/judgement.h"
#include "tools/evaluate/positioning.h"

namespace vernier::evaluate {

/// Texts of a report for a customer, in addition to the numbers.
struct PositioningWords {
  std::string axis;
  std::vector<std::string> files;
  std::vector<std::pair<std::string, std::string>> header;  // "serial number" and the like, as given
  std::map<std::string, double> tolerance, uncertainty;     // by A E M R B, in the unit of the axis; U95
};

/// The characteristic of that letter: A, A+, A-, E, E+, E-, R, R+, R-, B, M, mean B. `nullopt` if not
/// measured.
std::optional<double> characteristic(const PositioningResult& result, const std::string& name);

/// Converts an entry of `characteristics` to a judgement; `nullopt` if the entry has no tolerance.
std::optional<JudgedValue> judged_of(const nlohmann::ordered_json& characteristic);

/// {axis, unit, factor, targets[…], characteristics[{name, value, tolerance, uncertainty, conformity}],
/// assurance, …}; values in um (linear) or arcsec (rotary), as `unit` states.
nlohmann::ordered_json positioning_json(const PositioningResult& result, const PositioningFile& file,
                                        const PositioningWords& words);

/// Returns the report page of a positioning test, for improvement_report_html.
nlohmann::ordered_json positioning_page(const nlohmann::ordered_json& json, const PositioningWords& words);

}  // namespace vernier::evaluate
