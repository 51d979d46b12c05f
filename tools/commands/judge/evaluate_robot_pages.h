// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/evaluate/robot_distance.h"
#include "tools/evaluate/robot_drift.h"

namespace vernier::commands::evaluate_cli {

/// The largest value of a characteristic, and its one-sided expanded uncertainty (95 %).
struct Judged {
  std::string name;
  double value_mm = 0, expanded_mm = 0;
};

/// Results of one kind of robot test.
struct RobotPage {
  std::vector<Judged> characteristics;
  std::string key;              // key of the list in the JSON result
  nlohmann::ordered_json list;  // one element for each pose, station or distance
  std::vector<std::string> lines;
  std::size_t fewest = 0, wanted = 0;  // number of measured cycles, and number that the standard requires
  double least_spread_mm = 0;          // smallest repeatability
};

RobotPage pose_page(const std::vector<evaluate::PoseResult>& poses, bool path);
RobotPage distance_page(const std::vector<evaluate::DistanceResult>& distances);
RobotPage drift_page(const std::vector<evaluate::DriftResult>& drifts);

}  // namespace vernier::commands::evaluate_cli
