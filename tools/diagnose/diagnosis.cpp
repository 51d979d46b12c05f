// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/causes.h"
#include "tools/diagnose/copies.h"
#include "tools/diagnose/doubts/course.h"
#include "tools/diagnose/doubts/shape.h"
#include "tools/diagnose/finder.h"
#include "tools/diagnose/outliers.h"
#include "tools/diagnose/pieces.h"
#include "tools/diagnose/proof.h"
#include "tools/diagnose/refit.h"
#include "tools/diagnose/sentences.h"
#include "tools/diagnose/verdict.h"
#include "tools/effects/add_string.h"
#include "tools/effects/fitted_effect.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/noise/noise.h"
#include "tools/format/readings.h"
#include "tools/maths/factors.h"
#include "tools/maths/threads.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/model/rebind.h"
#include "tools/residual/structure.h"
#include "tools/timebase/time_base.h"

namespace vernier::diagnose {
namespace {

/// One diagnosis, step by step.
class Diagnoser {
 public:
  Diagnoser(const std::string& text, const model::Machine& machine, const model::Measurement& measurement,
            const DiagnoseOptions& options, std::size_t most_effects)
      : options_(options),
        measurement_(measurement),
        machine_(machine),
        base_(fit_first(machine, measurement)),
        text_(model::update_machine_text(text, base_.machine, true)),
        finder_(base_.machine, measurement, options.effects, most_effects, options.progress,
                options.thresholds),
        pool_(finder_.pool()) {}

  Diagnosis run() {
    result_.base = base_;
    residual::StructureOptions structure;
    structure.fitted_parameters = static_cast<std::size_t>(base_.observability.rank);
    result_.failure = residual::failure_picture(base_.machine, measurement_, base_.residual, structure);
    if (!base_.mistake.empty()) return refused();
    finder_.find();
    result_.searched = finder_.candidates().size();
    result_.noise = finder_.noise();
    result_.noise_unit = fit::noise_unit(measurement_);
    Steps steps = fit_steps(certain_first(finder_.chosen()));
    // Another effect may explain what a contradicted one explained of the fit rows.
    constexpr int kMostRounds = 3;
    for (int round = 0; round < kMostRounds && !steps.contradicted.empty(); ++round) {
      finder_.find_without(steps.contradicted);
      steps = fit_steps(certain_first(finder_.chosen()));
    }
    take(std::move(steps));
    decide();
    compare_later_steps();
    fit_candidates();
    const Findings found{options_,   measurement_,   machine_,      finder_, accepted_,
                         confirmed_, not_confirmed_, alternatives_, listed_};
    set_verdict(found, result_);
    if (result_.verdict == Verdict::kUnexplained) result_.explanation += steps_of_noise();
    result_.causes = causes_not_rejected(found, result_);
    return std::move(result_);
  }

 private:
  fit::FitResult fit_first(const model::Machine& machine, const model::Measurement& m) {
    options_.progress(0, "fitting the model");
    return fit::fit(machine, m, independent_readings());
  }

  /// Correlations are not known before the search.
  static fit::FitOptions independent_readings() {
    fit::FitOptions options;
    options.noise = fit::NoiseModel{};
    return options;
  }

  /// Orders the effects: those that stay causes whatever the doubtful ones are come first, so that one of
  /// them is named.
  std::vector<std::size_t> certain_first(std::vector<std::size_t> items) const {
    const Evidence& evidence = finder_.evidence();
    std::vector<std::size_t> doubtful = pieces_of_one_function(evidence, pool_, items);
    for (const std::size_t item : items)
      if (!doubt_of(evidence, pool_, items, item).empty()) doubtful.push_back(item);
    if (!doubtful.empty())
      std::stable_partition(items.begin(), items.end(),
                            [&](std::size_t item) { return stands_beside(evidence, pool_, item, doubtful); });
    return items;
  }

  /// Returns the verdict if the readings are not those of this machine, as `fit` reports. A search
  /// would only find effects that imitate the mistake.
  Diagnosis refused() {
    result_.noise = base_.noise;
    result_.noise_unit = fit::noise_unit(measurement_);
    result_.left = result_.failure;
    take(fit_steps({}));
    result_.verdict = Verdict::kInstrument;
    result_.instrument = "readings";
    result_.causes = {instrument_cause(result_.instrument, 0)};
    result_.remaining.chi_square_per_freedom = base_.chi_square / std::max(1.0, base_.freedom);
    result_.explanation =
        "The readings do not fit this machine: " + base_.absurd +
        ". Correct the measurement file or the machine file first; the diagnosis did not search for effects.";
    return std::move(result_);
  }

