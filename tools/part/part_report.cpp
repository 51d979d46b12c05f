// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/part_report.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "tools/maths/factors.h"
#include "tools/part/envelope.h"
#include "tools/part/part_json.h"
#include "tools/part/surface/s_part.h"

namespace vernier::part {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kDrawn = 521;  // points of a curve: about one per pixel

std::vector<double> along() {
  std::vector<double> u;
  for (std::size_t i = 0; i < kDrawn; ++i) u.push_back(static_cast<double>(i) / (kDrawn - 1));
  return u;
}

ordered_json curve_plot(ordered_json y, const std::string& caption) {
  return {{"x", {{"name", "curve parameter u"}, {"unit", ""}, {"values", along()}}},
          {"y", std::move(y)},
          {"caption", caption}};
}

ordered_json over_u(const std::string& name, const char* unit, const std::function<double(double)>& value) {
  std::vector<double> values;
  for (const double u : along()) values.push_back(value(u));
  return {{"name", name}, {"unit", unit}, {"values", values}};
}

ordered_json defect_plot(const PartJob& job) {
  ordered_json y = ordered_json::array();
  for (std::size_t flank = 0; flank < s_part().size(); ++flank)
    for (const double z_mm : kMeasuredHeightsMm) {
      std::vector<PartPoint> points;
      for (const double u : along()) points.push_back({flank, u, z_mm / kPartHeightMm});
      const PartDefect defect = part_defect(job.machine, points, job.options);
      const Eigen::VectorXd um = maths::kUmPerMm * defect.defect_mm;
      y.push_back({{"name", fmt::format("{} at {:g} mm", s_part()[flank].name, z_mm)},
                   {"unit", "µm"},
                   {"values", std::vector<double>(um.begin(), um.end())}});
    }
  return curve_plot(y,
                    "Defect along the normal, positive where material is left, at the two measured heights.");
}

ordered_json defect_section(const PartJob& job, const ordered_json& result) {
  const ordered_json& d = result["defect"];
  ordered_json rows = ordered_json::array();
  for (const ordered_json& flank : d["tip_along_flank"])
    rows.push_back({flank["flank"], flank["min_mm"], flank["max_mm"]});
  return {{"title", "Effect of the machine's errors on the part"},
          {"prose",
           {"The part is in the position in which it was cut, and the offsets are set at the work origin; "
            "the part is not aligned to the model."}},
          {"numbers",
           {{{"label", "least"}, {"value", maths::kUmPerMm * d["min_mm"].get<double>()}, {"unit", "µm"}},
            {{"label", "largest"}, {"value", maths::kUmPerMm * d["max_mm"].get<double>()}, {"unit", "µm"}},
            {{"label", "rms"}, {"value", d["rms_um"]}, {"unit", "µm"}, {"strong", true}},
            {{"label", "points"}, {"value", d["points"]}, {"unit", ""}}}},
          {"plots", {defect_plot(job)}},
          {"tables",
           {{{"caption", "Displacement of the tool tip along the whole flank"},
             {"columns", {"flank", "least [mm]", "largest [mm]"}},
             {"rows", rows}}}}};
}

ordered_json overcut_section(const PartJob& job, const ordered_json& result) {
  const Cutter& cutter = job.options.cutter;
  ordered_json plots = ordered_json::array(), rows = ordered_json::array();
  for (const RuledSurface& flank : s_part()) {
    const ordered_json y = {
        over_u("distance to the surface", "mm",
               [&](double u) { return -envelope_distance_mm(flank, cutter, u, 0); }),
        over_u("formula as printed", "mm",
               [&](double u) {
                 return overcut_formula_mm(flank_pose(flank, cutter, u, {false, true}), cutter, 0);
               }),
        over_u("formula, unit normal", "mm", [&](double u) {
          return overcut_formula_mm(flank_pose(flank, cutter, u, {true, true}), cutter, 0);
        })};
    plots.push_back(
        curve_plot(y, fmt::format("Overcut of the analytical path at the foot of flank {}.", flank.name)));
  }
  for (const ordered_json& one : result["overcut"])
    rows.push_back({one["flank"], one["formula_as_printed"]["mm"], one["formula_unit_normal"]["mm"],
                    one["formula_inward_normal"]["mm"], one["distance"][0]["mm"], one["distance"][1]["mm"],
                    one["distance"][2]["mm"]});
  return {
      {"title", "Overcut of a cylindrical cutter on a twisted flank"},
      {"prose",
       {"Largest overcut of the flank path, computed by two interpretations of the printed formula, by the "
        "formula with the normal on the wrong side, and as the distance from the envelope to the surface."}},
      {"plots", plots},
      {"tables",
       {{{"caption", "Largest overcut [mm]"},
         {"columns",
          {"flank", "as printed", "unit normal", "inward normal", "distance, Z0", "distance, Z11",
           "distance, Z25"}},
         {"rows", rows}}}}};
}

ordered_json axis_curve(const PartPath& path, const char* name, const char* unit, double JointPose::*member) {
  std::vector<double> values;
  for (const JointPose& q : path.joints) values.push_back(q.*member);
  return {{"name", name}, {"unit", unit}, {"values", values}};
}

ordered_json path_section(const PartJob& job) {
  ordered_json plots = ordered_json::array(), notes = ordered_json::array();
  for (const PartPath& path : job.paths) {
    const ordered_json x = {{"name", "time"}, {"unit", "s"}, {"values", path.t_s}};
    const std::string caption = fmt::format("Flank {}.", s_part()[path.flank].name);
    plots.push_back(
        {{"x", x},
         {"y",
          {axis_curve(path, "B", "deg", &JointPose::b_deg), axis_curve(path, "C", "deg", &JointPose::c_deg)}},
         {"caption", caption}});
    plots.push_back(
        {{"x", x},
         {"y",
          {axis_curve(path, "X", "mm", &JointPose::x_mm), axis_curve(path, "Y", "mm", &JointPose::y_mm)}},
         {"caption", caption}});
    for (const std::string& beyond : beyond_limits(job.machine, path))
      notes.push_back(caption + " " + beyond);
  }
  return {{"title", "The path of the axes"}, {"plots", plots}, {"notes", notes}};
}

ordered_json observability_section(const ordered_json& result) {
  ordered_json rows = ordered_json::array(), groups = ordered_json::array();
  for (const ordered_json& one : result["observability"])
    groups.push_back({one["reading"],
                      fmt::format("{} of {}", one["rank"].get<int>(), one["parameters"].get<int>()),
                      one["condition"], joined_groups(one["unidentifiable"])});
  const ordered_json& spread = result["observability"][0]["std_per_um"];
  for (const ordered_json& error : result["errors"])
    rows.push_back({error["name"], error["value"], spread[error["name"].get<std::string>()], error["unit"]});
  return {
      {"title", "Errors of the machine from the part"},
      {"prose",
       {"With the horizontal part of the displacement alone, tilts of the Z slide and of the table axis have "
        "the same effect; only the vertical part on the inclined flanks distinguishes the two tilts."}},
      {"tables",
       {{{"caption", "Errors that cannot be distinguished"},
         {"columns", {"reading", "rank", "condition", "inseparable"}},
         {"rows", groups}},
        {{"caption", "Standard uncertainty of each error, for a standard uncertainty of 1 µm of the points"},
         {"columns", {"error", "value", "std. uncertainty", "unit"}},
         {"rows", rows}}}}};
}

ordered_json identification_section(const PartJob& job, const ordered_json& result) {
  const Identification& found = *job.identified;
  const auto column = [](const char* name, const Eigen::VectorXd& mm) {
    const Eigen::VectorXd um = maths::kUmPerMm * mm;
    return ordered_json{
        {"name", name}, {"unit", "µm"}, {"values", std::vector<double>(um.begin(), um.end())}};
  };
  std::vector<double> index;
  Eigen::VectorXd measured(found.residual_mm.size());
  for (std::size_t i = 0; i < job.measured->points.size(); ++i) {
    index.push_back(static_cast<double>(i + 1));
    measured[static_cast<Eigen::Index>(i)] = job.measured->points[i].defect_mm;
  }
  ordered_json notes = {"Cannot be distinguished: " + joined_groups(result["unidentifiable"])};
  for (const std::string& warning : found.warnings) notes.push_back("Warning: " + warning + ".");
  return {{"title", "Errors from the measured part"},
          {"numbers",
           {{{"label", "rms before"}, {"value", result["rms_before_um"]}, {"unit", "µm"}},
            {{"label", "rms after"}, {"value", result["rms_um"]}, {"unit", "µm"}, {"strong", true}},
            {{"label", "largest residual"}, {"value", result["max_um"]}, {"unit", "µm"}}}},
          {"parameters", result["parameters"]},
          {"plots",
           {{{"x", {{"name", "point"}, {"unit", ""}, {"values", index}}},
             {"y",
              {column("measured", measured), column("model", measured - found.residual_mm),
               column("residual", found.residual_mm)}},
             {"caption", "The points are in the order of the file."}}}},
          {"notes", notes}};
}

}  // namespace

std::string joined_groups(const ordered_json& groups) {
  std::string text;
  for (const ordered_json& group : groups) {
    std::string names;
    for (const ordered_json& name : group) names += (names.empty() ? "" : " and ") + name.get<std::string>();
    text += (text.empty() ? "" : "; ") + names;
  }
  return text.empty() ? "none" : text;
}

ordered_json part_report(const PartJob& job, const ordered_json& result) {
  ordered_json sections = ordered_json::array();
  if (job.identified) sections.push_back(identification_section(job, result));
  sections.push_back(defect_section(job, result));
  sections.push_back(observability_section(result));
  sections.push_back(overcut_section(job, result));
  sections.push_back(path_section(job));
  ordered_json files = ordered_json::array();
  if (job.measured) files.push_back(job.measured->file);
  return {{"title", "S-shaped test part (ISO 10791-7)"},
          {"machine", job.machine.machine.name},
          {"files", files},
          {"sections", sections}};
}

}  // namespace vernier::part
