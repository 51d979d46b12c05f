// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "tools/fit/convention.h"
#include "tools/fit/coverage/alternatives.h"
#include "tools/fit/coverage/far_rows.h"
#include "tools/fit/coverage/moved.h"
#include "tools/fit/coverage/unmeasured.h"
#include "tools/fit/coverage/unseen_turns.h"
#include "tools/fit/decisions.h"
#include "tools/fit/estimates_of_things.h"
#include "tools/fit/findings.h"
#include "tools/fit/least_squares/problem.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/sanity.h"
#include "tools/fit/selection.h"
#include "tools/fit/set_up.h"
#include "tools/fit/settle.h"
#include "tools/fit/size.h"
#include "tools/fit/solve.h"
#include "tools/format/columns.h"
#include "tools/format/readings.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/fit_record.h"

namespace vernier::fit {
namespace {

/// Returns the indices of the rows that the fit needs: the fit rows, or all rows if lag makes a row depend on
/// those before it.
std::vector<std::size_t> kept_for_fit(const model::Machine& machine, const model::Measurement& all) {
  const bool whole = model::uses_lag(machine);
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < all.rows(); ++row)
    if (whole || all.check[row] == 0) keep.push_back(row);
  return keep;
}

/// An estimate comes from data if the convention may move it by less than this share of its
/// standard uncertainty (three times this share, one time in 400, is still 1 %). It comes from the
/// prior if its uncertainty is not smaller than this share of the prior.
constexpr double kMovedByConvention = 0.003, kFromPrior = 0.95;

Origin origin_of(const FitResult& result, std::size_t i, double std, const Settled& end) {
  const auto at = static_cast<Eigen::Index>(i);
  if (std > kFromPrior * end.scale[at]) return Origin::kPrior;
  if (result.observability.determined[i] == 0) {
    const auto& groups = result.observability.unidentifiable;
    const bool alone = std::any_of(groups.begin(), groups.end(),
                                   [&](const auto& group) { return group.size() == 1 && group[0] == i; });
    return alone ? Origin::kPrior : Origin::kConvention;
  }
  return end.bias[at] <= kMovedByConvention * std ? Origin::kData : Origin::kConvention;
}

/// Returns the statistics of the fit rows for the given machine with the set-up of the convention. nullopt:
/// no set-up is free, or the set-up of the file is as near.
std::optional<RoleStatistics> with_only_set_up(const FitResult& result, const model::Machine& machine,
                                               const Eigen::VectorXd& centre, const model::Measurement& m) {
  Eigen::VectorXd values = result.parameters.get(machine);
  bool any = false;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    if (!model::is_set_up(result.parameters[i].kind)) continue;
    const auto at = static_cast<Eigen::Index>(i);
    values[at] = centre[at];
    any = true;
  }
  if (!any) return std::nullopt;
  model::Machine placed = machine;
  result.parameters.set(placed, values);
  const RoleStatistics there = role_statistics(m, residuals(placed, m), false);
  const bool nearer = there.rms_um.value_or(0) < result.before.rms_um.value_or(0);
  return nearer ? std::optional(there) : std::nullopt;
}

void estimate(FitResult& result, const Settled& end, const Eigen::VectorXd& centre) {
  result.observability = observe(end.normal);
  result.observability.covariance = end.covariance / end.variance;
  result.covariance = end.covariance;
  result.open = end.open;
  result.chi_square = end.chi_square;
  result.freedom = end.freedom;
  result.variance_factor = end.variance;
  result.noise = end.noise;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double std = std::sqrt(std::max(0.0, end.covariance(at, at)));
    result.estimates.push_back({result.parameters[i].name, result.parameters[i].unit, end.point[at], std,
                                end.scale[at], origin_of(result, i, std, end), centre[at]});
  }
}

/// Returns 1 / std^2 of each parameter that a prior names, 0 for the others. A prior that matches
/// nothing is an error.
StatedPriors stated_priors(FitResult& result, const FitOptions& options, const Convention& convention) {
  StatedPriors stated{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(result.parameters.size())),
                      convention.centre};
  for (const Prior& prior : options.priors) {
    bool found = false;
    for (std::size_t i = 0; i < result.parameters.size(); ++i) {
      if (!matches_pattern(prior.pattern, result.parameters[i].name)) continue;
      found = true;
      stated.weight[static_cast<Eigen::Index>(i)] = 1 / (prior.std * prior.std);
      result.priors.emplace_back(result.parameters[i].name, prior.std);
    }
    if (!found)
      throw text::InputError(fmt::format(
          "\"{}\": no free parameter has this name (the JSON result of fit lists the names)", prior.pattern));
  }
  return stated;
}