  /// Sentences about the steps that the noise model contains: they can be the error that has no name.
  std::string steps_of_noise() const {
    std::string text;
    for (const fit::NoiseStep& step : result_.noise.steps) {
      if (step.of_set_up() || step.row >= measurement_.line.size()) continue;
      text += fmt::format(
          " The noise model contains a step at line {} ({}): the instrument, the target or the machine "
          "possibly moved there.",
          measurement_.line[step.row], fit::step_in_words(step, result_.noise_unit));
    }
    return text;
  }

  /// Options with the noise that the search found.
  fit::FitOptions found_noise() const {
    fit::FitOptions options;
    options.noise = result_.noise;
    return options;
  }

  /// Returns the machine with several items added and fitted, starting at the linear estimate. If
  /// the fit moves a period or time constant out of the range of its search, it is held at its
  /// found value.
  effects::FittedEffects fit_with(const std::vector<std::size_t>& items) const {
    std::vector<effects::EffectToFit> effects;
    for (const std::size_t item : items) {
      const Scored& scored = pool_[item].scored;
      const ScannedCandidate& found = finder_.candidates()[scored.candidate];
      effects::EffectToFit effect;
      effect.choice = effects::choice_at(pool_.candidate(item), scored.scanned);
      effect.coefficients = finder_.coefficient_of_each_unknown(item);
      effect.is_driven_out = [&](std::size_t unknown, double value) {
        return found.is_driven_out(unknown, scored.scanned[unknown], value);
      };
      effects.push_back(std::move(effect));
    }
    return effects::fit_with_effects({text_, base_.machine}, measurement_, effects, found_noise());
  }

  std::string add_string_of(std::size_t item) const {
    return effects::add_string(finder_.evidence().machine(),
                               effects::choice_at(pool_.candidate(item), pool_[item].scored.scanned));
  }

  /// Decrease of chi^2, or of its substitute if the noise is unknown.
  double decrease(const fit::FitResult& before, const fit::FitResult& after) const {
    if (fit::has_uncertainty(measurement_)) return before.chi_square - after.chi_square;
    return static_cast<double>(before.after.count) * std::log(before.chi_square / after.chi_square);
  }

  /// Evidence for a step, as a natural logarithm of a likelihood ratio.
  struct StepEvidence {
    double value = 0;
    bool of_check_rows = false;  // 20 to 1; else from runs held out in turn
  };

  /// Returns nullopt if held-out rows do not confirm the step. Check rows are tested first; a step
  /// that makes them worse is never confirmed. Held-out runs are tested if the check rows cannot reach
  /// 20 to 1.
  std::optional<StepEvidence> confirmed_by(const Proof& proof, std::size_t item) const {
    const ProofThresholds& limits = options_.thresholds.proof;
    if (proof.evidence < proof.asked(limits)) return confirmed_beside(proof, item);
    // A step of one run does not apply to another run. It is sufficient that rows of other runs
    // become worse with it.
    if (!pool_.candidate(item).choice.runs.empty() && proof.evidence < 0) return std::nullopt;
    // Every run has the same targets, so no run refutes a period that was the best of many at these targets.
    if (is_searched(item) && proof.evidence < 0) return std::nullopt;
    if (proof.evidence >= limits.evidence) return StepEvidence{proof.evidence, true};
    const double held_out = finder_.held_out_evidence(item);
    if (held_out < limits.evidence) return std::nullopt;
    return StepEvidence{held_out, false};
  }

  /// True if a period or another shape of the effect was the best of a scan.
  bool is_searched(std::size_t item) const { return !pool_[item].scored.scanned.empty(); }

