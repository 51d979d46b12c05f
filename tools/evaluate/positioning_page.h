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

/// Texts for the report of a positioning test, in addition to the numbers.
struct PositioningWords {
  std::string axis;
  std::vector<std::string> files;
  std::vector<std::pair<std::string, std::string>> header;  // entries as the user gave them, for example
                                                            // "serial number"
  std::map<std::string, double> tolerance, uncertainty;     // by the characteristics A E M R B, in the unit
                                                            // of the axis; uncertainty: U95
};

/// Returns the characteristic with the given name: A, A+, A-, E, E+, E-, R, R+, R-, B, M, mean B. The
/// function characteristic() returns nullopt if the characteristic was not measured.
std::optional<double> characteristic(const PositioningResult& result, const std::string& name);

/// Converts an element of `characteristics` to a JudgedValue; nullopt if the element has no tolerance.
std::optional<JudgedValue> judged_of(const nlohmann::ordered_json& characteristic);

/// Returns the result as JSON: {axis, unit, factor, targets[…], characteristics[{name, value, tolerance,
/// uncertainty, conformity}], assurance, …}. The values are in um (linear axis) or arcsec (rotary axis), as
/// `unit` states.
nlohmann::ordered_json positioning_json(const PositioningResult& result, const PositioningFile& file,
                                        const PositioningWords& words);

/// Returns the data of the report of a positioning test, for improvement_report_html.
nlohmann::ordered_json positioning_page(const nlohmann::ordered_json& json, const PositioningWords& words);

}  // namespace vernier::evaluate
