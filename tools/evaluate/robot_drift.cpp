// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/robot_drift.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "tools/text/error.h"

namespace vernier::evaluate {
namespace {

using Visits = std::vector<const PoseReading*>;

std::vector<Visits> blocks_of(const Visits& pose) {
  std::vector<Visits> blocks;
  std::map<std::string, std::size_t> place;
  for (const PoseReading* reading : pose) {
    const auto [found, fresh] = place.emplace(reading->run, blocks.size());
    if (fresh) blocks.emplace_back();
    blocks[found->second].push_back(reading);
  }
  return blocks;
}

DriftBlock block_of(const Visits& visits) {
  DriftBlock block;
  block.run = visits.front()->run;
  std::vector<PoseReading> readings;
  for (const PoseReading* reading : visits) {
    readings.push_back(*reading);
    block.time_s += reading->time_s / static_cast<double>(visits.size());
  }
  if (readings.size() < 2)
    throw text::InputError(
        fmt::format("block (run) \"{}\" has only one reading of a pose: ISO 9283 requires ten", block.run));
  block.pose = evaluate_poses(readings).front();
  return block;
}

/// Half the 95 % interval of a repeatability as a standard deviation.
double repeatability_std(const PoseResult& pose) { return (pose.high_mm - pose.low_mm) / 4; }

void compare(const DriftBlock& first, DriftBlock& block) {
  const PoseResult &then = first.pose, &now = block.pose;
  block.time_s -= first.time_s;
  if (block.time_s < 0)
    throw text::InputError(
        fmt::format("the time of block (run) \"{}\" is earlier than the time of the first block", block.run));
  block.accuracy_drift_mm = std::abs(then.accuracy_mm - now.accuracy_mm);
  block.accuracy_drift_std_mm = std::hypot(then.scatter_std_mm, now.scatter_std_mm);
  block.repeatability_drift_mm = std::abs(then.repeatability_mm - now.repeatability_mm);
  block.repeatability_drift_std_mm = std::hypot(repeatability_std(then), repeatability_std(now));
  block.shift_mm = (now.deviation_mm - then.deviation_mm).norm();
}

}  // namespace

std::vector<DriftResult> evaluate_drift(const std::vector<PoseReading>& readings) {
  std::vector<DriftResult> results;
  for (const Visits& pose : visits_by_pose(readings)) {
    DriftResult result;
    for (const Visits& visits : blocks_of(pose)) result.blocks.push_back(block_of(visits));
    if (result.blocks.size() < 2)
      throw text::InputError(
          "this pose has only one block (run): the drift is the change from the first block of cycles to a "
          "later block");
    for (std::size_t i = 1; i < result.blocks.size(); ++i) {
      compare(result.blocks.front(), result.blocks[i]);
      const auto take = [&](std::size_t& at, double DriftBlock::*value) {
        if (at == 0 || result.blocks[i].*value > result.blocks[at].*value) at = i;
      };
      take(result.accuracy_at, &DriftBlock::accuracy_drift_mm);
      take(result.repeatability_at, &DriftBlock::repeatability_drift_mm);
      take(result.shift_at, &DriftBlock::shift_mm);
    }
    result.blocks.front().time_s =
        std::isnan(result.blocks.front().time_s) ? result.blocks.front().time_s : 0;
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace vernier::evaluate