  /// Check rows that the effect hardly changes (those of a tracker beside a laser that shows a backlash of
  /// two of its u) can be against a true effect by chance. The runs held out in turn then decide together
  /// with them, at the odds at which one file contradicts a step.
  std::optional<StepEvidence> confirmed_beside(const Proof& proof, std::size_t item) const {
    const ProofThresholds& limits = options_.thresholds.proof;
    if (proof.expected >= limits.evidence || pool_.is_custom(item) || is_searched(item) ||
        !pool_.candidate(item).choice.runs.empty() ||
        proof.evidence < proof.expected - limits.loss_sigmas * std::sqrt(2 * proof.expected))
      return std::nullopt;
    const double together = proof.evidence + finder_.held_out_evidence(item);
    if (together < limits.contradiction) return std::nullopt;
    return StepEvidence{together, false};
  }

  /// True if runs held out in turn can replace check rows: there are none, or they hardly see the effect.
  /// Only for a named effect of all runs without a searched shape: all runs have the same targets, and can
  /// share the shape of another error.
  bool runs_replace_check_rows(const Proof& proof, std::size_t item) const {
    return proof.expected < options_.thresholds.proof.evidence && !pool_.is_custom(item) &&
           !is_searched(item) && pool_.candidate(item).choice.runs.empty();
  }

  /// Variance of the independent noise of a weighted reading beside a fit, for proof_on_check_rows().
  double variance_beside(const fit::FitResult& fit) const {
    if (!finder_.evidence().noise_of_file().independent()) return 1;
    const double variance = fit.chi_square / std::max(1.0, fit.freedom);
    return finder_.evidence().noise_known() ? std::max(1.0, variance) : variance;
  }

  Proof proof_of(const fit::FitResult& before, const fit::FitResult& after) const {
    return proof_on_check_rows(measurement_, before.residual, after.residual,
                               finder_.evidence().noise_of_file(), variance_beside(after));
  }

  /// The many readings of one instrument must not hide that those of another contradict a step.
  std::optional<Proof::OfFile> contradiction(const Proof& proof, const fit::FitResult& before,
                                             const effects::FittedEffects& after) const {
    if (proof.files.empty()) return std::nullopt;
    const model::Measurement rows = model::rebind(measurement_, base_.machine, after.fit.machine);
    return contradicting_file(proof, options_.thresholds.proof, rows, before, after.fit,
                              part_of_term(after.fit.machine, after.effects.back(), rows),
                              finder_.evidence().noise_of_file(), variance_beside(after.fit));
  }

  /// States which check rows contradict a step, and by which figure.
  std::string contradicted_by(const Proof::OfFile& one) const {
    return fmt::format(
        "test `held out`: the check rows of {} contradict the effect: their sum of squares, weighted by "
        "1/u^2, "
        "increases by {:.3g}",
        measurement_.files[one.file], -2 * one.evidence);
  }

  static std::string refused_by(const Proof& proof) {
    return fmt::format(
        "test `held out`: the sum of squares of the check rows, weighted by 1/u^2, increases by {:.3g}; this "
        "effect would decrease it by {:.3g}",
        -2 * proof.evidence, 2 * proof.expected);
  }

  /// What the term of an effect contributes to the prediction of each reading, mm or deg.
  static Eigen::VectorXd part_of_term(const model::Machine& machine, const effects::Candidate& effect,
                                      const model::Measurement& rows) {
    model::Machine without = machine;
    for (const effects::CandidateUnknown& unknown : effects::linear_unknowns(effect))
      if (const auto at = without.find_static(unknown.name)) without.statics[*at].value = 0;
    return fit::residuals(without, rows) - fit::residuals(machine, rows);
  }

  /// Returns the fitted machine as a file, with the noise findings of its own residual. The search
  /// began with independent readings, and the user of this machine must know of a step or drift.
  std::string given_model() const {
    return model::update_machine_text(text_, fit::fit(base_.machine, measurement_).machine, true);
  }

  /// The stepwise model with its fits.
  struct Steps {
    std::vector<std::size_t> accepted;  // items that lower chi^2 in the fit, and that the rows confirm
    std::set<std::size_t> confirmed;    // of these, items that the check rows confirm; where these hardly
                                        // see an item, those that held-out runs confirm without doubt
    std::vector<std::string> not_confirmed;  // names of steps that the check rows do not confirm
    std::vector<Contradicted> contradicted;  // of these, items that one file of check rows contradicts
    std::vector<LadderStep> ladder;          // begins with the model as given
    std::string machine_text;
    fit::FitResult end;
    std::vector<effects::Candidate> effects;  // of `end`, in the order of `accepted`
  };

