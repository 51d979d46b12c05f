// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/positioning_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/format/columns.h"

namespace vernier::evaluate {
namespace {

using Json = nlohmann::ordered_json;

struct Characteristic {
  const char* name;
  const char* meaning;
};
constexpr std::array<Characteristic, 12> kCharacteristics = {{
    {"A", "bidirectional accuracy of positioning"},
    {"A+", "accuracy forward"},
    {"A-", "accuracy backward"},
    {"R", "bidirectional repeatability of positioning"},
    {"R+", "repeatability forward"},
    {"R-", "repeatability backward"},
    {"E", "bidirectional systematic positioning error"},
    {"E+", "systematic error forward"},
    {"E-", "systematic error backward"},
    {"M", "mean bidirectional positioning error"},
    {"B", "reversal error"},
    {"mean B", "mean reversal error"},
}};

Json or_none(const std::optional<double>& value, double factor) {
  return value ? Json(*value * factor) : Json(nullptr);
}

constexpr int kDigits = 2;  // behind the point, um or arcsec

Json cell(const Json& value) {
  return value.is_null()     ? Json("–")
         : value.is_number() ? Json(fmt::format("{:.{}f}", value.get<double>(), kDigits))
                             : value;
}

Json column(const Json& targets, const char* key, std::size_t sense) {
  Json values = Json::array();
  for (const Json& target : targets) values.push_back(key[0] == 't' ? target[key] : target[key][sense]);
  return values;
}

/// Mean, mean - 2 s and mean + 2 s of a direction, and its single runs: the form of the plot in the standard.
void add_curves(Json& curves, const Json& targets, std::size_t sense, const std::string& unit) {
  const std::string way = sense == 0 ? "forward" : "backward";
  curves.push_back({{"name", "mean " + way},
                    {"unit", unit},
                    {"values", column(targets, "mean", sense)},
                    {"colour", sense}});
  for (const double times : {-2.0, 2.0}) {
    Json values = Json::array();
    for (const Json& target : targets)
      values.push_back(target["mean"][sense].is_null() ? Json(nullptr)
                                                       : Json(target["mean"][sense].get<double>() +
                                                              times * target["s"][sense].get<double>()));
    curves.push_back({{"name", "mean \u00b1 2 s " + way},
                      {"unit", unit},
                      {"values", values},
                      {"colour", sense},
                      {"style", "dashed"}});
  }
  std::size_t runs = 0;
  for (const Json& target : targets) runs = std::max(runs, target["readings"][sense].size());
  for (std::size_t run = 0; run < runs; ++run) {
    Json values = Json::array();
    for (const Json& target : targets) {
      const Json& list = target["readings"][sense];
      values.push_back(run < list.size() ? list[run] : Json(nullptr));
    }
    curves.push_back({{"name", "runs " + way},
                      {"unit", unit},
                      {"values", values},
                      {"colour", sense},
                      {"style", "points"}});
  }
}

}  // namespace

std::optional<double> characteristic(const PositioningResult& result, const std::string& name) {
  if (name == "A") return result.accuracy_both;
  if (name == "A+") return result.accuracy[0];
  if (name == "A-") return result.accuracy[1];
  if (name == "R") return result.repeatability_both;
  if (name == "R+") return result.repeatability[0];
  if (name == "R-") return result.repeatability[1];
  if (name == "E") return result.systematic_both;
  if (name == "E+") return result.systematic[0];
  if (name == "E-") return result.systematic[1];
  if (name == "M") return result.range;
  if (name == "B") return result.reversal;
  if (name == "mean B") return result.mean_reversal;
  return std::nullopt;
}

std::optional<JudgedValue> judged_of(const Json& characteristic) {
  if (!characteristic.contains("tolerance")) return std::nullopt;
  const auto number = [&](const char* key) {
    const Json& one = characteristic[key];
    return one.is_null() ? std::nullopt : std::optional<double>(one.get<double>());
  };
  return JudgedValue{characteristic["name"], number("value"), number("uncertainty"), *number("tolerance")};
}

Json positioning_json(const PositioningResult& result, const PositioningFile& file,
                      const PositioningWords& words) {
  const double factor = file.unit == "mm" ? 1e3 : 3600;
  Json json = {
      {"standard", "ISO 230-2"},
      {"axis", words.axis},
      {"unit", file.unit == "mm" ? "um" : "arcsec"},
      {"position_unit", file.unit},
      {"n_rows", file.rows},
      {"n_undirected", file.undirected},
      {"n_targets", result.targets.size()},
      {"sense", file.sense_from_order ? "from the order of the rows"
                                      : format::axis_column(format::AxisQuantity::kSense, words.axis)}};
  for (const auto& [key, value] : words.header) json["header"][key] = value;
  for (std::size_t k = 0; k < result.targets.size(); ++k) {
    const TargetResult& at = result.targets[k];
    Json one = {{"target", at.target}, {"n", {at.count[0], at.count[1]}}};
    for (const std::vector<double>& list : file.readings[k].deviation) {
      one["readings"].push_back(Json::array());
      for (const double deviation : list) one["readings"].back().push_back(deviation * factor);
    }
    for (std::size_t sense = 0; sense < 2; ++sense) {
      const bool there = at.count[sense] > 0;
      one["mean"].push_back(there ? Json(at.mean[sense] * factor) : Json(nullptr));
      one["s"].push_back(there ? Json(at.spread[sense] * factor) : Json(nullptr));
      one["R"].push_back(there ? Json(at.repeatability[sense] * factor) : Json(nullptr));
    }
    const bool both = at.count[0] > 0 && at.count[1] > 0;
    one["mean_both"] = both ? Json(at.mean_both * factor) : Json(nullptr);
    one["B"] = both ? Json(at.reversal * factor) : Json(nullptr);
    one["R_both"] = both ? Json(at.repeatability_both * factor) : Json(nullptr);
    json["targets"].push_back(std::move(one));
  }
  std::vector<JudgedValue> judged;
  for (const Characteristic& known : kCharacteristics) {
    const auto value = characteristic(result, known.name);
    Json one = {{"name", known.name}, {"meaning", known.meaning}, {"value", or_none(value, factor)}};
    const auto limit = words.tolerance.find(known.name), u = words.uncertainty.find(known.name);
    one["uncertainty"] = u == words.uncertainty.end() ? Json(nullptr) : Json(u->second * factor);
    if (limit != words.tolerance.end()) {
      one["tolerance"] = limit->second * factor;
      const double expanded = u == words.uncertainty.end() ? 0 : u->second;
      one["conformity"] =
          value ? Json(conformity_text(conformity(*value, limit->second, expanded))) : Json(nullptr);
      judged.push_back(*judged_of(one));
    }
    json["characteristics"].push_back(std::move(one));
  }
  json["assurance"] = assurance_of(judged, json["unit"]).json();
  return json;
}

Json positioning_page(const Json& json, const PositioningWords& words) {
  const std::string unit = json["unit"] == "um" ? "µm" : "″";
  Json tiles = Json::array(), table = Json::array(), places = Json::array();
  for (const Json& one : json["characteristics"]) {
    const std::string name = one["name"];
    if (name == "A" || name == "R" || name == "E" || name == "M" || name == "B")
      tiles.push_back({{"label", name},
                       {"value", one["value"]},
                       {"unit", unit},
                       {"hint", one["meaning"]},
                       {"strong", name == "A"}});
    JudgedText texts{cell(one["value"]).get<std::string>(), cell(one["uncertainty"]).get<std::string>(), "–"};
    if (const auto judged = judged_of(one)) texts = judged_text(*judged, kDigits);
    table.push_back({name, one["meaning"], texts.value, texts.uncertainty, texts.tolerance,
                     cell(one.value("conformity", Json(nullptr)))});
  }
  for (const Json& at : json["targets"])
    places.push_back({at["target"], cell(at["mean"][0]), cell(at["mean"][1]), cell(at["s"][0]),
                      cell(at["s"][1]), cell(at["mean_both"]), cell(at["B"]), cell(at["R_both"])});
  const std::string position = json["position_unit"] == "mm" ? "mm" : "deg";
  Json plot = {
      {"x", {{"name", words.axis}, {"unit", position}, {"values", column(json["targets"], "target", 0)}}}};
  plot["y"] = Json::array();
  for (const std::size_t sense : {0U, 1U})
    if (std::any_of(json["targets"].begin(), json["targets"].end(),
                    [&](const Json& target) { return !target["mean"][sense].is_null(); }))
      add_curves(plot["y"], json["targets"], sense, unit);
  plot["caption"] =
      "Deviation at each target: mean of the runs (line), mean \u00b1 2 s (dashed; the envelope of A), and "
      "each run "
      "(point).";
  Json first = {{"title", "Positioning of axis " + words.axis + " (ISO 230-2)"}, {"numbers", tiles}};
  if (json.contains("budget")) {
    Json rows = Json::array();
    for (const Json& part : json["budget"]) rows.push_back({part["part"], cell(part["U_um"])});
    first["tables"] = {{{"caption", "Uncertainty of A, E and M: parts, k = 2, in µm"},
                        {"columns", {"part", "U"}},
                        {"rows", rows}}};
  }
  const Json rule =
      "A tolerance is met if the value plus its expanded uncertainty (k = 2) is within the tolerance. A "
      "tolerance is not met if the value minus its expanded uncertainty exceeds the tolerance (ISO 14253-1). "
      "If no uncertainty is given, the value alone is compared with the tolerance.";
  return {{"title", "Positioning accuracy"},
          {"machine", words.axis},
          {"files", words.files},
          {"sections",
           {first,
            {{"title", "Characteristics"},
             {"prose", {rule}},
             {"tables",
              {{{"caption", "in " + unit},
                {"columns", {"", "is", "value", "U (k = 2)", "tolerance", "verdict"}},
                {"rows", table}}}}},
            {{"title", "Deviations"}, {"plots", {plot}}},
            {{"title", "Targets"},
             {"tables",
              {{{"caption", "position in " + position + ", all else in " + unit},
                {"columns",
                 {"target", "mean forward", "mean backward", "s forward", "s backward", "mean of both",
                  "reversal", "R"}},
                {"rows", places}}}}}}}};
}

}  // namespace vernier::evaluate
