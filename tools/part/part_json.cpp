// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/part_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/maths/factors.h"
#include "tools/part/envelope.h"
#include "tools/part/surface/s_part.h"

namespace vernier::part {
namespace {

using nlohmann::ordered_json;

constexpr std::array<double, 4> kOvercutHeightsMm = {0, kMeasuredHeightsMm[0], kMeasuredHeightsMm[1],
                                                     kPartHeightMm};
constexpr std::size_t kAlongFlank = 521;  // every knot and 39 points between

ordered_json worst_json(const Worst& worst) { return {{"mm", worst.value_mm}, {"u", worst.u}}; }

ordered_json curves_json() {
  ordered_json list = ordered_json::array();
  for (const RuledSurface& flank : s_part())
    for (const auto& [where, curve] : {std::pair{"bottom", &flank.bottom}, std::pair{"top", &flank.top}})
      list.push_back({{"flank", std::string(1, flank.name)},
                      {"curve", where},
                      {"length_mm", curve->length_mm()},
                      {"per_span_mm", curve->length_mm() / static_cast<double>(curve->spans())}});
  return list;
}

/// The printed formula as printed and with N normalised, and the distance to the surface.
ordered_json overcut_json(const Cutter& cutter) {
  ordered_json list = ordered_json::array();
  for (const RuledSurface& flank : s_part()) {
    ordered_json distances = ordered_json::array();
    for (const double z_mm : kOvercutHeightsMm) {
      ordered_json entry = worst_json(worst_distance(flank, cutter, z_mm / kPartHeightMm));
      entry["z_mm"] = z_mm;
      distances.push_back(entry);
    }
    list.push_back({{"flank", std::string(1, flank.name)},
                    {"formula_as_printed", worst_json(worst_formula(flank, cutter, 0, {false, true}))},
                    {"formula_unit_normal", worst_json(worst_formula(flank, cutter, 0, {true, true}))},
                    {"formula_inward_normal", worst_json(worst_formula(flank, cutter, 0, {false, false}))},
                    {"distance", distances}});
  }
  return list;
}

ordered_json path_json(const BHeadMachine& machine, const PartPath& path) {
  ordered_json ranges = ordered_json::object();
  const auto range = [&](const char* name, double JointPose::*member) {
    const auto [low, high] =
        std::minmax_element(path.joints.begin(), path.joints.end(),
                            [&](const JointPose& a, const JointPose& b) { return a.*member < b.*member; });
    ranges[name] = {(*low).*member, (*high).*member};
  };
  range("X", &JointPose::x_mm);
  range("Y", &JointPose::y_mm);
  range("Z", &JointPose::z_mm);
  range("B", &JointPose::b_deg);
  range("C", &JointPose::c_deg);
  return {{"flank", std::string(1, s_part()[path.flank].name)},
          {"poses", path.u.size()},
          {"duration_s", path.t_s.back()},
          {"step_mm", path.step_mm},
          {"chord_error_um", maths::kUmPerMm * path.chord_error_mm},
          {"axes", ranges},
          {"beyond_limits", beyond_limits(machine, path)}};
}

/// Range of the defect along a flank, by the paper's reading (tool tip).
ordered_json tip_range_json(const PartJob& job, std::size_t flank) {
  std::vector<PartPoint> points;
  for (std::size_t i = 0; i < kAlongFlank; ++i)
    points.push_back({flank, static_cast<double>(i) / (kAlongFlank - 1), 0});
  DefectOptions options = job.options;
  options.reading = DefectReading::kTip;
  const PartDefect defect = part_defect(job.machine, points, options);
  return {{"flank", std::string(1, s_part()[flank].name)},
          {"min_mm", defect.defect_mm.minCoeff()},
          {"max_mm", defect.defect_mm.maxCoeff()}};
}

ordered_json defect_json(const PartJob& job) {
  const Eigen::VectorXd& mm = job.defect.defect_mm;
  return {{"reading", reading_name(job.options.reading)},
          {"points", mm.size()},
          {"min_mm", mm.minCoeff()},
          {"max_mm", mm.maxCoeff()},
          {"rms_um", maths::kUmPerMm * std::sqrt(mm.squaredNorm() / static_cast<double>(mm.size()))},
          {"tip_along_flank", {tip_range_json(job, 0), tip_range_json(job, 1)}}};
}

std::vector<std::string> free_names(const model::Machine& machine) {
  std::vector<std::string> names;
  for (const model::Static& item : machine.statics)
    if (!item.hidden) names.push_back(item.name);
  return names;
}

ordered_json groups_json(const fit::Observability& seen, const std::vector<std::string>& names) {
  ordered_json list = ordered_json::array();
  for (const auto& group : seen.unidentifiable) {
    ordered_json entry = ordered_json::array();
    for (const std::size_t index : group) entry.push_back(names[index]);
    list.push_back(entry);
  }
  return list;
}

ordered_json observability_json(const PartJob& job, DefectReading reading) {
  DefectOptions options = job.options;
  options.reading = reading;
  const fit::Observability seen = part_observability(job.machine, job.points, options);
  const std::vector<std::string> names = free_names(job.machine.machine);
  ordered_json per_um = ordered_json::object();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const bool known = seen.determined[i] != 0;
    per_um[names[i]] =
        known ? ordered_json(std::sqrt(seen.covariance(k, k)) / maths::kUmPerMm) : ordered_json(nullptr);
  }
  return {{"reading", reading_name(reading)},
          {"rank", seen.rank},
          {"parameters", names.size()},
          {"condition", seen.condition},
          {"unidentifiable", groups_json(seen, names)},
          {"std_per_um", per_um}};
}

ordered_json correlated_json(const Identification& found) {
  constexpr double kWorthSaying = 0.9;  // correlation that makes one number of two (fit/fit.cpp)
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < found.errors.size(); ++i)
    for (std::size_t k = i + 1; k < found.errors.size(); ++k)
      if (const double r = found.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
          std::abs(r) > kWorthSaying)
        list.push_back({{"pair", {found.errors[i].name, found.errors[k].name}}, {"correlation", r}});
  return list;
}