  LadderStep first_step() const {
    LadderStep start;
    start.rms_um = base_.after.rms_um;
    start.check_rms_um = base_.check.rms_um;
    start.rms_urad = base_.after.rms_urad;
    start.check_rms_urad = base_.check.rms_urad;
    start.check_files = checks_of_files(measurement_, base_.residual);
    start.chi_square_per_freedom = base_.chi_square / std::max(1.0, base_.freedom);
    start.text = given_model();
    return start;
  }

  /// Fits the items one after another. Excludes those that the fits or the check rows do not confirm.
  Steps fit_steps(const std::vector<std::size_t>& proposed) const {
    Steps steps{proposed, {}, {}, {}, {first_step()}, {}, base_, {}};
    steps.machine_text = steps.ladder.front().text;
    for (std::size_t count = 1; count <= steps.accepted.size();) {
      options_.progress(0.8 + 0.1 * static_cast<double>(count) / static_cast<double>(proposed.size()),
                        "fitting the stepwise model");
      const std::vector<std::size_t> items(steps.accepted.begin(),
                                           steps.accepted.begin() + static_cast<std::ptrdiff_t>(count));
      const std::size_t item = items.back();
      const auto exclude = [&] {
        steps.accepted.erase(steps.accepted.begin() + static_cast<std::ptrdiff_t>(count - 1));
      };
      const effects::FittedEffects fitted = fit_with(items);
      // A decrease that the linear estimate predicts but the fit does not reach is not a step.
      if (decrease(steps.end, fitted.fit) < options_.thresholds.acceptance.evidence) {
        exclude();
        continue;
      }
      const Proof proof = proof_of(steps.end, fitted.fit);
      const std::optional<Proof::OfFile> contradicted = contradiction(proof, steps.end, fitted);
      const std::optional<StepEvidence> confirmation =
          contradicted ? std::nullopt : confirmed_by(proof, item);
      if (!confirmation) {
        if (contradicted)
          steps.contradicted.push_back({item, contradicted_by(*contradicted)});
        else if (proof.evidence < std::min(0.0, proof.asked(options_.thresholds.proof)))
          steps.contradicted.push_back({item, refused_by(proof)});
        steps.not_confirmed.push_back(pool_.candidate(item).spoken);
        exclude();
        continue;
      }
      // Check rows that favour the step, beside runs held out in turn that leave no doubt; where check rows
      // hardly see it, such runs alone.
      const bool without_doubt = confirmation->value > options_.thresholds.proof.contradiction;
      if (confirmation->of_check_rows ||
          (without_doubt && (proof.evidence > 0 || runs_replace_check_rows(proof, item))))
        steps.confirmed.insert(item);
      steps.ladder.push_back(step_of(item, fitted, *confirmation));
      steps.machine_text = fitted.text;
      steps.end = fitted.fit;
      steps.effects = fitted.effects;
      ++count;
    }
    return steps;
  }

  LadderStep step_of(std::size_t item, const effects::FittedEffects& fitted,
                     const StepEvidence& confirmation) const {
    LadderStep step;
    step.confirmed = true;
    step.of_check_rows = confirmation.of_check_rows;
    step.evidence = confirmation.value;
    step.effect = pool_.candidate(item).choice.effect->id;
    step.add = add_string_of(item);
    step.label = pool_.candidate(item).label;
    step.said = pool_.candidate(item).spoken;
    step.rms_um = fitted.fit.after.rms_um;
    step.check_rms_um = fitted.fit.check.rms_um;
    step.rms_urad = fitted.fit.after.rms_urad;
    step.check_rms_urad = fitted.fit.check.rms_urad;
    step.check_files = checks_of_files(fitted.rows, fitted.fit.residual);
    step.chi_square_per_freedom = fitted.fit.chi_square / std::max(1.0, fitted.fit.freedom);
    step.text = fitted.text;
    return step;
  }

  void take(Steps steps) {
    accepted_ = std::move(steps.accepted);
    confirmed_ = std::move(steps.confirmed);
    not_confirmed_ = std::move(steps.not_confirmed);
    result_.ladder = std::move(steps.ladder);
    result_.machine_text = std::move(steps.machine_text);
    result_.end = std::move(steps.end);
    effects_ = std::move(steps.effects);
  }

