// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/structure_json.h"

#include <fmt/format.h>

#include "tools/format/readings.h"
#include "tools/text/optional_json.h"

namespace vernier::results {
namespace {

using Json = nlohmann::ordered_json;

Json name_or_null(const std::string& name) { return name.empty() ? Json(nullptr) : Json(name); }

/// What the absence of a finding means. A residual far above the noise that depends on no column is no noise.
std::string without_findings(const Json& result, const residual::FailurePicture& picture) {
  constexpr double kFarAbove = 5;     // of the noise: a wrong u is rarely so wrong
  constexpr double kNoChance = 1e-3;  // chance of the strongest pattern
  const auto number = [&](const char* key) {
    return result.contains(key) && result[key].is_number() ? result[key].get<double>() : 0;
  };
  const double rms_um = number("rms_um"), noise_um = number("noise_um");
  if (noise_um > 0 && rms_um > kFarAbove * noise_um && picture.outliers == 0)
    return fmt::format(
        "the residual is {:.3g} times the noise, and no single column explains it: probably the place of the "
        "reflector or of the tool is not known, the readings are not those of these rows, or u is too small",
        rms_um / noise_um);
  if (picture.omnibus_p < kNoChance) return "the residual has structure, but no single column explains it";
  if (rms_um > 0 && noise_um <= 0)
    return "no single column explains the residual, and u is not stated: whether the residual is noise is "
           "not known";
  return "the residual has no structure beyond chance";
}

Json triple(const Eigen::Vector3d& v) { return Json::array({v[0], v[1], v[2]}); }

}  // namespace

Json findings_json(const residual::FailurePicture& picture) {
  Json list = Json::array();
  for (const residual::Finding& f : picture.findings)
    list.push_back({{"observation", f.observation},
                    {"unit", format::report_unit_of(f.observation)},
                    {"column", name_or_null(f.column)},
                    {"second_column", name_or_null(f.second_column)},
                    {"shape", residual::kShapeNames[static_cast<std::size_t>(f.shape)]},
                    {"share_alone", f.share_alone},
                    {"share_after", f.share_after},
                    {"p_value", f.p_value},
                    {"rms_um", f.rms_um},
                    {"low_um", f.low_um},
                    {"high_um", f.high_um},
                    {"period", text::or_null(f.period)},
                    {"period_parts", f.parts},
                    {"period_aliases", f.aliases},
                    {"runs", f.runs},
                    {"runs_agreeing", f.runs_agreeing},
                    {"in_all_runs", f.in_all_runs},
                    {"alike", f.alike},
                    {"sentence", f.sentence}});
  return list;
}

void add_failure(Json& result, const residual::FailurePicture& picture) {
  result["findings"] = findings_json(picture);
  Json& structure = result["structure"];
  structure = {
      {"omnibus_p", picture.omnibus_p},
      {"no_findings", picture.findings.empty() ? Json(without_findings(result, picture)) : Json(nullptr)},
      {"omnibus_by", name_or_null(picture.omnibus_by)},
      {"chi_p", text::or_null(picture.chi_p)},
      {"pure_error_um", text::or_null(picture.pure_error_um)},
      {"lack_of_fit_um", text::or_null(picture.lack_of_fit_um)},
      {"lack_of_fit_p", text::or_null(picture.lack_of_fit_p)},
      {"repeat_freedom", picture.repeat_freedom},
      {"neighbour_error_um", text::or_null(picture.neighbour_error_um)},
      {"tried", picture.tried},
      {"outliers", picture.outliers},
      {"shares", Json::array()},
      {"cells", Json::array()}};
  for (const residual::ColumnShare& share : picture.shares)
    structure["shares"].push_back({{"observation", share.observation},
                                   {"column", share.column},
                                   {"share_alone", share.share_alone},
                                   {"share_after", share.share_after},
                                   {"p_value", share.p_value}});
  for (const residual::FailureCell& cell : picture.cells)
    structure["cells"].push_back({{"point_mm", triple(cell.point_mm)},
                                  {"mean_um", triple(cell.mean_um)},
                                  {"noise_um", cell.noise_um},
                                  {"count", cell.count}});
}

}  // namespace vernier::results
