// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/commands/judge/evaluate_robot_pages.h"
#include "tools/maths/factors.h"

namespace vernier::commands::evaluate_cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kUm = maths::kUmPerMm;

Json vector_json(const Eigen::Vector3d& v, double unit) { return {v[0] * unit, v[1] * unit, v[2] * unit}; }

std::string place_text(const Eigen::Vector3d& at) {
  return fmt::format("{:>9.3f} {:>9.3f} {:>9.3f} mm", at[0], at[1], at[2]);
}

Json pose_json(const evaluate::PoseResult& pose, const std::string& ap, const std::string& rp) {
  Json json = {{"commanded_mm", vector_json(pose.commanded_mm, 1)},
               {"n", pose.count},
               {ap + "_um", pose.accuracy_mm * kUm},
               {ap + "_xyz_um", vector_json(pose.deviation_mm, kUm)},
               {ap + "_u95_um", 2 * pose.accuracy_std_mm * kUm},
               {rp + "_um", pose.repeatability_mm * kUm},
               {rp + "_interval_um", {pose.low_mm * kUm, pose.high_mm * kUm}},
               {"mean_distance_um", pose.mean_distance_mm * kUm},
               {"S_um", pose.distance_spread_mm * kUm},
               {"degrees_of_freedom", pose.freedom}};
  if (pose.accuracy_deg) json[ap + "_abc_deg"] = vector_json(*pose.accuracy_deg, 1);
  if (pose.repeatability_deg) json[rp + "_abc_deg"] = vector_json(*pose.repeatability_deg, 1);
  return json;
}

std::string pose_line(const evaluate::PoseResult& pose, const std::string& ap, const std::string& rp) {
  return fmt::format("  {} {:>4} readings  {} {:.2f} um, U {:.2g}  {} {:.2f} um ({:.2f} to {:.2f})",
                     place_text(pose.commanded_mm), pose.count, ap, pose.accuracy_mm * kUm,
                     2 * pose.accuracy_std_mm * kUm, rp, pose.repeatability_mm * kUm, pose.low_mm * kUm,
                     pose.high_mm * kUm);
}

/// Keeps the largest value.
void take(Judged& judged, double value_mm, double expanded_mm) {
  if (value_mm >= judged.value_mm) judged.value_mm = value_mm, judged.expanded_mm = expanded_mm;
}

Json block_json(const evaluate::DriftBlock& block) {
  return {{"run", block.run},
          {"t_s", std::isnan(block.time_s) ? Json(nullptr) : Json(block.time_s)},
          {"n", block.pose.count},
          {"AP_um", block.pose.accuracy_mm * kUm},
          {"RP_um", block.pose.repeatability_mm * kUm},
          {"dAP_um", block.accuracy_drift_mm * kUm},
          {"dAP_u95_um", 2 * block.accuracy_drift_std_mm * kUm},
          {"dRP_um", block.repeatability_drift_mm * kUm},
          {"dRP_u95_um", 2 * block.repeatability_drift_std_mm * kUm},
          {"shift_um", block.shift_mm * kUm}};
}

}  // namespace

RobotPage pose_page(const std::vector<evaluate::PoseResult>& poses, bool path) {
  const std::string ap = path ? "AT" : "AP", rp = path ? "RT" : "RP";
  RobotPage page{{{ap}, {rp}}, path ? "stations" : "poses", Json::array(), {}, SIZE_MAX, path ? 10u : 30u,
                 HUGE_VAL};
  for (const evaluate::PoseResult& pose : poses) {
    take(page.characteristics[0], pose.accuracy_mm, 2 * pose.accuracy_std_mm);
    take(page.characteristics[1], pose.repeatability_mm, pose.high_mm - pose.repeatability_mm);
    page.list.push_back(pose_json(pose, ap, rp));
    if (!path) page.lines.push_back(pose_line(pose, ap, rp));
    page.fewest = std::min(page.fewest, pose.count);
    page.least_spread_mm = std::min(page.least_spread_mm, pose.repeatability_mm);
  }
  return page;
}