/// Holds the rotations of the set-ups that no reading shows, if the fit turned one of them far away: such a
/// turn only rotates errors of the machine into another direction. One turn takes the others with it, so all
/// are held. Returns true if rotations are held now.
bool hold_turned_away(const Settled& end, Convention& convention) {
  constexpr double kAligned_deg = 5;  // an instrument that is aligned to a machine by eye
  bool away = false;
  for (std::size_t i = 0; i < convention.unseen_turn.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    away = away ||
           (convention.unseen_turn[i] && std::abs(end.point[at] - convention.centre[at]) >= kAligned_deg);
  }
  for (std::size_t i = 0; away && i < convention.unseen_turn.size(); ++i)
    if (convention.unseen_turn[i]) convention.scale[static_cast<Eigen::Index>(i)] = kHeldTurn_deg;
  return away;
}

/// A model without free parameters: only its residual is computed.
Settled nothing_free(const FitProblem& problem, std::size_t observations, bool with_u) {
  Settled end;
  end.point.resize(0);
  end.chi_square = problem.cost(end.point);
  end.freedom = static_cast<double>(observations);
  const double reduced = end.chi_square / end.freedom;
  end.variance = with_u ? std::max(1.0, reduced) : reduced;
  end.converged = true;
  return end;
}

std::vector<Correlation> strong_correlations(const Observability& seen) {
  // Correlation above which two standard uncertainties must be reported together: 1 - r^2 is below
  // a fifth.
  constexpr double kStrong = 0.9;
  std::vector<Correlation> list;
  const Eigen::VectorXd std = seen.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  for (Eigen::Index i = 0; i < std.size(); ++i)
    for (Eigen::Index k = 0; k < i; ++k) {
      const auto first = static_cast<std::size_t>(k), second = static_cast<std::size_t>(i);
      if (seen.determined[first] == 0 || seen.determined[second] == 0 || std[i] <= 0 || std[k] <= 0) continue;
      const double value = seen.covariance(i, k) / (std[i] * std[k]);
      if (std::abs(value) > kStrong) list.push_back({first, second, value});
    }
  std::sort(list.begin(), list.end(),
            [](const Correlation& a, const Correlation& b) { return std::abs(a.value) > std::abs(b.value); });
  return list;
}

/// Returns the residual of the fit, mm; rotations at the reach.
double left_mm(const FitResult& result) {
  const double turns_mm = result.after.rms_urad.value_or(0) * 1e-6 * result.reach_mm;
  return std::max(result.after.rms_um.value_or(0) * 1e-3, turns_mm);
}

void judge(FitResult& result, const model::Machine& machine, const model::Measurement& measurement,
           const Settled& end, std::size_t readings) {
  result.absurd = collapse_of(result.machine, result.parameters, measurement);
  result.worst = worst_reading(measurement, result.residual, false);
  result.worst_check = worst_reading(measurement, result.residual, true);
  // A load or a homing error at one place may be large in a measured box that is small.
  const double size_mm = std::max(result.reach_mm, half_travel_mm(machine));
  const bool misses = left_mm(result) > kAbsurdResidual * size_mm;
  const bool misses_box = left_mm(result) > kAbsurdResidual * result.reach_mm;
  // Free tables can follow two swapped columns. The nominal machine cannot, so it is tested too.
  const bool far_off = result.misfit_mm > kFarOff * result.reach_mm;
  if (!result.absurd.empty() || (result.converged && !misses_box && !far_off)) return;
  const LikelyMistake likely = likely_mistake(machine, measurement, result.worst, !misses);
  std::string mistake = likely.sentence;
  if (result.converged && !misses && mistake.empty()) return;
  if (mistake.empty()) mistake = missing_set_up(machine, measurement, result.misfit_mm);
  if (!likely.one_reading) result.mistake = mistake;
  result.absurd =
      !result.converged ? fmt::format("the fit did not converge in {} iterations", result.iterations)
      : misses
          ? fmt::format("the residual of the fit is {:.3g} mm in a measured box of +- {:.3g} mm",
                        left_mm(result), result.reach_mm)
          : fmt::format("the residual of the nominal machine is {:.3g} mm in a measured box of +- {:.3g} mm",
                        result.misfit_mm, result.reach_mm);
  if (mistake.empty())
    mistake = far_rows(measurement, [&](const model::Measurement& rows) { return set_up(machine, rows); });
  if (mistake.empty() && !result.converged) mistake = unbelievable_u(measurement, result.residual);
  if (mistake.empty() && !result.converged)
    mistake = blame_of(result, end.converged ? Eigen::VectorXd() : end.last_step, readings);
  if (!mistake.empty()) result.absurd += ": " + mistake;
}

