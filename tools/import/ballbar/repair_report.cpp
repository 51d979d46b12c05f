// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/repair_report.h"
#include "tools/text/optional_json.h"

#include <fmt/format.h>

#include <algorithm>

namespace vernier::importer {
namespace {

using Json = nlohmann::ordered_json;

Json agreement_json(const PassAgreement& a) {
  return {{"difference_um", a.difference_um},
          {"level_difference_um", a.level_um},
          {"correlation", a.correlation},
          {"samples", a.samples}};
}

Json run_json(const RunRepair& run) {
  Json gaps = Json::array();
  for (const auto& gap : run.gaps) {
    gaps.push_back({{"sample", gap.sample},
                    {"sample_uncertainty", gap.sample_uncertainty},
                    {"missing", gap.missing},
                    {"uncertainty", gap.uncertainty}});
  }
  return {{"run", run.label},
          {"repaired", run.repaired},
          {"why_not", run.why_not},
          {"turn_samples_before", run.turn_before},
          {"turn_samples", run.turn_after},
          {"turn_uncertainty", run.turn_uncertainty},
          {"gaps", gaps},
          {"start_shift_deg", run.start_shift_deg},
          {"start_uncertainty_deg", text::or_null(run.start_uncertainty_deg)},
          {"start_correlation", text::or_null(run.start_correlation)},
          {"start_from", run.start_from},
          {"feed_in_samples", run.feed_in},
          {"before", agreement_json(run.before)},
          {"after", agreement_json(run.after)}};
}

Json error_json(const RepeatingError& error) {
  Json steps = Json::array();
  for (const auto& step : error.steps) {
    steps.push_back({{"stations", step.stations},
                     {"left_out_um", step.left_out_um},
                     {"fit_um", step.fit_um},
                     {"other_turn_um", text::or_null(step.other_turn_um)},
                     {"other_turn_usual_um", text::or_null(step.other_turn_usual_um)},
                     {"other_direction_um", text::or_null(step.other_direction_um)}});
  }
  return {{"run", error.run},
          {"fit_samples", error.fit_samples},
          {"other_turn_samples", error.other_turn_samples},
          {"other_direction_samples", error.other_direction_samples},
          {"chosen_stations", error.best().stations},
          {"steps", steps}};
}

std::string um(const std::optional<double>& value) { return value ? fmt::format("{:.1f}", *value) : "-"; }

void print_run(std::FILE* out, const RunRepair& run) {
  if (!run.repaired) {
    fmt::print(out, "  {:<4} time base not changed: {}\n", run.label, run.why_not);
    return;
  }
  fmt::print(out, "  {:<4} a turn takes {:.1f} +- {:.1f} samples, not {:.0f}", run.label, run.turn_after,
             run.turn_uncertainty, run.turn_before);
  if (!run.start_from.empty())
    fmt::print(
        out, "; the angles of the run rotated by {:.1f} +- {:.1f} deg to agree with {} (correlation {:.2f})",
        run.start_shift_deg, *run.start_uncertainty_deg, run.start_from, *run.start_correlation);
  fmt::print(out, "\n");
  for (const auto& gap : run.gaps)
    fmt::print(out,
               "       {:.1f} +- {:.1f} samples missing before sample {} (+- {:.0f}), or the other pass "
               "waited there\n",
               gap.missing, gap.uncertainty, gap.sample, gap.sample_uncertainty);
  if (run.feed_in > 0)
    fmt::print(out,
               "       the second pass does not repeat the first {} samples (feed-in): these samples have no "
               "length\n",
               run.feed_in);
  fmt::print(out, "       pass to pass: difference {:.1f} -> {:.1f} um, correlation {:.2f} -> {:.2f}\n",
             run.before.difference_um, run.after.difference_um, run.before.correlation,
             run.after.correlation);
}

void print_error(std::FILE* out, const char* when, const RepeatingError& error) {
  for (const RepeatingStep* step : {&error.steps.front(), &error.best()}) {
    const std::string model =
        step->stations == 0 ? "centre and radius" : fmt::format("table of {} stations", step->stations);
    fmt::print(out,
               "  {:<4} {:<8} {:<22} fit {:.1f} um, held out: another turn {} um (usually {}), other "
               "direction {} um\n",
               error.run, when, model, step->fit_um, um(step->other_turn_um), um(step->other_turn_usual_um),
               um(step->other_direction_um));
  }
}

}  // namespace

RepairReport repair_and_judge(const BallbarFile& file) {
  RepairReport report{repair_time_base(file), {}, {}};
  std::vector<std::vector<char>> on_circle;
  for (const auto& run : report.repair.file.runs)
    on_circle.push_back(run.clock ? run.clock->on_circle : std::vector<char>(run.reading_mm.size(), 1));
  for (std::size_t k = 0; k < file.runs.size(); ++k) {
    if (!report.repair.runs[k].repaired) continue;
    report.before.push_back(repeating_error(file, k, on_circle));
    report.after.push_back(repeating_error(report.repair.file, k, on_circle));
  }
  return report;
}

Json repair_json(const RepairReport& report) {
  Json runs = Json::array(), before = Json::array(), after = Json::array();
  for (const auto& run : report.repair.runs) runs.push_back(run_json(run));
  for (const auto& error : report.before) before.push_back(error_json(error));
  for (const auto& error : report.after) after.push_back(error_json(error));
  return {{"file", report.repair.file.path},
          {"runs", runs},
          {"repeating_error_before", before},
          {"repeating_error", after}};
}

void print_repair(std::FILE* out, const RepairReport& report) {
  fmt::print(out, "{}: time base repaired from the samples that repeat\n", report.repair.file.path);
  for (const auto& run : report.repair.runs) print_run(out, run);
  for (std::size_t k = 0; k < report.after.size(); ++k) {
    print_error(out, "as filed", report.before[k]);
    print_error(out, "repaired", report.after[k]);
  }
}

}  // namespace vernier::importer