  /// Compares the first cause with its alternatives by full fits. If the fit prefers an alternative, and the
  /// check rows confirm it, the alternative is the cause.
  void decide() {
    if (accepted_.empty()) return;
    alternatives_ = {fitted_alternatives(0)};
    if (alternatives_.front().other.empty()) return;
    const Alternative& best = alternatives_.front().other.front();
    const std::size_t cause = accepted_.front(), better = best.item;
    if (best.distance >= -finder_.evidence_beyond_limit(cause, better)) return;
    if (!finder_.replace(cause, better)) return;
    Steps steps = fit_steps(finder_.chosen());
    if (steps.accepted.empty() || steps.accepted.front() != better) {
      finder_.replace(better, cause);
      return;
    }
    take(std::move(steps));
    alternatives_ = {fitted_alternatives(0)};
  }

  /// Compares each later step with its alternatives as well.
  void compare_later_steps() {
    for (std::size_t i = 1; i < accepted_.size(); ++i) alternatives_.push_back(fitted_alternatives(i));
  }

  Alternatives fitted_alternatives(std::size_t position) const {
    return alternatives_by_fits(
        finder_, accepted_, position, options_.shown,
        {base_, result_.end, [this](const std::vector<std::size_t>& items) { return fit_with(items).fit; }});
  }

  /// Items in the order of the report: the accepted ones, then by the decrease of each alone.
  std::vector<std::size_t> items_to_list() const {
    std::vector<std::pair<double, std::size_t>> rest;
    for (std::size_t i = 0; i < pool_.size(); ++i) {
      if (std::find(accepted_.begin(), accepted_.end(), i) != accepted_.end()) continue;
      rest.emplace_back(finder_.score_alone(i), i);
    }
    std::stable_sort(rest.begin(), rest.end(), [](const auto& a, const auto& b) {
      return std::round(a.first / kSameCriterion) > std::round(b.first / kSameCriterion);
    });
    // The cause, those that cannot be distinguished from it, then the other accepted steps.
    std::vector<std::size_t> items;
    std::set<std::string> seen;
    const auto take = [&](std::size_t item) {
      if (seen.insert(pool_.candidate(item).label).second) items.push_back(item);
    };
    if (!accepted_.empty()) take(accepted_.front());
    for (std::size_t i = 0; i < alternatives_.size(); ++i)
      for (const std::size_t item : not_rejected(alternatives_, i, options_.thresholds.acceptance.distance))
        if (items.size() < options_.shown) take(item);
    for (const std::size_t item : accepted_) take(item);
    for (const auto& [score, item] : rest) {
      if (items.size() >= options_.shown) break;
      if (seen.insert(pool_.candidate(item).label).second) items.push_back(item);
    }
    return items;
  }

  void fit_candidates() {
    const std::vector<std::size_t> items = items_to_list();
    const effects::AxisPlaces axes(machine_);
    std::vector<effects::FittedEffects> fits(items.size());
    maths::in_threads([&](std::size_t thread, std::size_t threads) {
      for (std::size_t i = thread; i < items.size(); i += threads) {
        if (thread == 0)
          options_.progress(0.9 + 0.1 * static_cast<double>(i) / static_cast<double>(items.size()),
                            "fitting the candidates");
        fits[i] = fit_with({items[i]});
      }
    });
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::size_t item = items[i];
      CandidateFinding finding;
      const effects::FittedEffects& fitted = fits[i];
      // What stands beside an accepted effect in the model changes the values of that effect.
      const auto accepted = std::find(accepted_.begin(), accepted_.end(), item);
      finding.accepted = accepted != accepted_.end();
      finding.candidate = finding.accepted ? effects_[static_cast<std::size_t>(accepted - accepted_.begin())]
                                           : fitted.effects[0];
      finding.add = add_string_of(item);
      finding.axis = effects::axis_of(axes, finding.candidate.choice);
      for (const effects::CandidateUnknown& unknown : finding.candidate.unknowns)
        for (const fit::ParameterEstimate& estimate :
             finding.accepted ? result_.end.estimates : fitted.fit.estimates)
          if (estimate.name == unknown.name) finding.parameters.push_back(estimate);
      finding.rms_after_um = fitted.fit.after.rms_um;
      finding.check_rms_before_um = base_.check.rms_um;
      finding.check_rms_after_um = fitted.fit.check.rms_um;
      finding.rms_after_urad = fitted.fit.after.rms_urad;
      finding.check_rms_after_urad = fitted.fit.check.rms_urad;
      if (base_.chi_square > 0) finding.share = 1 - fitted.fit.chi_square / base_.chi_square;
      finding.score = finder_.score_alone(item);
      finding.p_value = finder_.p_value(item);
      finding.why_not = pool_[item].why_not;
      result_.candidates.push_back(std::move(finding));
      listed_.push_back(item);
    }
  }