/// Finds what moved during the survey outside the machine: the largest step or drift of the
/// instrument, or a residual far above its noise, divided by the residual of the nominal machine.
/// Returns true if the instrument or the set-up did; false if the residual alone is far above its noise,
/// which a missing effect does as well.
bool find_disturbance(const FitResult& result, const model::Measurement& rows, const model::Measurement& all,
                      const Convention& convention, bool robust, model::FitRecord& record) {
  const auto offer = [&](double mm, std::string words) {
    if (!(mm / result.misfit_mm > record.disturbed)) return;
    record.disturbed = mm / result.misfit_mm;
    record.disturbance = std::move(words);
  };
  const NoiseUnit unit = noise_unit(rows);
  for (const NoiseStep& step : result.noise.steps) {
    const auto kind = static_cast<model::ObservationKind>(step.kind);
    if (model::is_rotation(kind)) continue;
    const double size_um = std::abs(step.height) * (step.unit > 0 ? step.unit : unit.um);
    offer(1e-3 * size_um, fmt::format("a step of {:.3g} um in {} from {} on", size_um,
                                      format::name_of(static_cast<format::ReadingKind>(step.kind)),
                                      step.row < all.line.size()
                                          ? fmt::format("row {} ({}:{})", step.row + 1,
                                                        all.files[all.file[step.row]], all.line[step.row])
                                          : fmt::format("row {}", step.row + 1)));
  }
  // A drift of one kind alone is more often an error of the model in one direction.
  const double drift = result.noise.drifts == 0 ? result.noise.drift * unit.of_all() : 0;
  offer(unit.angles_only ? drift / maths::kArcsecPerDeg * maths::kRadPerDeg * result.reach_mm : 1e-3 * drift,
        fmt::format("a drift of {:.3g} {}", drift, unit_name(unit.angles_only)));
  constexpr double kFarAbove = 5;  // times the noise
  const std::string of_instrument = record.disturbance;
  if (!robust && result.noise_um && 1e3 * left_mm(result) > kFarAbove * *result.noise_um)
    offer(left_mm(result), fmt::format("the residual is {:.3g} um, and the noise of the readings is {:.3g} "
                                       "um: the model lacks an effect, or the survey was disturbed",
                                       1e3 * left_mm(result), *result.noise_um));
  const bool only_residual = record.disturbance != of_instrument;
  // A shift whose direction rotates with the pose is not a step of any reading. Its influence on
  // the nominal machine would hide it in a share of that residual.
  constexpr double kAbove = 2;  // times the noise
  if (robust || result.parameters.size() == 0 ||
      (result.noise_um && 1e3 * left_mm(result) < kAbove * *result.noise_um))
    return !only_residual;
  model::Machine nominal = result.machine;
  result.parameters.set(nominal, convention.centre);
  const auto move = find_move(result.machine, rows, result.parameters, convention.centre, convention.scale,
                              residuals(nominal, rows));
  if (!move || move->share <= record.disturbed) return !only_residual;
  record.disturbed = move->share;
  record.disturbance = move->words;
  return true;
}

/// A residual far above its noise is no evidence of a disturbance: the finding of a missing effect states it.
void leave_one_cause(std::vector<model::FitRecord::Finding>& findings) {
  const bool missing = std::any_of(findings.begin(), findings.end(),
                                   [](const auto& one) { return one.code == "something-missing"; });
  const auto disturbed =
      std::find_if(findings.begin(), findings.end(), [](const auto& one) { return one.code == "disturbed"; });
  if (disturbed == findings.end()) return;
  if (missing)
    findings.erase(disturbed);
  else
    disturbed->text = "The model lacks an effect, or the survey was disturbed.";
}

