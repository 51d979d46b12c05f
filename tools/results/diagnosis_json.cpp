// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/diagnosis_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/causes.h"
#include "tools/diagnose/sentences.h"
#include "tools/effects/candidate.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/results/results.h"
#include "tools/results/structure_json.h"
#include "tools/text/assurance.h"
#include "tools/text/optional_json.h"

namespace vernier::results {
namespace {

using Json = nlohmann::ordered_json;

Json parameter_json(const fit::ParameterEstimate& item) {
  return {{"name", item.name}, {"value", item.value}, {"std", item.std}, {"unit", item.unit}};
}

std::string term_text(const effects::Candidate& candidate) {
  std::string text;
  for (const effects::CandidateTerm& term : candidate.terms) text += (text.empty() ? "" : " ; ") + term.text;
  return text;
}

/// Name of the axis; null for a term of two axes.
Json axis_json(const effects::Candidate& candidate, std::optional<std::size_t> axis,
               const model::Machine& machine) {
  return axis && !candidate.choice.axis2 ? Json(machine.axes[*axis].name) : Json(nullptr);
}

/// Transform and degree of freedom; null for a term at several of them.
void add_place(Json& json, const effects::Candidate& candidate, const model::Machine& machine) {
  const bool one = candidate.terms.size() == 1;
  const effects::DofPlace& place = candidate.terms[0].place;
  const bool one_transform =
      std::all_of(candidate.terms.begin(), candidate.terms.end(), [&](const effects::CandidateTerm& term) {
        return term.place.workpiece == place.workpiece && term.place.transform == place.transform;
      });
  json["transform"] = one_transform ? Json(effects::transform_at(machine, place).n) : Json(nullptr);
  json["dof"] = one ? Json(effects::dof_name(machine, place)) : Json(nullptr);
}

/// rms of residual / u over the check rows of each file.
Json check_files_json(const diagnose::LadderStep& step) {
  Json list = Json::array();
  for (const diagnose::CheckOfFile& one : step.check_files)
    list.push_back({{"file", one.file}, {"rms_over_u", one.rms}});
  return list;
}

Json candidate_json(const diagnose::CandidateFinding& finding, const model::Machine& machine) {
  const effects::Choice& choice = finding.candidate.choice;
  Json json;
  json["effect"] = choice.effect->id;
  json["title"] = choice.effect->title;
  json["add"] = finding.add;
  json["said"] = diagnose::said_of(finding);
  json["label"] = finding.candidate.label;
  json["axis"] = axis_json(finding.candidate, finding.axis, machine);
  json["input"] = choice.inputs.empty() ? Json(nullptr) : Json(choice.inputs[0]);
  json["inputs"] = choice.inputs;
  json["branch"] = finding.candidate.terms[0].place.workpiece ? "workpiece" : "tool";
  add_place(json, finding.candidate, machine);
  json["term"] = term_text(finding.candidate);
  json["parameters"] = Json::array();
  for (const fit::ParameterEstimate& item : finding.parameters) {
    json["parameters"].push_back(parameter_json(item));
    if (std::string note = reversal_note(finding.candidate, item); !note.empty())
      json["parameters"].back()["note"] = std::move(note);
  }
  json["rms_after_um"] = text::or_null(finding.rms_after_um);
  json["check_rms_before_um"] = text::or_null(finding.check_rms_before_um);
  json["check_rms_after_um"] = text::or_null(finding.check_rms_after_um);
  json["rms_after_urad"] = text::or_null(finding.rms_after_urad);
  json["check_rms_after_urad"] = text::or_null(finding.check_rms_after_urad);
  json["share"] = finding.share;
  json["p_value"] = finding.p_value;
  json["score"] = finding.score;
  json["accepted"] = finding.accepted;
  json["why_not"] = finding.why_not;
  json["signature"] = choice.effect->signature;
  json["impostors"] = choice.effect->impostors;
  json["exposed_by"] = choice.effect->exposed_by;
  json["confounded_with"] = finding.confounded_with;
  json["aliases"] = finding.aliases;
  return json;
}

Json cause_json(const diagnose::Cause& cause, const model::Machine& machine) {
  if (!cause.candidate)
    return {{"effect", "instrument"}, {"kind", cause.kind}, {"description", cause.description}};
  const effects::Candidate& candidate = *cause.candidate;
  Json json;
  json["effect"] = candidate.choice.effect->id;
  json["label"] = candidate.label;
  json["description"] = cause.description;
  json["axis"] = axis_json(candidate, cause.axis, machine);
  add_place(json, candidate, machine);
  if (cause.period) {
    const bool rotary = candidate.choice.axis && machine.axes[*candidate.choice.axis].rotary;
    json["period"] = {{"value", *cause.period}, {"unit", rotary ? "deg" : "mm"}};
  }
  json["evidence"] = cause.evidence;
  json["add"] = cause.add;
  return json;
}

/// The value of a quantity that is the same in all fit rows; `nullopt` if it varies.
std::optional<double> constant_value(const model::Measurement& m, const model::Column& column) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t row = 0; row < m.rows(); ++row) {
    const double value = column[static_cast<Eigen::Index>(row)];
    if (m.check[row] != 0 || std::isnan(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low == high ? std::optional<double>(low) : std::nullopt;
}

/// Do the fit rows have both approach directions of an axis?
bool shows_a_reversal(const model::Measurement& m, std::size_t axis) {
  bool forward = false, back = false;
  for (std::size_t row = 0; row < m.rows(); ++row) {
    const double sense = m.states.direction[axis][static_cast<Eigen::Index>(row)];
    forward = forward || (m.check[row] == 0 && sense > 0);
    back = back || (m.check[row] == 0 && sense < 0);
  }
  return forward && back;
}

/// Effects that these rows cannot show, for every verdict.
void add_not_covered(text::Assurance& assurance, const model::Machine& machine, const model::Measurement& m) {
  std::string one_way;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const model::Axis& axis = machine.axes[i];
    if (const auto at = constant_value(m, model::commanded(m, i)))
      assurance.not_covered(fmt::format("{} is at {:.6g} {} in every row: errors along {} are not covered.",
                                        axis.name, *at, axis.rotary ? "deg" : "mm", axis.name));
    else if (!shows_a_reversal(m, i))
      one_way += (one_way.empty() ? "" : ", ") + axis.name;
  }
  if (!one_way.empty())
    assurance.not_covered(fmt::format(
        "The rows do not have both approach directions of {}: reversal errors are not covered.", one_way));
  for (std::size_t i = 0; i < machine.inputs.size(); ++i)
    if (const auto at = constant_value(m, m.states.input[i]))
      assurance.not_covered(fmt::format("{0} is {1:.6g} {2} in every row: errors with {0} are not covered.",
                                        machine.inputs[i].name, *at, machine.inputs[i].unit));
  if (!fit::has_uncertainty(m))
    assurance.not_covered(
        "The rows have no u: the size of the noise is not known, and the residual was tested only for "
        "structure.");
}

/// Only one verdict has an assurance: no error can be added to the model.
text::Assurance assurance_of(const diagnose::Diagnosis& diagnosis, const model::Measurement& m) {
  text::Assurance assurance(text::AssuranceKind::kDiagnose);
  assurance.require("verdict-consistent", diagnosis.verdict == diagnose::Verdict::kConsistent,
                    std::string("The verdict is ") + diagnose::verdict_name(diagnosis.verdict) + ".");
  assurance.require("fit-converged", diagnosis.end.converged,
                    diagnosis.end.converged ? "The fit converged." : "The fit did not converge.");
  assurance.require("readings-of-this-machine", diagnosis.end.absurd.empty(),
                    diagnosis.end.absurd.empty() ? "The residuals are small enough for readings of this "
                                                   "machine: units, signs and columns are plausible."
                                                 : diagnosis.end.absurd + ".");
  assurance.at_least("residual-is-noise", diagnosis.left.omnibus_p,
                     diagnose::DiagnoseThresholds().verdict.structure,
                     "Probability that noise alone causes a residual with at least as much structure.");
  add_not_covered(assurance, diagnosis.base.machine, m);
  return assurance;
}

}  // namespace

std::string reversal_note(const effects::Candidate& candidate, const fit::ParameterEstimate& parameter) {
  std::vector<ChainTerm> terms;
  for (const effects::CandidateTerm& term : candidate.terms)
    terms.push_back({model::parse_expression(term.text), term.place.workpiece});
  return reversal_note(terms, parameter.name, parameter.value, parameter.unit);
}

Json diagnosis_json(const diagnose::Diagnosis& diagnosis, const model::Measurement& measurement) {
  Json json;
  json["verdict"] = diagnose::verdict_name(diagnosis.verdict);
  json["explanation"] = diagnosis.explanation;
  json["rms_um"] = text::or_null(diagnosis.base.after.rms_um);
  json["check_rms_um"] = text::or_null(diagnosis.base.check.rms_um);
  json["noise_um"] = text::or_null(diagnosis.base.noise_um);
  json["rms_urad"] = text::or_null(diagnosis.base.after.rms_urad);
  json["check_rms_urad"] = text::or_null(diagnosis.base.check.rms_urad);
  json["noise_urad"] = text::or_null(fit::noise_urad(measurement));
  json["noise_model"] = noise_json(diagnosis.noise, diagnosis.noise_unit);
  json["n_obs"] = diagnosis.base.before.count;
  json["n_params"] = diagnosis.base.parameters.size();
  json["n_excluded"] = measurement.excluded;
  json["n_searched"] = diagnosis.searched;
  json["candidates"] = Json::array();
  for (const diagnose::CandidateFinding& finding : diagnosis.candidates)
    json["candidates"].push_back(candidate_json(finding, diagnosis.base.machine));
  const auto causes_json = [&](const std::vector<diagnose::Cause>& causes) {
    Json list = Json::array();
    for (const diagnose::Cause& cause : causes) list.push_back(cause_json(cause, diagnosis.base.machine));
    return list;
  };
  json["ladder"] = Json::array();
  for (const diagnose::LadderStep& step : diagnosis.ladder) {
    const bool given = step.effect.empty();
    json["ladder"].push_back({{"effect", given ? Json(nullptr) : Json(step.effect)},
                              {"add", given ? Json(nullptr) : Json(step.add)},
                              {"label", given ? "the model as given" : step.label},
                              {"said", given ? "the model as given" : step.said},
                              {"rms_um", text::or_null(step.rms_um)},
                              {"check_rms_um", text::or_null(step.check_rms_um)},
                              {"rms_urad", text::or_null(step.rms_urad)},
                              {"check_rms_urad", text::or_null(step.check_rms_urad)},
                              {"check_files", check_files_json(step)},
                              {"confirmed", step.confirmed ? Json(*step.confirmed) : Json(nullptr)},
                              {"confirmed_by", !step.confirmed      ? Json(nullptr)
                                               : step.of_check_rows ? Json("check rows")
                                                                    : Json("held-out runs")},
                              {"evidence", text::or_null(step.evidence)},
                              {"certain", given ? Json(nullptr) : Json(step.certain)},
                              {"causes", causes_json(step.causes)},
                              {"chi2_per_dof", step.chi_square_per_freedom}});
  }
  json["causes"] = causes_json(diagnosis.causes);
  json["level"] = diagnose::kLevelOfCauses;
  const bool open = diagnosis.verdict == diagnose::Verdict::kAmbiguous;
  json["separate_by"] = open ? Json(diagnosis.next_measurement) : Json::array();
  json["remaining"] = {{"chi2_per_dof", diagnosis.remaining.chi_square_per_freedom},
                       {"is_noise", diagnosis.remaining.is_noise}};
  if (diagnosis.left_out)
    json["left_out"] = {{"rows", diagnosis.left_out->rows},
                        {"check_rows", diagnosis.left_out->check_rows},
                        {"check_rms_um", text::or_null(diagnosis.left_out->check_rms_um)},
                        {"check_rms_urad", text::or_null(diagnosis.left_out->check_rms_urad)}};
  json["runner_up"] = Json(nullptr);
  if (diagnosis.runner_up) {
    const diagnose::CandidateFinding& runner = diagnosis.candidates[*diagnosis.runner_up];
    json["runner_up"] = {{"effect", runner.candidate.choice.effect->id},
                         {"label", runner.candidate.label},
                         {"said", runner.candidate.spoken},
                         {"distance", diagnosis.runner_up_distance}};
  }
  add_failure(json, diagnosis.failure);
  json["left_p_value"] = diagnosis.left.omnibus_p;
  json["next_measurement"] = diagnosis.next_measurement;
  json["assurance"] = assurance_of(diagnosis, measurement).json();
  return json;
}

}  // namespace vernier::results