RobotPage distance_page(const std::vector<evaluate::DistanceResult>& distances) {
  RobotPage page{{{"AD"}, {"RD"}}, "distances", Json::array(), {}, SIZE_MAX, 30, HUGE_VAL};
  for (const evaluate::DistanceResult& one : distances) {
    take(page.characteristics[0], std::abs(one.accuracy_mm), 2 * one.accuracy_std_mm);
    take(page.characteristics[1], one.repeatability_mm, one.high_mm - one.repeatability_mm);
    page.list.push_back({{"from_mm", vector_json(one.from_mm, 1)},
                         {"to_mm", vector_json(one.to_mm, 1)},
                         {"n", one.count},
                         {"commanded_mm", one.commanded_mm},
                         {"AD_um", one.accuracy_mm * kUm},
                         {"AD_xyz_um", vector_json(one.accuracy_xyz_mm, kUm)},
                         {"AD_u95_um", 2 * one.accuracy_std_mm * kUm},
                         {"RD_um", one.repeatability_mm * kUm},
                         {"RD_xyz_um", vector_json(one.repeatability_xyz_mm, kUm)},
                         {"RD_interval_um", {one.low_mm * kUm, one.high_mm * kUm}}});
    page.lines.push_back(fmt::format(
        "  {} -> {}: {:.3f} mm {:>4} times  AD {:+.2f} um, U {:.2g}  RD {:.2f} um ({:.2f} to {:.2f})",
        place_text(one.from_mm), place_text(one.to_mm), one.commanded_mm, one.count, one.accuracy_mm * kUm,
        2 * one.accuracy_std_mm * kUm, one.repeatability_mm * kUm, one.low_mm * kUm, one.high_mm * kUm));
    page.fewest = std::min(page.fewest, one.count);
    page.least_spread_mm = std::min(page.least_spread_mm, one.repeatability_mm);
  }
  return page;
}

RobotPage drift_page(const std::vector<evaluate::DriftResult>& drifts) {
  RobotPage page{{{"dAP"}, {"dRP"}}, "poses", Json::array(), {}, SIZE_MAX, 10, HUGE_VAL};
  for (const evaluate::DriftResult& drift : drifts) {
    const evaluate::DriftBlock &accuracy = drift.blocks[drift.accuracy_at],
                               &repeatability = drift.blocks[drift.repeatability_at],
                               &shift = drift.blocks[drift.shift_at];
    take(page.characteristics[0], accuracy.accuracy_drift_mm, 2 * accuracy.accuracy_drift_std_mm);
    take(page.characteristics[1], repeatability.repeatability_drift_mm,
         2 * repeatability.repeatability_drift_std_mm);
    Json json = {{"commanded_mm", vector_json(accuracy.pose.commanded_mm, 1)},
                 {"dAP_um", accuracy.accuracy_drift_mm * kUm},
                 {"dRP_um", repeatability.repeatability_drift_mm * kUm},
                 {"shift_um", shift.shift_mm * kUm},
                 {"blocks", Json::array()}};
    page.lines.push_back(fmt::format(
        "  {} dAP {:.2f} um in \"{}\", dRP {:.2f} um in \"{}\", shift {:.2f} um in \"{}\"",
        place_text(accuracy.pose.commanded_mm), accuracy.accuracy_drift_mm * kUm, accuracy.run,
        repeatability.repeatability_drift_mm * kUm, repeatability.run, shift.shift_mm * kUm, shift.run));
    for (const evaluate::DriftBlock& block : drift.blocks) {
      json["blocks"].push_back(block_json(block));
      page.fewest = std::min(page.fewest, block.pose.count);
      page.least_spread_mm = std::min(page.least_spread_mm, block.pose.repeatability_mm);
    }
    page.list.push_back(std::move(json));
  }
  return page;
}

}  // namespace vernier::commands::evaluate_cli