/// Returns the noise for later checks of the machine. Steps of the instrument apply only to that
/// day.
std::optional<model::FitRecord::Noise> kept_noise(const NoiseModel& noise, const model::Measurement& rows) {
  std::vector<std::size_t> fitted;
  bool of_u = false;
  for (std::size_t i = 0; i < rows.observations.size(); ++i) {
    if (rows.check[rows.observations[i].row] != 0) continue;
    fitted.push_back(i);
    of_u = of_u || model::uncertainty_of(rows, rows.observations[i]) > 0;
  }
  constexpr double kAsStated = 1.1;  // times u
  if (noise.shared() <= 0 && (!of_u || noise.own <= kAsStated)) return std::nullopt;
  return model::FitRecord::Noise{noise.own,           noise.pose,
                                 noise.run,           noise.drift,
                                 noise.time_constant, noise_layout(rows, fitted).step,
                                 noise.in_time,       of_u,
                                 noise.drifts};
}

/// True if a term of the machine follows the order of the rows.
bool counts_visits(const model::Machine& machine) {
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch)
      for (std::size_t dof = 0; dof < transform.dof_count(); ++dof)
        if (model::has_symbol(*transform.dof[dof], {model::SymbolKind::kVisit, 0})) return true;
  return false;
}

/// Returns the measured ranges of axes, inputs and the time, and of the visits if a term follows them.
std::vector<model::FitRecord::Range> measured_ranges(const model::Machine& machine,
                                                     const model::Measurement& rows) {
  std::vector<std::size_t> fitted;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    if (rows.check[row] == 0) fitted.push_back(row);
  std::vector<model::FitRecord::Range> list;
  if (fitted.empty()) return list;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const model::Column q = model::commanded(rows, i)(fitted);
    list.push_back({machine.axes[i].name, q.minCoeff(), q.maxCoeff()});
  }
  for (std::size_t i = 0; i < machine.inputs.size(); ++i) {
    const model::Column value = rows.states.input[i](fitted);
    list.push_back({machine.inputs[i].name, value.minCoeff(), value.maxCoeff()});
  }
  const model::Column time = rows.states.time(fitted);
  if (time.maxCoeff() > time.minCoeff())
    list.push_back({format::columns::kTime, time.minCoeff(), time.maxCoeff()});
  const model::Column visit = rows.states.visit(fitted);
  if (counts_visits(machine) && visit.maxCoeff() > visit.minCoeff())
    list.push_back({format::columns::kVisit, visit.minCoeff(), visit.maxCoeff()});
  return list;
}

/// Returns the planes of unknown place that the tool point touched.
std::vector<model::FitRecord::Plane> touched_planes(const std::vector<ThingEstimate>& things) {
  std::vector<model::FitRecord::Plane> planes;
  const char* const type = model::kArtefactTypes[static_cast<std::size_t>(model::ArtefactType::kPlane)];
  for (const ThingEstimate& thing : things) {
    if (thing.type != type || thing.in_measuring_frame || !thing.direction) continue;
    const Eigen::Vector3d &place = thing.place_mm, &normal = *thing.direction;
    planes.push_back({thing.name, {place.x(), place.y(), place.z()}, {normal.x(), normal.y(), normal.z()}});
  }
  return planes;
}