  const DiagnoseOptions& options_;
  const model::Measurement& measurement_;
  model::Machine machine_;
  fit::FitResult base_;
  std::string text_;  // of the machine, fitted
  Finder finder_;
  const Pool& pool_;                         // of the finder
  std::vector<std::size_t> accepted_;        // of the finder, without those that gain nothing in the fit
  std::vector<effects::Candidate> effects_;  // accepted ones, as in the last fit
  std::vector<std::size_t> listed_;
  std::set<std::size_t> confirmed_;         // items that held-out rows confirm, see Steps
  std::vector<std::string> not_confirmed_;  // labels of steps that the check rows contradict
  std::vector<Alternatives> alternatives_;  // to each accepted effect
  Diagnosis result_;
};

bool is_named(Verdict verdict) {
  return verdict == Verdict::kMissingEffect || verdict == Verdict::kAmbiguous;
}

/// Returns the number of excluded rows, and the error of all check rows beside the stepwise model that was
/// found without them.
ExcludedRows left_out_of(const Diagnosis& clean, const model::Measurement& all,
                         const std::vector<std::size_t>& kept) {
  const auto checked = [&](std::size_t row) { return all.check[row] != 0; };
  ExcludedRows left;
  left.rows = all.rows() - kept.size();
  left.check_rows = static_cast<std::size_t>(
      std::count_if(all.check.begin(), all.check.end(), [](char c) { return c != 0; }) -
      std::count_if(kept.begin(), kept.end(), checked));
  const model::Measurement rows = model::rebind(all, clean.base.machine, clean.end.machine);
  const fit::RoleStatistics check = fit::role_statistics(rows, fit::residuals(clean.end.machine, rows), true);
  left.check_rms_um = check.rms_um;
  left.check_rms_urad = check.rms_urad;
  return left;
}

/// Withdraws a cause that was found without outliers if the check rows, with the excluded ones, contradict
/// it.
void withdraw_if_all_check_rows_contradict(Diagnosis& clean, const model::Measurement& all,
                                           const VerdictThresholds& thresholds) {
  if (!is_named(clean.verdict) || clean.left_out->check_rows == 0) return;
  const model::Measurement rows = model::rebind(all, clean.base.machine, clean.end.machine);
  if (!is_worse_on_check_rows(all, fit::residuals(clean.base.machine, all), rows,
                              fit::residuals(clean.end.machine, rows), thresholds))
    return;
  clean.verdict = Verdict::kUnexplained;
  clean.causes.clear();
  clean.explanation =
      "No cause is named: with the check rows that were excluded as outliers, the residual of "
      "the check rows increases. " +
      clean.explanation;
}

bool has_effect_of_runs(const Diagnosis& answer) {
  return std::any_of(answer.candidates.begin(), answer.candidates.end(), [](const CandidateFinding& one) {
    return one.accepted && !one.candidate.choice.runs.empty();
  });
}

/// Runs the search, and repeats it without gross outliers if these may be the cause.
Diagnosis searched(const std::string& text, const model::Machine& machine,
                   const model::Measurement& measurement, const DiagnoseOptions& options,
                   std::size_t most_effects) {
  Diagnosis all = Diagnoser(text, machine, measurement, options, most_effects).run();
  if (!all.base.mistake.empty()) return all;
  // A drift of the instrument, or outliers beside found effects, need not be the whole cause either.
  const bool more_than_outliers = all.verdict == Verdict::kInstrument && !all.time_base.found;
  // Without u, no limit defines an outlier. Outliers are therefore searched in every case.
  const bool by_spread = !fit::has_uncertainty(measurement) && !all.time_base.found;
  if (all.verdict != Verdict::kUnexplained && !more_than_outliers && !by_spread) return all;
  const model::Measurement rows = model::rebind(measurement, all.base.machine, all.end.machine);
  const auto rest =
      without_gross_outliers(all.end.machine, rows, all.end.residual, options.thresholds.verdict);
  if (!rest || rows.rows() != measurement.rows()) return all;
  Diagnosis clean =
      Diagnoser(text, machine, model::select_rows(measurement, rest->kept), options, most_effects).run();
  clean.left_out = left_out_of(clean, measurement, rest->kept);
  withdraw_if_all_check_rows_contradict(clean, measurement, options.thresholds.verdict);
  if (!rest->step.empty() && all.explanation.find(rest->step) == std::string::npos)
    all.explanation += " " + rest->step;
  // Rows that follow each other moved together if an effect of runs is beside them: the motion was within a
  // run. Other such rows may be the start of a day: the history of a lag before them is unknown.
  if (!rest->step.empty() && has_effect_of_runs(clean)) return all;
  if (by_spread && clean.verdict == Verdict::kConsistent) {
    clean.verdict = Verdict::kInstrument;
    clean.explanation = "Some readings are outliers, and the residual of the other readings is noise. " +
                        rest->sentence + all_check_rows_in_words(*clean.left_out);
    clean.instrument = "outliers";
    clean.causes = {instrument_cause(clean.instrument, 0)};
    return clean;
  }
  if (is_named(clean.verdict) || (by_spread && clean.verdict == all.verdict)) {
    clean.explanation += " " + rest->sentence + all_check_rows_in_words(*clean.left_out);
    return clean;
  }
  if (by_spread) all.explanation += " " + rest->sentence;
  return all;
}

/// Withdraws a good verdict if the fit contradicts it: the fit did not converge, or its residual
/// exceeds that of any machine.
void withdraw_if_the_fit_contradicts(Diagnosis& answer) {
  if (answer.end.absurd.empty() && answer.end.converged) return;
  const std::string why = answer.end.absurd.empty() ? "the fit did not converge" : answer.end.absurd;
  if (answer.verdict != Verdict::kConsistent && !is_named(answer.verdict)) return;
  answer.remaining.is_noise = false;
  answer.causes.clear();
  if (answer.verdict == Verdict::kConsistent && answer.end.converged) {
    answer.verdict = Verdict::kInstrument;
    answer.instrument = "readings";
    answer.causes = {instrument_cause(answer.instrument, 0)};
    answer.explanation = "The result is not assured: " + why + ".";
  } else if (answer.verdict == Verdict::kConsistent) {
    answer.verdict = Verdict::kUnexplained;
    answer.explanation = "The result is not assured: " + why + ".";
  } else {
    answer.verdict = Verdict::kUnexplained;
    answer.explanation = "No cause is named: " + why + ". " + answer.explanation;
    for (LadderStep& step : answer.ladder) step.certain = false;
  }
}

/// Searches with fewer effects as long as the fit of all effects found does not converge: effects that
/// compensate each other hide those that the readings determine.
Diagnosis searched_to_a_fit(const std::string& text, const model::Machine& machine,
                            const model::Measurement& measurement, const DiagnoseOptions& options) {
  constexpr std::size_t kFewer = 2;  // of five effects, three and then one are tried
  Diagnosis answer = searched(text, machine, measurement, options, options.most_effects);
  for (std::size_t found = answer.ladder.size(); !answer.end.converged && found > kFewer + 1;
       found -= kFewer) {
    Diagnosis with_fewer = searched(text, machine, measurement, options, found - 1 - kFewer);
    if (!with_fewer.end.converged) continue;
    with_fewer.explanation += fmt::format(
        " The fit with more effects does not converge: the readings do not determine {} of them together.",
        answer.ladder.size() - 1);
    return with_fewer;
  }
  return answer;
}

}  // namespace

Diagnosis diagnose(const std::string& text, const model::Machine& given,
                   const model::Measurement& measurement, const DiagnoseOptions& options) {
  model::require_time_order(measurement);
  const std::optional<WithoutCopies> distinct = without_copies(measurement);
  Diagnosis answer =
      searched_to_a_fit(text, effects::with_base_row(given),
                        distinct ? model::select_rows(measurement, distinct->kept) : measurement, options);
  if (distinct) answer.explanation += " " + distinct->sentence;
  withdraw_if_the_fit_contradicts(answer);
  return answer;
}

}  // namespace vernier::diagnose
