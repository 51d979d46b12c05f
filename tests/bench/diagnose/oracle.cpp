// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/diagnose/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/bench/diagnose/answer.h"
#include "tests/support/hidden_survey_noise.h"
#include "tools/diagnose/propose/pool.h"
#include "tools/fit/fit.h"
#include "tools/model/machine_reader.h"

namespace vernier::bench {

using namespace vernier::diagnose;
using namespace vernier::model;
using support::HiddenSurvey;
using support::NoiseLaw;
namespace {

/// A random walk along the time in runs: an Ornstein-Uhlenbeck process that outlasts every run.
void set_walk(fit::NoiseModel& noise, const Measurement& m, double size, double span) {
  double time = 0;
  for (std::size_t row = 1; row < m.rows(); ++row)
    if (m.states.of(m.states.setup, row) == m.states.of(m.states.setup, row - 1))
      time +=
          m.states.time[static_cast<Eigen::Index>(row)] - m.states.time[static_cast<Eigen::Index>(row) - 1];
  const double rate = 6 * size * size / std::max(time, 1e-9);  // a walk of rms 1 about its mean: T rate / 6
  noise.in_time = true;
  noise.time_constant = 10 * span;
  noise.drift = std::sqrt(rate * noise.time_constant / 2);
}

/// In units of weighted readings.
fit::NoiseModel true_noise(const HiddenSurvey& survey, const Evidence& evidence) {
  fit::NoiseModel noise;
  switch (survey.spec.noise) {
    case NoiseLaw::kTwice:
      noise.own = 2;
      break;
    case NoiseLaw::kSetUps:
      noise.run = 1;
      break;
    case NoiseLaw::kAutoregressive:
      noise.own = 0.02;  // all but nothing is a reading's own
      noise.drift = 1;
      noise.time_constant = -1 / std::log(support::kAutoregression);
      break;
    case NoiseLaw::kWalk:
    case NoiseLaw::kWalkNoU:
      set_walk(noise, evidence.measurement(), 1, evidence.layout().span);
      break;
    case NoiseLaw::kPoses:
      noise.pose = 1;
      break;
    default:
      break;
  }
  const double unit = fit::has_uncertainty(evidence.measurement()) ? 1 : survey.u;
  for (double* part : {&noise.own, &noise.pose, &noise.run, &noise.drift}) *part *= unit;
  return noise;
}

Measurement without_wild(const HiddenSurvey& survey, Measurement rows) {
  if (survey.wild.empty()) return rows;
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    if (!std::binary_search(survey.wild.begin(), survey.wild.end(), row)) keep.push_back(row);
  return select_rows(rows, keep);
}

/// As the JSON of a diagnosis names a candidate.
nlohmann::json in_json(const Machine& machine, const effects::AxisPlaces& axes,
                       const effects::Candidate& candidate) {
  const effects::Choice& choice = candidate.choice;
  const bool by_place = !choice.axis && choice.place;
  const std::optional<std::size_t> own = by_place ? axes.axis_of(*choice.place) : choice.axis;
  nlohmann::json axis;
  if (own && !choice.axis2) axis = machine.axes[own.value_or(0)].name;
  return {{"effect", choice.effect->id},
          {"axis", axis},
          {"input", choice.inputs.empty() ? nlohmann::json() : nlohmann::json(choice.inputs[0])},
          {"inputs", choice.inputs}};
}

}  // namespace

OracleAnswer ask_oracle(const HiddenSurvey& survey) {
  const Machine given = effects::with_base_row(parse_machine(survey.model, "model.xml"));
  const Measurement rows = without_wild(survey, parse_measurement(survey.csv, "survey.csv", given));
  fit::FitOptions independent;
  independent.noise = fit::NoiseModel{};
  Evidence evidence(fit::fit(given, rows, independent).machine, rows);
  evidence.assume(true_noise(survey, evidence));
  const std::vector<effects::Effect> catalogue = effects::built_in_effects();
  const std::vector<ScannedCandidate> list = enumerate_candidates(evidence, catalogue);
  Scanner scanner(evidence, list);
  Pool pool(evidence, scanner);
  const Eigen::MatrixXd nothing(evidence.residual().size(), 0);
  std::vector<Scored> scored = scanner.scan(AcceptedColumns(nothing), [](double) {});
  for (Scored& fine : scanner.scan_fine(nothing)) scored.push_back(std::move(fine));
  pool.add(scored, nothing);
  std::vector<std::size_t> items;
  const SelectionProblem problem = pool.problem(items);
  const effects::AxisPlaces axes(evidence.machine());
  double best = std::numeric_limits<double>::infinity(), best_right = best;
  for (std::size_t entry = 0; entry < items.size(); ++entry) {
    const SelectionEntry& one = problem.entries[entry];
    const double price =
        (static_cast<double>(one.count) + static_cast<double>(one.scanned)) * std::log(problem.observations) +
        one.penalty;
    const double value = evaluate_selection(problem, {entry}).chi_square + price;
    best = std::min(best, value);
    const nlohmann::json candidate = in_json(evidence.machine(), axes, pool.candidate(items[entry]));
    if (std::any_of(survey.effects.begin(), survey.effects.end(),
                    [&](const support::HiddenEffect& hidden) { return names(hidden, candidate); }))
      best_right = std::min(best_right, value);
  }
  // One column at two places differs by the price of the place, at most a fifth.
  constexpr double kOneColumn = 0.25;
  OracleAnswer answer;
  answer.named = problem.chi_square - best > evidence.thresholds().acceptance.evidence;
  answer.right = answer.named && best_right < best + kOneColumn;
  return answer;
}

std::vector<double> parameter_errors(const HiddenSurvey& survey) {
  const Machine truth = parse_machine(survey.truth, "truth.xml");
  const fit::FitResult result = fit::fit(truth, parse_measurement(survey.csv, "survey.csv", truth));
  const Eigen::VectorXd true_values = result.parameters.get(truth);
  std::vector<double> errors;
  for (std::size_t i = 0; i < result.estimates.size(); ++i) {
    const fit::ParameterEstimate& one = result.estimates[i];
    if (one.from != fit::Origin::kData || result.parameters[i].kind == ParameterKind::kBaseShift) continue;
    errors.push_back((one.value - true_values[static_cast<Eigen::Index>(i)]) / one.std);
  }
  return errors;
}

}  // namespace vernier::bench