void add_identification(ordered_json& result, const Identification& found) {
  const auto count = static_cast<double>(found.residual_mm.size());
  ordered_json parameters = ordered_json::array();
  std::vector<std::string> names;
  for (const IdentifiedError& error : found.errors) {
    names.push_back(error.name);
    parameters.push_back({{"name", error.name},
                          {"value", error.value},
                          {"std", error.std ? ordered_json(*error.std) : ordered_json(nullptr)},
                          {"unit", error.unit}});
  }
  result["rms_before_um"] = maths::kUmPerMm * std::sqrt(found.before_mm.squaredNorm() / count);
  result["rms_um"] = maths::kUmPerMm * std::sqrt(found.residual_mm.squaredNorm() / count);
  result["max_um"] = maths::kUmPerMm * found.residual_mm.cwiseAbs().maxCoeff();
  result["n_obs"] = found.residual_mm.size();
  result["n_params"] = found.errors.size();
  result["parameters"] = parameters;
  result["unidentifiable"] = groups_json(found.observability, names);
  result["rank"] = found.observability.rank;
  result["correlated"] = correlated_json(found);
  result["converged"] = found.converged;
  result["chi_square"] = found.chi_square;
  result["dof"] = found.freedom;
  result["warnings"] = found.warnings;
}

}  // namespace

const char* reading_name(DefectReading reading) {
  return reading == DefectReading::kContact ? "contact" : reading == DefectReading::kTip ? "tip" : "in-plane";
}

ordered_json part_json(const PartJob& job) {
  ordered_json errors = ordered_json::array();
  for (const model::Static& item : job.machine.machine.statics)
    if (!item.hidden) errors.push_back({{"name", item.name}, {"value", item.value}, {"unit", item.unit}});
  ordered_json result = {
      {"machine", job.machine.machine.name},
      {"pivot_mm", job.machine.pivot_mm},
      {"tool_diameter_mm", 2 * job.options.cutter.radius_mm},
      {"tool_length_mm", job.options.cutter.length_mm},
      {"touches_at_mm", job.options.cutter.touch * kPartHeightMm},
      {"curves", curves_json()},
      {"overcut", overcut_json(job.options.cutter)},
      {"paths", {path_json(job.machine, job.paths[0]), path_json(job.machine, job.paths[1])}},
      {"errors", errors},
      {"defect", defect_json(job)},
      {"observability",
       {observability_json(job, job.options.reading), observability_json(job, DefectReading::kInPlane)}}};
  if (job.recorded) result["recorded"] = recorded_json(*job.recorded);
  if (job.identified) add_identification(result, *job.identified);
  return result;
}

}  // namespace vernier::part