/// Fills the record that the machine file keeps of the fit. all: including check rows; weighed: the same,
/// with u of the fit.
void remember(FitResult& result, const model::Measurement& rows, const model::Measurement& all,
              const model::Measurement& weighed, const Convention& convention, bool robust) {
  auto record = std::make_shared<model::FitRecord>();
  record->converged = result.converged;
  record->rms_mm = left_mm(result);
  record->reach_mm = result.reach_mm;
  record->worst = robust ? 0 : result.worst.ratio;  // a robust loss reduces its weight
  record->worst_reading = result.worst.reading;
  record->culprit = result.absurd;
  record->check_ratio = result.check_ratio.value_or(0);
  record->check_count = result.check_ratio ? result.check.count : 0;
  record->worst_check = result.check_ratio ? result.worst_check.reading : "";
  const bool by_instrument = find_disturbance(result, rows, all, convention, robust, *record);
  record->noise = kept_noise(result.noise, rows);
  record->values.resize(static_cast<Eigen::Index>(result.estimates.size()));
  for (std::size_t i = 0; i < result.estimates.size(); ++i) {
    record->parameters.push_back(result.estimates[i].name);
    record->origins.emplace_back(origin_name(result.estimates[i].from));
    record->values[static_cast<Eigen::Index>(i)] = result.estimates[i].value;
  }
  record->factor = model::covariance_factor(result.covariance);
  record->open = model::open_factor(result.open, result.covariance);
  record->open_known = true;
  record->measured = measured_ranges(result.machine, rows);
  record->planes = touched_planes(result.things);
  const Eigen::Vector3d lack_mm = model_discrepancy(result, all);
  record->discrepancy_mm = {lack_mm.x(), lack_mm.y(), lack_mm.z()};
  result.machine.fitted = record;
  const ReadingsBesideSetUp readings(result.machine, weighed, result.residual, result.variance_factor);
  record->unvaried = unvaried_dependences(readings);
  record->alternatives = find_alternatives(readings);
  record->findings = findings_of(result, *record, all);
  if (!by_instrument) leave_one_cause(record->findings);
}

/// Returns the rms of a machine's check rows in the best set-up for them, um.
std::optional<double> check_rms_set_up_anew(const model::Machine& machine, const model::Measurement& m) {
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < m.rows(); ++row)
    if (m.check[row] != 0) keep.push_back(row);
  model::Measurement rows = model::select_rows(m, keep);
  rows.check.assign(rows.check.size(), 0);
  return role_statistics(rows, residuals(set_up(machine, rows), rows), false).rms_um;
}

/// Compares the fitted machine with the nominal machine on held-out rows. Both use the set-up of
/// the fit rows (`centre` has the nominal one). If there are enough check rows, both are also set
/// up anew on these rows. The ratio that is worse for the fit is used. A set-up that compensates
/// errors of a wrong machine is not suitable for the nominal one.
std::optional<double> check_ratio(const FitResult& result, const Eigen::VectorXd& centre,
                                  const model::Measurement& m) {
  constexpr std::size_t kEnough =
      12;  // readings: the ratio of two standard deviations of twelve stays below about 1.25
  constexpr std::size_t kEnoughForSetUp = 24;  // readings: four times the number of set-up parameters
  if (result.check.count < kEnough || !result.check.rms_um) return std::nullopt;
  model::Machine nominal = result.machine;
  result.parameters.set(nominal, centre);
  const Eigen::VectorXd left = residuals(nominal, m);
  const double nominal_um = role_statistics(m, left, true).rms_um.value_or(0);
  if (nominal_um <= 0) return std::nullopt;
  const double as_fitted = *result.check.rms_um / nominal_um;
  if (result.check.count < kEnoughForSetUp || model::uses_lag(result.machine)) return as_fitted;
  const auto anew = check_rms_set_up_anew(nominal, m), fitted = check_rms_set_up_anew(result.machine, m);
  if (!anew || !fitted || *anew <= 0) return as_fitted;
  return std::max(as_fitted, *fitted / *anew);
}

/// Standard uncertainty of the mean of numbers that may be correlated, from the means of blocks.
double std_of_mean(const std::vector<double>& numbers) {
  constexpr std::size_t kStretches = 12, kLeast = 3;  // number of blocks, and readings per block
  if (numbers.size() < kStretches * kLeast) return std::numeric_limits<double>::infinity();
  std::array<double, kStretches> mean{};
  double whole = 0, spread = 0;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const std::size_t from = k * numbers.size() / kStretches, to = (k + 1) * numbers.size() / kStretches;
    for (std::size_t i = from; i < to; ++i) mean[k] += numbers[i] / static_cast<double>(to - from);
    whole += mean[k] / kStretches;
  }
  for (const double one : mean) spread += (one - whole) * (one - whole);
  return std::sqrt(spread / (kStretches - 1) / kStretches);
}

/// Returns g C g^T of each reading, C the covariance of the parameters.
Eigen::VectorXd prediction_variance(const FitResult& result, const model::Measurement& m) {
  if (result.freedom < 0.5) return {};
  const model::Linearisation linear = model::linearise(result.machine, m, result.parameters);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(linear.predicted.size());
  for (Eigen::Index i = 0; i < variance.size(); ++i)
    for (model::SparseRows::InnerIterator a(linear.jacobian, i); a; ++a)
      for (model::SparseRows::InnerIterator b(linear.jacobian, i); b; ++b)
        variance[i] += a.value() * b.value() * result.covariance(a.col(), b.col());
  return variance;
}

