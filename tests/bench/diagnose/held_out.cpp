// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/diagnose/held_out.h"

#include <nlohmann/json.hpp>

#include "tests/bench/diagnose/process.h"
#include "tools/fit/fit.h"
#include "tools/model/machine_reader.h"

namespace vernier::bench {

using namespace vernier::fit;
using namespace vernier::model;

std::optional<double> held_out_ratio(const support::HiddenSurvey& survey, const std::string& add,
                                     const std::string& vernier, const std::string& folder,
                                     std::string& why) {
  const std::string added = folder + "/added.xml", csv = folder + "/survey.csv";
  if (run_process({vernier, "add", add, folder + "/model.xml", "-o", added}, folder + "/add.err").status !=
      0) {
    why = "add " + add;
    return {};
  }
  const ProcessResult fitted = run_process(
      {vernier, "fit", added, csv, "-o", folder + "/fitted.xml", "--json", "-"}, folder + "/fit.err");
  const auto json = nlohmann::json::parse(fitted.output, nullptr, false);
  if (fitted.status != 0 || json.is_discarded() || !json.contains("check_rms_um") ||
      json["check_rms_um"].is_null()) {
    why = "fit after add " + add;
    return {};
  }
  const Machine truth = parse_machine(survey.truth, "truth.xml");
  const FitResult reference = fit::fit(truth, parse_measurement(survey.csv, "survey.csv", truth));
  if (!reference.check.rms_um || *reference.check.rms_um <= 0) {
    why = "no check rows";
    return {};
  }
  return json["check_rms_um"].get<double>() / *reference.check.rms_um;
}

}  // namespace vernier::bench
