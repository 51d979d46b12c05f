// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/replay_report.h"

#include <fmt/format.h>

#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/format/columns.h"
#include "tools/results/detail.h"
#include "tools/results/results.h"
#include "tools/text/optional_json.h"

namespace vernier::results {
namespace {

using nlohmann::ordered_json;

ordered_json step_json(const std::string& label, const model::Measurement& m,
                       const Eigen::VectorXd& residual) {
  return {{"label", label},
          {"rms_um", text::or_null(fit::role_statistics(m, residual, false).rms_um)},
          {"check_rms_um", text::or_null(fit::role_statistics(m, residual, true).rms_um)}};
}

ordered_json number(const char* label, const ordered_json& value, const char* unit) {
  return {{"label", label}, {"value", value}, {"unit", unit}};
}

ordered_json model_section(const std::string& title, const model::Machine& machine,
                           const model::Measurement& m) {
  const Eigen::VectorXd residual = fit::residuals(machine, m);
  ordered_json with_detail = ordered_json::object();
  add_detail(with_detail, machine, m, residual);
  ordered_json rows = ordered_json::array();
  for (const ordered_json& s : stretches_json(m, residual))
    rows.push_back({s["run"], s["role"], s["first_line"], s["last_line"], s["n_obs"],
                    fmt::format("{:.1f}", s["rms_um"].get<double>())});
  ordered_json section = {
      {"title", title}, {"prose", ordered_json::array()}, {"detail", with_detail["detail"]}};
  if (rows.size() > 1 && rows.size() <= 24)
    section["tables"] = {
        {{"caption", "Residual by run and role, in the order of the rows"},
         {"columns",
          {format::columns::kRun, format::columns::kRole, "from line", "to line", "readings", "rms [µm]"}},
         {"rows", rows}}};
  return section;
}

ordered_json parameter_list(const model::Machine& machine) {
  ordered_json list = ordered_json::array();
  for (const model::Static& item : machine.statics)
    if (!item.hidden)
      list.push_back({{"name", item.name}, {"value", item.value}, {"std", nullptr}, {"unit", item.unit}});
  return list;
}

ordered_json loop_section(const compile::LoadedImage& image, const std::vector<ReplayStep>& steps) {
  ordered_json rows = ordered_json::array();
  for (const ReplayStep& step : steps)
    rows.push_back(
        {step.label, step.result.ticks, step.result.saturated, step.result.slewing, step.result.not_active});
  return {{"title", "The loop"},
          {"prose",
           {"The firmware ran tick by tick along the measured motion, with the fixed-point equation, the "
            "limits of the machine file and the stated converter. Each reading was shifted by the effect "
            "that the correction has on the nominal machine at that time. The machine was not measured "
            "again: the residuals are computed from the same readings."}},
          {"numbers", {number("cycle", image.view.header().tick_us, "µs")}},
          {"tables",
           {{{"caption", "Ticks"},
             {"columns", {"converter", "ticks", "at a limit", "slewing", "not active"}},
             {"rows", rows}}}}};
}

}  // namespace

ordered_json replay_report(const std::optional<model::Machine>& before, const compile::LoadedImage& image,
                           const model::Measurement& m, const std::vector<ReplayStep>& steps) {
  ordered_json ladder = ordered_json::array();
  ladder.push_back(step_json("nominal machine", m, steps.front().result.before));
  if (before) ladder.push_back(step_json("model " + before->name, m, fit::residuals(*before, m)));
  ladder.push_back(step_json("model " + image.machine.name, m, fit::residuals(image.machine, m)));
  for (const ReplayStep& step : steps)
    ladder.push_back(step_json("corrected, " + step.label, m, step.result.after));
  ordered_json sections = ordered_json::array();
  sections.push_back(
      {{"title", "The error, step by step"},
       {"prose",
        {"Rms of measured minus model on the fit rows and on the check rows (held-out rows). If a step "
         "lowers the rms only on the fit rows, the step is not confirmed on the check rows."}},
       {"ladder", ladder}});
  if (before) sections.push_back(model_section("Against " + before->name, *before, m));
  ordered_json fitted = model_section("Against " + image.machine.name, image.machine, m);
  fitted["parameters"] = parameter_list(image.machine);
  sections.push_back(fitted);
  sections.push_back(loop_section(image, steps));
  return {{"title", "From a measurement to a running correction"},
          {"machine", image.machine.name},
          {"files", m.files},
          {"sections", sections}};
}

}  // namespace vernier::results