/// Returns residual / sqrt(u^2 + g C g^T) over the check rows. u is the reading's own. Without u
/// it is the standard deviation of the fit.
std::optional<NormalisedError> normalised_error(const FitResult& result, const model::Measurement& m) {
  if (result.check.count == 0 || result.prediction_variance.size() == 0) return std::nullopt;
  NormalisedError error;
  std::vector<double> squares;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if (m.check[o.row] == 0) continue;
    const auto at = static_cast<Eigen::Index>(i);
    const double u = model::uncertainty_of(m, o);
    const double reading = u > 0 ? u * u : result.variance_factor;
    const double e = result.residual[at] / std::sqrt(reading + result.prediction_variance[at]);
    squares.push_back(e * e);
    error.rms += e * e;
    error.within_3 += std::abs(e) <= 3 ? 1 : 0;
    ++error.count;
  }
  if (error.count == 0) return std::nullopt;
  error.rms = std::sqrt(error.rms / static_cast<double>(error.count));
  error.within_3 /= static_cast<double>(error.count);
  error.square_std = std_of_mean(squares);
  return error;
}

}  // namespace

const char* origin_name(Origin origin) {
  constexpr const char* kNames[] = {"data", "convention", "prior"};
  return kNames[static_cast<std::size_t>(origin)];
}

namespace {

/// The nominal chain of the fitted machine is that of the given machine. If a free static has no
/// `nominal`, its start value becomes the nominal value, in memory and in the written file.
void keep_start_as_nominal(model::Machine& machine) {
  for (model::Static& item : machine.statics)
    if (!item.hidden && !item.nominal) item.nominal = item.value;
}

}  // namespace

double FitResult::factor_of(std::size_t file) const {
  for (const FileFactor& one : file_factors)
    if (one.file == file) return one.factor;
  return 1;
}

bool ParameterEstimate::moved() const {
  constexpr double kOfScale = 0.005;  // half a per cent of the scale: not visible beside it with two digits
  return std::abs(value - nominal) > kOfScale * scale;
}

namespace {

/// The end of a fit, and the number of its readings without those that touched objects take.
struct Solution {
  Settled end;
  std::size_t readings = 0;
};

/// Solves with the weights of `rows`. Changes the iterations, the convergence, the stages and the size in
/// `result`.
Solution solved(FitResult& result, const model::Machine& machine, const model::Measurement& rows,
                Convention& convention, const StatedPriors& stated, const FitOptions& options) {
  FitProblem problem(machine, rows, result.parameters);
  problem.hold_unseen(convention.unseen);
  result.size = decide_size(problem, machine, result.parameters, convention, stated, convention.centre);
  const bool with_u = has_uncertainty(rows), squared = options.loss == Loss::kSquared;
  if (!squared && !problem.things().empty())
    throw text::InputError(
        "--loss: a robust loss does not work with the columns same and on; remove bad touches by "
        "--residuals, or use the squared loss");
  Solution solution;
  solution.readings = result.before.count - problem.things().eliminated();
  if (result.parameters.size() == 0) {
    solution.end = nothing_free(problem, solution.readings, with_u);
    result.converged = true;
    return solution;
  }
  const auto once = [&] {
    result.stages.clear();
    const Eigen::VectorXd near = solve(problem, machine, convention, stated, options, result);
    solution.end =
        squared ? settle(problem, near, convention, stated, solution.readings, with_u, options.noise,
                         rows.files.size() > 1)
                : describe(problem, near, convention, stated, solution.readings, with_u, options.noise);
    result.iterations += squared ? solution.end.iterations : 0;
    result.converged = result.converged && (!squared || solution.end.converged);
  };
  once();
  if (hold_turned_away(solution.end, convention)) once();
  if (see_again(machine, solution.end.point, rows, result.parameters, convention)) {
    problem.hold_unseen(convention.unseen);
    once();
  }
  return solution;
}

/// True if the residual is far enough above u that the files may differ in how far the model describes them.
/// A given noise model is the caller's, with the weights of its rows.
bool may_differ_by_file(const Settled& end, const model::Measurement& m, const FitOptions& options) {
  constexpr double kAboveU = 1.5;  // standard deviation of the residual, in u: beyond the error of a stated u
  return !options.noise && options.loss == Loss::kSquared && m.files.size() > 1 && has_uncertainty(m) &&
         end.variance > kAboveU * kAboveU;
}

std::optional<FittedAlone> fitted_alone(const model::Machine& machine, const model::Measurement& own) {
  FitOptions independent;
  independent.noise = NoiseModel{};
  try {
    const FitResult alone = fit(machine, own, independent);
    if (alone.converged) return FittedAlone{alone.chi_square, alone.freedom};
  } catch (const text::InputError&) {  // the model is undefined for these rows alone
  }
  return std::nullopt;
}

/// The noise model of the readings over their stated u at the end of a fit with other weights: a step or a
/// drift in the readings of one file is as large as it is, whatever weight the file has.
NoiseModel noise_over_stated_u(const FitResult& result, const model::Machine& machine,
                               const model::Measurement& rows, const Solution& solution,
                               const Convention& convention, const StatedPriors& stated) {
  FitProblem problem(machine, rows, result.parameters);
  problem.hold_unseen(convention.unseen);
  return describe(problem, solution.end.point, convention, stated, solution.readings, true, std::nullopt)
      .noise;
}

}  // namespace

