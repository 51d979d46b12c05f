// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

#include "tools/effects/reversal.h"
#include "tools/fit/coverage/domain.h"
#include "tools/fit/coverage/reach.h"
#include "tools/fit/decisions.h"
#include "tools/fit/size.h"
#include "tools/format/columns.h"
#include "tools/kinematics/correction.h"
#include "tools/maths/factors.h"
#include "tools/results/detail.h"
#include "tools/results/fit_findings.h"
#include "tools/text/optional_json.h"

namespace vernier::results {
namespace {

using nlohmann::ordered_json;

std::size_t observations_of_fit_rows(const model::Measurement& m) {
  std::size_t count = 0;
  for (const model::Observation& o : m.observations) count += m.check[o.row] == 0 ? 1U : 0U;
  return count;
}

ordered_json shared(const model::Machine& machine, const model::Measurement& m,
                    const fit::RoleStatistics& before, const fit::RoleStatistics& fit,
                    const fit::RoleStatistics& check, std::size_t parameters) {
  return {{"machine", machine.name},
          {"machine_file", machine.file},
          {"files", m.files},
          {"rms_before_um", text::or_null(before.rms_um)},
          {"rms_um", text::or_null(fit.rms_um)},
          {"check_rms_um", text::or_null(check.rms_um)},
          {"max_um", text::or_null(fit.max_um)},
          {"check_max_um", text::or_null(check.max_um)},
          {"rms_before_urad", text::or_null(before.rms_urad)},
          {"rms_urad", text::or_null(fit.rms_urad)},
          {"check_rms_urad", text::or_null(check.rms_urad)},
          {"max_urad", text::or_null(fit.max_urad)},
          {"check_max_urad", text::or_null(check.max_urad)},
          {"noise_um", text::or_null(fit::noise_um(m))},
          {"noise_urad", text::or_null(fit::noise_urad(m))},
          {"n_obs", observations_of_fit_rows(m)},
          {"n_check", check.count},
          {"n_params", parameters},
          {"n_excluded", m.excluded}};
}

/// Uncertainty of the model at the compared positions: rms and largest over the rows, um. Null for a machine
/// that was never fitted.
ordered_json prediction_std_json(const model::Machine& machine, const model::Measurement& m) {
  const fit::Reach reach(machine);
  if (!reach.known() || m.rows() == 0) return nullptr;
  const Eigen::VectorXd std_um = reach.std_of_machine_um(m.states);
  return {{"rms", std::sqrt(std_um.squaredNorm() / static_cast<double>(std_um.size()))},
          {"max", std_um.maxCoeff()}};
}

/// Tilt of the tool by the modelled errors over the rows, deg: a machine with rotary axes can correct the
/// direction of the tool. Null for a machine of linear axes.
ordered_json tilt_json(const model::Machine& machine, const model::Measurement& m) {
  const bool turns = std::any_of(machine.axes.begin(), machine.axes.end(),
                                 [](const model::Axis& axis) { return axis.rotary; });
  if (!turns || m.rows() == 0) return nullptr;
  const model::Column tilt = kinematics::tilt_between(
      model::forward(machine, m.states), model::forward(model::nominal_machine(machine), m.states));
  return {{"rms", std::sqrt(tilt.square().mean())}, {"max", tilt.maxCoeff()}};
}

ordered_json size_json(const fit::SizeOfMachine& size) {
  ordered_json json = {{"known", size.known}, {"from", size.from}};
  if (size.relative_std > 0) json["relative_std"] = size.relative_std;
  if (!size.fixed.empty()) json["fixed_lengths"] = size.fixed;
  json["sentence"] = fit::size_sentence(size);
  return json;
}

ordered_json three_numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

ordered_json things_json(const std::vector<fit::ThingEstimate>& things) {
  ordered_json list = ordered_json::array();
  for (const fit::ThingEstimate& one : things) {
    ordered_json json = {{"name", one.name},
                         {"type", one.type},
                         {"setup", one.setup},
                         {"frame", one.in_measuring_frame ? "measuring" : "workpiece"},
                         {"touches", one.touches},
                         {"place_mm", three_numbers(one.place_mm)},
                         {"u_place_mm", three_numbers(one.u_place_mm)}};
    if (one.direction) {
      json["direction"] = three_numbers(*one.direction);
      json["u_direction_deg"] = one.u_direction_deg;
    }
    if (one.radius_mm) {
      json["radius_mm"] = *one.radius_mm;
      json["u_radius_mm"] = one.u_radius_mm;
    }
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

ordered_json fit_json(const fit::FitResult& result, const model::Measurement& m) {
  ordered_json json =
      shared(result.machine, m, result.before, result.after, result.check, result.parameters.size());
  if (result.only_set_up) json["rms_only_set_up_um"] = text::or_null(result.only_set_up->rms_um);
  json["parameters"] = ordered_json::array();
  const std::vector<ChainTerm> chain = chain_expressions(result.machine);
  for (const fit::ParameterEstimate& item : result.estimates) {
    json["parameters"].push_back({{"name", item.name},
                                  {"value", item.value},
                                  {"std", item.std},
                                  {"unit", item.unit},
                                  {"from", fit::origin_name(item.from)},
                                  {"scale", item.scale}});
    if (std::string note = reversal_note(chain, item.name, item.value, item.unit); !note.empty())
      json["parameters"].back()["note"] = std::move(note);
  }
  json["noise_model"] = noise_json(result.noise, fit::noise_unit(m));
  json["unidentifiable"] = ordered_json::array();
  for (const auto& group : result.observability.unidentifiable) {
    ordered_json names = ordered_json::array();
    for (const std::size_t i : group) names.push_back(result.parameters[i].name);
    json["unidentifiable"].push_back(names);
  }
  json["assurance"] = assurance_of(result).json();
  json["findings"] = findings_json(result.machine);
  json["convention"] = ordered_json::array();
  for (const fit::Decision& decision : fit::decisions_of(result))
    json["convention"].push_back({{"parameters", decision.parameters},
                                  {"reach_um", decision.reach_um},
                                  {"sentence", decision.sentence}});
  if (result.size) {
    json["size"] = size_json(*result.size);
    json["things"] = things_json(result.things);
  }
  json["stages"] = ordered_json::array();
  for (const fit::StageFigures& stage : result.stages)
    json["stages"].push_back({{"patterns", stage.patterns},
                              {"n_params", stage.parameters},
                              {"iterations", stage.iterations},
                              {"rms_um", text::or_null(stage.fit.rms_um)},
                              {"check_rms_um", text::or_null(stage.check.rms_um)}});
  json["noise_model"]["kind"] = std::string(result.noise.independent() ? "white" : "correlated") +
                                (fit::has_uncertainty(m) ? ", u given" : ", from the residual");
  json["noise_model"]["scale_of_u"] =
      fit::has_uncertainty(m) ? ordered_json(std::sqrt(result.variance_factor)) : ordered_json(nullptr);
  if (!result.file_factors.empty()) {
    json["noise_model"]["files"] = ordered_json::array();
    for (const fit::FileFactor& one : result.file_factors)
      json["noise_model"]["files"].push_back({{"file", one.name}, {"scale_of_u", one.factor}});
  }
  json["misfit_um"] = 1000 * result.misfit_mm;
  json["reach_mm"] = result.reach_mm;
  json["weakest"] = ordered_json::array();
  for (const fit::Observability::Weak& weak : result.observability.weakest) {
    ordered_json names = ordered_json::array();
    for (const std::size_t i : weak.parts) names.push_back(result.parameters[i].name);
    json["weakest"].push_back({{"ratio", weak.ratio}, {"parameters", names}});
  }
  json["correlations"] = ordered_json::array();
  for (const fit::Correlation& c : result.correlations)
    json["correlations"].push_back(
        {result.parameters[c.first].name, result.parameters[c.second].name, c.value});
  json["priors"] = ordered_json::array();
  for (const auto& [name, std] : result.priors) json["priors"].push_back({{"name", name}, {"std", std}});
  json["normalised_check_rms"] =
      result.normalised_check ? ordered_json(result.normalised_check->rms) : ordered_json(nullptr);
  json["normalised_check_within_3"] =
      result.normalised_check ? ordered_json(result.normalised_check->within_3) : ordered_json(nullptr);
  json["rank"] = result.observability.rank;
  json["condition"] = result.observability.condition;
  json["chi_square"] = result.chi_square;
  json["degrees_of_freedom"] = result.freedom;
  json["iterations"] = result.iterations;
  json["converged"] = result.converged;
  json["domains"] = domains_json(result.machine, m);
  json["notes"] = result.machine.notes;
  return json;
}

std::vector<ChainTerm> chain_expressions(const model::Machine& machine) {
  std::vector<ChainTerm> list;
  for (const auto* branch : {&machine.workpiece, &machine.tool})
    for (const model::Transform& transform : *branch)
      for (std::size_t i = 0; i < transform.dof_count(); ++i)
        list.push_back({transform.dof[i], branch == &machine.workpiece});
  return list;
}

std::string reversal_note(const std::vector<ChainTerm>& terms, const std::string& name, double value,
                          const std::string& unit) {
  const bool length = unit == "mm";
  if (!length && unit != "deg") return {};
  for (const ChainTerm& term : terms)
    if (const auto found = effects::direction_coefficient(*term.expression, name))
      return fmt::format("coefficient of {}; reversal value B = {:.4g} {}", found->direction,
                         (term.workpiece && length ? -2 : 2) * found->factor * value *
                             (length ? maths::kUmPerMm : maths::kArcsecPerDeg),
                         length ? "um" : "arcsec");
  return {};
}

ordered_json compare_json(const model::Machine& machine, const model::Measurement& m,
                          const Eigen::VectorXd& residual) {
  const fit::RoleStatistics fit = fit::role_statistics(m, residual, false),
                            check = fit::role_statistics(m, residual, true);
  ordered_json json = shared(machine, m, fit, fit, check, 0);
  json["parameters"] = ordered_json::array();
  json["unidentifiable"] = ordered_json::array();
  json["prediction_std_um"] = prediction_std_json(machine, m);
  json["tilt_deg"] = tilt_json(machine, m);
  json["stretches"] = stretches_json(m, residual);
  json["circular"] = circular_json(machine, m);
  json["domains"] = domains_json(machine, m);
  json["notes"] = machine.notes;
  return json;
}

ordered_json domains_json(const model::Machine& machine, const model::Measurement& m) {
  ordered_json json = ordered_json::array();
  for (const fit::DomainUse& use : fit::domain_use(machine, m))
    json.push_back({{"domain", use.range.domain},
                    {"quantity", use.range.quantity},
                    {"low", use.range.open ? ordered_json(nullptr) : ordered_json(use.range.low)},
                    {"high", use.range.open ? ordered_json(nullptr) : ordered_json(use.range.high)},
                    {"least", use.least},
                    {"most", use.most},
                    {"rows_outside", use.faded},
                    {"rows_without_effect", use.gone}});
  return json;
}

void print_domains(std::FILE* out, const ordered_json& domains) {
  for (const ordered_json& use : domains)
    if (use["rows_outside"].get<std::size_t>() > 0)
      fmt::print(out,
                 "{}: {} is from {:.4g} to {:.4g}, the trained range is {:.4g} to {:.4g}: the term has a "
                 "reduced weight in {} rows, and the weight 0 in {} of these rows\n",
                 use["domain"].get<std::string>(), use["quantity"].get<std::string>(),
                 use["least"].get<double>(), use["most"].get<double>(), use["low"].get<double>(),
                 use["high"].get<double>(), use["rows_outside"].get<std::size_t>(),
                 use["rows_without_effect"].get<std::size_t>());
}

ordered_json stretches_json(const model::Measurement& m, const Eigen::VectorXd& residual) {
  struct Stretch {
    std::size_t run = 0, first_line = 0, last_line = 0, count = 0;
    char check = 0;
    double squares = 0;
  };
  std::vector<Stretch> list;
  std::vector<std::size_t> open(m.states.run_names.size(), SIZE_MAX);  // the stretch that a run is in
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if (model::is_rotation(o.kind)) continue;
    std::size_t& at = open[m.states.run[o.row]];
    if (at == SIZE_MAX || list[at].check != m.check[o.row]) {
      at = list.size();
      list.push_back({m.states.run[o.row], m.line[o.row], m.line[o.row], 0, m.check[o.row], 0});
    }
    Stretch& stretch = list[at];
    stretch.last_line = m.line[o.row];
    ++stretch.count;
    stretch.squares += residual[static_cast<Eigen::Index>(i)] * residual[static_cast<Eigen::Index>(i)];
  }
  ordered_json json = ordered_json::array();
  for (const Stretch& s : list)
    json.push_back({{"run", m.states.run_names[s.run]},
                    {"role", s.check != 0 ? "check" : "fit"},
                    {"first_line", s.first_line},
                    {"last_line", s.last_line},
                    {"n_obs", s.count},
                    {"rms_um", 1e3 * std::sqrt(s.squares / static_cast<double>(s.count))}});
  return json;
}

std::string number_or_dash(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.4g} {}", *value, unit) : std::string("-");
}

std::string error_or_dash(const std::optional<double>& um, const std::optional<double>& urad) {
  return um ? number_or_dash(um, "um") : number_or_dash(urad, "urad");
}

ordered_json noise_json(const fit::NoiseModel& noise, const fit::NoiseUnit& unit) {
  ordered_json steps = ordered_json::array();
  for (const fit::NoiseStep& step : noise.steps) {
    const bool rotation = model::is_rotation(static_cast<model::ObservationKind>(step.kind));
    const std::string name = fit::unit_name(rotation);
    steps.push_back({{"row", step.row + 1},
                     {"observation", format::name_of(static_cast<format::ReadingKind>(step.kind))},
                     {"height_" + name, step.height * unit.of(rotation)},
                     {"std_" + name, step.std * unit.of(rotation)}});
    if (step.of_set_up())
      steps.back()["along"] = format::columns::kPoint[static_cast<std::size_t>(step.component)];
  }
  const double size = unit.of_all();
  const std::string name = fit::unit_name(unit.angles_only);
  return {{"steps", steps},
          {"own_" + name, noise.own * size},
          {"pose_" + name, noise.pose * size},
          {"run_" + name, noise.run * size},
          {"drift_" + name, noise.drift * size},
          {"drift_in", fit::drifting_kinds(noise)},
          {"drift_time", noise.drift > 0 ? ordered_json(noise.time_constant) : ordered_json(nullptr)},
          {"drift_time_unit", noise.in_time ? "s" : "rows"},
          {"support", noise.support},
          {"sentence", fit::in_words(noise, unit)}};
}

}  // namespace vernier::results
