// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/before_after_result.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/format/readings.h"
#include "tools/text/optional_json.h"

namespace vernier::results {
namespace {

using Json = nlohmann::ordered_json;

const char* unit_of(const residual::ReductionGroup& group) {
  return format::report_unit_of(group.kind.value_or(model::ObservationKind::kX));
}

const char* verdict_word(residual::Helped verdict) {
  switch (verdict) {
    case residual::Helped::kHelped:
      return "helped";
    case residual::Helped::kMadeWorse:
      return "made-worse";
    case residual::Helped::kCannotBeTold:
      break;
  }
  return "cannot-be-told";
}

Json interval_json(const std::optional<residual::ConfidenceInterval>& interval) {
  return interval ? Json{interval->low, interval->high} : Json(nullptr);
}

Json figures_json(const residual::ErrorFigures& f, const std::string& unit) {
  return {{"n", f.count},
          {"mean_" + unit, f.mean},
          {"spread_" + unit, f.spread},
          {"rms_" + unit, f.rms},
          {"max_" + unit, f.largest},
          {"mean_interval", interval_json(f.mean_interval)},
          {"spread_interval", interval_json(f.spread_interval)},
          {"rms_interval", interval_json(f.rms_interval)}};
}

void add_figures(Json& json, const residual::ReductionGroup& group) {
  const std::string unit = unit_of(group);
  json["before_" + unit] = group.before.rms;
  json["after_" + unit] = group.after.rms;
  json["reduction"] = text::or_null(group.reduction);
  json["interval"] = interval_json(group.interval);
  json["before"] = figures_json(group.before, unit);
  json["after"] = figures_json(group.after, unit);
}

std::string percent(double share) { return fmt::format("{:.3g}", 100 * share); }

std::string interval_text(const residual::ReductionGroup& group) {
  if (!group.interval) return "-";
  return percent(group.interval->low) + " to " + percent(group.interval->high);
}

std::string sentence(const residual::BeforeAfter& result) {
  const residual::ReductionGroup& all = result.all;
  const std::string figures =
      fmt::format("{:.4g} um rms before, {:.4g} um after", all.before.rms, all.after.rms);
  if (!all.interval)
    return fmt::format(
        "The readings do not show whether the correction reduced the error: {}; there are too few {}.",
        figures, result.paired ? "poses" : "rows");
  const std::string how =
      fmt::format("{}: {} % less (95 % interval {} %)", figures, percent(*all.reduction), interval_text(all));
  switch (result.verdict()) {
    case residual::Helped::kHelped:
      return "The correction reduced the error: " + how + ".";
    case residual::Helped::kMadeWorse:
      return fmt::format("The correction increased the error: {}: {} % more (95 % interval {} to {} %).",
                         figures, percent(-*all.reduction), percent(-all.interval->high),
                         percent(-all.interval->low));
    case residual::Helped::kCannotBeTold:
      break;
  }
  return fmt::format(
      "The readings do not show whether the correction reduced the error: {}, which contains 0.", how);
}

/// Method of the comparison, and remarks for the reader.
std::vector<std::string> remarks(const residual::BeforeAfter& result) {
  std::vector<std::string> list;
  if (result.paired)
    list.push_back(
        fmt::format("{} poses occur in both measurements, and are compared pose by pose", result.samples));
  else
    list.push_back(
        "the two measurements have different poses: the comparison uses all rows of both, in blocks of "
        "neighbouring rows");
  if (result.unmatched_before + result.unmatched_after > 0)
    list.push_back(
        fmt::format("excluded rows, because their poses occur only before or only after the correction: {} "
                    "rows before, {} rows after",
                    result.unmatched_before, result.unmatched_after));
  if (result.corrected_before > 0)
    list.push_back(
        fmt::format("{} rows of the measurement before the correction state that a correction was active",
                    result.corrected_before));
  return list;
}

std::string name_of(const residual::ReductionGroup& group) {
  std::string name = group.kind ? format::name_of(*group.kind) : "all";
  if (group.feed) name += fmt::format(" at {:g} mm/min", *group.feed);
  return name;
}

std::vector<std::string> cells(const residual::ReductionGroup& group) {
  // A component that the set-up removed is 0 to the digits of its fit.
  const auto shown = [](double value) { return std::abs(value) < 1e-5 ? 0 : value; };
  const auto two = [&](double before, double after) {
    return fmt::format("{:.4g} -> {:.4g}", shown(before), shown(after));
  };
  return {name_of(group),
          unit_of(group),
          two(group.before.mean, group.after.mean),
          two(group.before.spread, group.after.spread),
          two(group.before.rms, group.after.rms),
          two(group.before.largest, group.after.largest),
          group.reduction ? percent(*group.reduction) : "-",
          interval_text(group)};
}

const std::vector<std::string> kColumns = {"readings", "unit",    "mean",        "spread",
                                           "rms",      "largest", "reduction %", "95 % interval"};

std::vector<std::vector<std::string>> table(const residual::BeforeAfter& result) {
  std::vector<std::vector<std::string>> rows = {cells(result.all)};
  for (const residual::ReductionGroup& group : result.groups) rows.push_back(cells(group));
  return rows;
}

}  // namespace

Json before_after_json(const residual::BeforeAfter& result) {
  Json json;
  add_figures(json, result.all);
  json["verdict"] = verdict_word(result.verdict());
  json["sentence"] = sentence(result);
  json["paired"] = result.paired;
  json["samples"] = result.samples;
  json["unmatched_rows"] = {{"before", result.unmatched_before}, {"after", result.unmatched_after}};
  json["corrected_rows"] = {{"before", result.corrected_before}, {"after", result.corrected_after}};
  json["groups"] = Json::array();
  for (const residual::ReductionGroup& group : result.groups) {
    Json one = {{"axis", nullptr}, {"feed", text::or_null(group.feed)}, {"unit", unit_of(group)}};
    if (group.kind) one["axis"] = format::name_of(*group.kind);
    add_figures(one, group);
    json["groups"].push_back(std::move(one));
  }
  return json;
}

void print_before_after(std::FILE* out, const residual::BeforeAfter& result) {
  fmt::print(out, "{}\n", sentence(result));
  for (const std::string& remark : remarks(result)) fmt::print(out, "{}\n", remark);
  const auto line = [&](const std::vector<std::string>& c) {
    fmt::print(out, "{:<22} {:<5} {:>20} {:>20} {:>20} {:>20} {:>12} {:>16}\n", c[0], c[1], c[2], c[3], c[4],
               c[5], c[6], c[7]);
  };
  line(kColumns);
  for (const std::vector<std::string>& row : table(result)) line(row);
}

Json before_after_page(const residual::BeforeAfter& result, const std::string& machine,
                       const std::vector<std::string>& files) {
  const residual::ReductionGroup& all = result.all;
  Json section = {{"title", "Did it help?"}, {"prose", {sentence(result)}}};
  section["numbers"] = {{{"label", "rms before"}, {"value", all.before.rms}, {"unit", "um"}},
                        {{"label", "rms after"}, {"value", all.after.rms}, {"unit", "um"}, {"strong", true}}};
  section["tables"] = {{{"caption", "error before -> after; intervals of 95 %"},
                        {"columns", kColumns},
                        {"rows", table(result)}}};
  section["notes"] = remarks(result);
  return {{"title", "Before and after"}, {"machine", machine}, {"files", files}, {"sections", {section}}};
}

}  // namespace vernier::results