FitResult fit(const model::Machine& machine, const model::Measurement& measurement,
              const FitOptions& options) {
  FitResult result;
  result.machine = machine;
  keep_start_as_nominal(result.machine);
  result.parameters = model::ParameterSet(machine, setups_of_fit_rows(measurement));
  const Eigen::VectorXd start_residual = residuals(machine, measurement);
  result.before = role_statistics(measurement, start_residual, false);
  if (result.before.count == 0)
    throw text::InputError(
        "the measurement has no reading with role fit; give at least some rows the role fit");
  result.noise_um = noise_um(measurement);
  const std::vector<std::size_t> kept = kept_for_fit(machine, measurement);
  const model::Measurement rows =
      kept.size() == measurement.rows() ? measurement : model::select_rows(measurement, kept);
  Convention convention = convention_of(machine, rows, result.parameters);
  result.misfit_mm = convention.misfit_mm;
  result.reach_mm = convention.reach_mm;
  result.only_set_up = with_only_set_up(result, machine, convention.centre, measurement);
  const StatedPriors stated = stated_priors(result, options, convention);
  Solution solution = solved(result, machine, rows, convention, stated, options);
  std::optional<model::Measurement> with_other_u;
  if (may_differ_by_file(solution.end, measurement, options))
    result.file_factors =
        file_factors(measurement, [&](const model::Measurement& own) { return fitted_alone(machine, own); });
  if (!result.file_factors.empty()) {
    with_other_u = with_factors(measurement, result.file_factors);
    solution = solved(result, machine, model::select_rows(*with_other_u, kept), convention, stated, options);
    solution.end.noise = noise_over_stated_u(result, machine, rows, solution, convention, stated);
  }
  const model::Measurement& weighed = with_other_u ? *with_other_u : measurement;
  Settled& end = solution.end;
  const std::size_t readings = solution.readings;
  // Steps were found among the rows of the fit, and are stated by the rows of the files.
  for (NoiseStep& step : end.noise.steps)
    if (!options.noise && step.row < kept.size()) step.row = kept[step.row];
  result.parameters.set(result.machine, end.point);
  result.residual = residuals(result.machine, measurement);
  result.after = role_statistics(measurement, result.residual, false);
  result.check = role_statistics(measurement, result.residual, true);
  estimate(result, end, convention.centre);
  if (!result.file_factors.empty())
    result.chi_square = fit_weights(measurement).cwiseProduct(result.residual).squaredNorm();
  result.things = estimates_of_things(result, weighed);
  judge(result, machine, measurement, end, readings);
  result.check_ratio = check_ratio(result, convention.centre, measurement);
  result.prediction_variance = prediction_variance(result, measurement);
  remember(result, rows, measurement, weighed, convention, options.loss != Loss::kSquared);
  result.correlations = strong_correlations(result.observability);
  result.normalised_check = normalised_error(result, measurement);
  return result;
}

}  // namespace vernier::fit
