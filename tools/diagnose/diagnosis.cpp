// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/finder.h"
#include "tools/diagnose/outliers.h"
#include "tools/diagnose/pieces.h"
#include "tools/diagnose/proof.h"
#include "tools/diagnose/shape.h"
#include "tools/effects/add_string.h"
#include "tools/effects/fitted_effect.h"
#include "tools/effects/spoken.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/noise/noise.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
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
            const DiagnoseOptions& options)
      : options_(options),
        limits_(options.thresholds.verdict),
        measurement_(measurement),
        machine_(machine),
        base_(fit_first(machine, measurement)),
        text_(model::update_machine_text(text, base_.machine, true)),
        finder_(base_.machine, measurement, options.effects, options.most_effects, options.progress,
                options.thresholds),
        pool_(finder_.pool()) {}

  Diagnosis run() {
    result_.base = base_;
    residual::StructureOptions structure;
    structure.fitted_parameters = static_cast<std::size_t>(base_.observability.rank);
    result_.failure = residual::failure_picture(base_.machine, measurement_, base_.residual, structure);
    if (!base_.mistake.empty()) return refused();
    finder_.find();
    chosen_ = finder_.chosen();
    result_.searched = finder_.candidates().size();
    result_.noise = finder_.noise();
    result_.noise_unit = fit::noise_unit(measurement_);
    walk_ladder();
    if (!chosen_.empty()) rivals_ = finder_.rivals_of(chosen_.front());
    list_candidates();
    decide();
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

  /// Returns the verdict if the readings are not those of this machine, as `fit` reports. A search
  /// would only find effects that imitate the mistake.
  Diagnosis refused() {
    result_.noise = base_.noise;
    result_.noise_unit = fit::noise_unit(measurement_);
    result_.left = result_.failure;
    walk_ladder();
    result_.verdict = Verdict::kInstrument;
    result_.explanation = "The readings are not those of this machine: " + base_.absurd +
                          ". Correct the measurement file or the machine file first; no effect was searched.";
    return std::move(result_);
  }

  /// Options with the noise that the search found.
  fit::FitOptions settled_noise() const {
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
    return effects::fit_with_effects({text_, base_.machine}, measurement_, effects, settled_noise());
  }

  std::string add_string_of(std::size_t item) const {
    return effects::add_string(finder_.evidence().machine(),
                               effects::choice_at(pool_.candidate(item), pool_[item].scored.scanned));
  }

  /// Decrease of chi^2, or of its substitute if the noise is unknown.
  double fall_of(const fit::FitResult& before, const fit::FitResult& after) const {
    if (fit::has_uncertainty(measurement_)) return before.chi_square - after.chi_square;
    return static_cast<double>(before.after.count) * std::log(before.chi_square / after.chi_square);
  }

  /// Evidence for a step, as a natural logarithm of a likelihood ratio.
  struct StepEvidence {
    double value = 0;
    bool of_check_rows = false;  // 20 to 1; else from runs held out in turn
  };

  /// Returns nullopt if held-out rows do not confirm the step. Check rows are tested first, as far
  /// as the step is visible on them. Held-out runs are tested if the check rows cannot reach 20 to
  /// 1.
  std::optional<StepEvidence> borne_out_by(const fit::FitResult& before, const fit::FitResult& after,
                                           std::size_t item) const {
    const ProofThresholds& limits = options_.thresholds.proof;
    const Proof proof = proof_of(before, after);
    const std::optional<double> asked = proof.asked(limits);
    if (asked && proof.evidence < *asked) return std::nullopt;
    // A step of one run does not apply to another run. It is sufficient that rows of other runs
    // become worse with it.
    if (!pool_.candidate(item).choice.runs.empty() && proof.evidence < 0) return std::nullopt;
    if (asked && proof.evidence >= limits.evidence) return StepEvidence{proof.evidence, true};
    const double held_out = finder_.held_out_evidence(item);
    if (held_out < limits.evidence) return std::nullopt;
    return StepEvidence{held_out, false};
  }

  Proof proof_of(const fit::FitResult& before, const fit::FitResult& after) const {
    const fit::NoiseModel noise = finder_.evidence().noise_of_file();
    double variance = 1;
    if (noise.independent()) {
      variance = after.chi_square / std::max(1.0, after.freedom);
      if (finder_.evidence().noise_known()) variance = std::max(1.0, variance);
    }
    return proof_on_check_rows(measurement_, before.residual, after.residual, noise, variance);
  }

  /// Returns the fitted machine as a file, with the noise findings of its own residual. The search
  /// began with independent readings, and the user of this machine must know of a step or drift.
  std::string first_rung() const {
    return model::update_machine_text(text_, fit::fit(base_.machine, measurement_).machine, true);
  }

  void walk_ladder() {
    LadderStep start;
    start.rms_um = base_.after.rms_um;
    start.check_rms_um = base_.check.rms_um;
    start.rms_urad = base_.after.rms_urad;
    start.check_rms_urad = base_.check.rms_urad;
    start.chi_square_per_freedom = base_.chi_square / std::max(1.0, base_.freedom);
    start.text = first_rung();
    result_.ladder.push_back(start);
    result_.machine_text = start.text;
    result_.end = base_;
    const std::size_t found = chosen_.size();
    for (std::size_t count = 1; count <= chosen_.size();) {
      options_.progress(0.8 + 0.1 * static_cast<double>(count) / static_cast<double>(found),
                        "fitting the ladder");
      const std::vector<std::size_t> items(chosen_.begin(),
                                           chosen_.begin() + static_cast<std::ptrdiff_t>(count));
      const effects::FittedEffects fitted = fit_with(items);
      // A decrease that the linear estimate predicts but the fit does not reach is not a step.
      if (fall_of(result_.end, fitted.fit) < options_.thresholds.acceptance.evidence) {
        chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(count - 1));
        continue;
      }
      const std::optional<StepEvidence> borne_out = borne_out_by(result_.end, fitted.fit, items.back());
      if (!borne_out) {
        disproved_.push_back(pool_.candidate(items.back()).spoken);
        chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(count - 1));
        continue;
      }
      LadderStep step;
      step.confirmed = true;
      step.evidence = borne_out->value;
      if (borne_out->of_check_rows) proven_.insert(items.back());
      step.effect = pool_.candidate(items.back()).choice.effect->id;
      step.add = add_string_of(items.back());
      step.label = pool_.candidate(items.back()).label;
      step.said = pool_.candidate(items.back()).spoken;
      step.rms_um = fitted.fit.after.rms_um;
      step.check_rms_um = fitted.fit.check.rms_um;
      step.rms_urad = fitted.fit.after.rms_urad;
      step.check_rms_urad = fitted.fit.check.rms_urad;
      step.chi_square_per_freedom = fitted.fit.chi_square / std::max(1.0, fitted.fit.freedom);
      step.text = fitted.text;
      result_.ladder.push_back(step);
      result_.machine_text = fitted.text;
      result_.end = fitted.fit;
      ++count;
    }
  }

  /// Items in the order of the report: the accepted ones, then by the decrease of each alone.
  std::vector<std::size_t> shown_items() const {
    std::vector<std::pair<double, std::size_t>> rest;
    for (std::size_t i = 0; i < pool_.size(); ++i) {
      if (std::find(chosen_.begin(), chosen_.end(), i) != chosen_.end()) continue;
      rest.emplace_back(finder_.score_alone(i), i);
    }
    std::sort(rest.begin(), rest.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    // The cause, those that cannot be distinguished from it, then the other accepted steps.
    std::vector<std::size_t> items;
    std::set<std::string> seen;
    const auto take = [&](std::size_t item) {
      if (seen.insert(pool_.candidate(item).label).second) items.push_back(item);
    };
    if (!chosen_.empty()) take(chosen_.front());
    for (const std::size_t item : rivals_.close)
      if (items.size() < options_.shown) take(item);
    for (const std::size_t item : chosen_) take(item);
    for (const auto& [score, item] : rest) {
      if (items.size() >= options_.shown) break;
      if (seen.insert(pool_.candidate(item).label).second) items.push_back(item);
    }
    return items;
  }

  void list_candidates() {
    const std::vector<std::size_t> items = shown_items();
    const effects::AxisPlaces axes(machine_);
    for (std::size_t i = 0; i < items.size(); ++i) {
      options_.progress(0.9 + 0.1 * static_cast<double>(i) / static_cast<double>(items.size()),
                        "fitting the candidates");
      const std::size_t item = items[i];
      CandidateFinding finding;
      const effects::FittedEffects fitted = fit_with({item});
      finding.candidate = fitted.effects[0];
      finding.add = add_string_of(item);
      const effects::Choice& choice = finding.candidate.choice;
      finding.axis = choice.axis;
      if (!finding.axis && choice.place) finding.axis = axes.axis_of(*choice.place);
      for (const effects::CandidateUnknown& unknown : finding.candidate.unknowns)
        for (const fit::ParameterEstimate& estimate : fitted.fit.estimates)
          if (estimate.name == unknown.name) finding.parameters.push_back(estimate);
      finding.rms_after_um = fitted.fit.after.rms_um;
      finding.check_rms_before_um = base_.check.rms_um;
      finding.check_rms_after_um = fitted.fit.check.rms_um;
      if (base_.chi_square > 0) finding.share = 1 - fitted.fit.chi_square / base_.chi_square;
      finding.score = finder_.score_alone(item);
      finding.p_value = finder_.p_value(item);
      finding.accepted = std::find(chosen_.begin(), chosen_.end(), item) != chosen_.end();
      finding.why_not = pool_[item].why_not;
      result_.candidates.push_back(std::move(finding));
      shown_.push_back(item);
    }
  }

  /// The residual at the end of the stepwise model (mm, deg) without the correlated errors of the
  /// fit rows: the residual of independent readings.
  Eigen::VectorXd independent_residual(const model::Measurement& rows) const {
    const fit::NoiseModel& noise = result_.noise;
    Eigen::VectorXd residual = result_.end.residual;
    if (noise.independent() && noise.own == 1) return residual;
    const Eigen::VectorXd weights = fit::fit_weights(rows);
    std::vector<std::size_t> fitted;
    for (std::size_t i = 0; i < rows.observations.size(); ++i)
      if (weights[static_cast<Eigen::Index>(i)] > 0) fitted.push_back(i);
    Eigen::MatrixXd left = weights(fitted).cwiseProduct(residual(fitted));
    const fit::NoiseLayout layout = fit::noise_layout(rows, fitted, options_.thresholds.layout);
    fit::whiten(layout, noise, left);
    if (!noise.steps.empty()) {
      // The fit did not contain the steps and absorbed part of them. That part is removed together
      // with them.
      const Eigen::MatrixXd &seen = finder_.evidence().absorbed(), named = pool_.columns(chosen_);
      Eigen::MatrixXd columns = fit::step_columns(layout, noise.steps, left.rows());
      fit::whiten(layout, noise, columns);
      if (seen.rows() == left.rows()) {  // otherwise the search used only every k-th row
        const Eigen::Index steps = columns.cols();
        columns.conservativeResize(Eigen::NoChange, steps + seen.cols() + named.cols());
        columns.rightCols(seen.cols() + named.cols()) << seen, named;
      }
      left -= columns * maths::least_norm(columns, left);
    }
    // Whitened readings are in units of the independent noise. If no u is given, 1 of it is not a
    // length.
    const double unit = fit::has_uncertainty(rows) ? 1 : noise.own;
    residual(fitted) = unit * left.col(0).cwiseQuotient(weights(fitted));
    return residual;
  }

  /// Returns a sentence about the instrument if errors correlated in time or by run are as large
  /// as the independent noise; else empty.
  std::string drift_of_instrument() const {
    const fit::NoiseModel& noise = result_.noise;
    double drift = std::hypot(noise.run, noise.drift);
    for (const fit::NoiseStep& step : noise.steps) drift = std::max(drift, std::abs(step.height));
    if (drift < limits_.drift_share * noise.own || noise.support < limits_.drift_support) return {};
    return "The instrument does not hold still: " + ::vernier::fit::in_words(noise, result_.noise_unit) + ".";
  }

  /// Is one of the candidates, accepted or not, significant beside the accepted effects and noise
  /// of the size of the residual?
  bool something_stands_out() const {
    for (std::size_t item = 0; item < pool_.size(); ++item) {
      const bool chosen = std::find(chosen_.begin(), chosen_.end(), item) != chosen_.end();
      if (!chosen && finder_.p_value_beside(item) < limits_.stands_out) return true;
    }
    return false;
  }

  /// Is the residual of the fit at the end of the stepwise model noise? If the uncertainty is
  /// given, chi^2 decides. If chi^2 is so little above it that the uncertainty may be too small,
  /// or if no uncertainty is given, remaining structure decides. `rows`: for the machine at that
  /// end.
  bool down_to_noise(const model::Measurement& rows) {
    const model::Machine& machine = result_.end.machine;
    residual::StructureOptions structure;
    structure.fitted_parameters = static_cast<std::size_t>(result_.end.observability.rank);
    const Eigen::VectorXd left = independent_residual(rows);
    result_.left = residual::failure_picture(machine, rows, left, structure);
    const bool structured = result_.left.omnibus_p < limits_.structure;
    const double freedom = std::max(1.0, result_.end.freedom);
    const Eigen::VectorXd weights = fit::fit_weights(rows);
    const fit::NoiseModel& noise = result_.noise;
    const bool told = !noise.independent() || noise.own != 1;
    const double reduced =
        (told ? weights.cwiseProduct(left).squaredNorm() : result_.end.chi_square) / freedom;
    if (!fit::has_uncertainty(measurement_)) return !structured || stands_without_u();
    // Noise above the stated value is accepted only if no tested candidate is significant, and if
    // there are enough readings to show structure.
    const double stated = result_.end.chi_square / freedom;
    if (noise.independent() && stated > limits_.doubtful_uncertainty) {
      if (stated > limits_.implausible_uncertainty || something_stands_out()) return false;
      // With too few readings to show structure, the requirement is the same as without u.
      if (freedom < limits_.enough_readings) return !structured && stands_without_u();
    }
    // The number alone is sufficient for one or two effects that reach the noise. If the result is
    // only near the noise, or has more effects, it must also have no structure.
    const double sigmas = (reduced - 1) / std::sqrt(2 / freedom);
    if (sigmas < limits_.hit_sigmas && !chosen_.empty() && chosen_.size() <= limits_.few_effects) return true;
    if (sigmas < limits_.noise_sigmas) return !structured;
    return reduced < limits_.doubtful_uncertainty && !structured;
  }

  /// Is the first effect larger than the residual beside it, and is most of chi^2 explained?
  bool stands_without_u() const {
    return !chosen_.empty() && is_mostly_explained() &&
           finder_.growth_without(chosen_.front()) > limits_.larger_than_rest;
  }

  bool is_mostly_explained() const {
    return result_.end.chi_square < (1 - limits_.mostly_explained) * base_.chi_square;
  }

  void decide() {
    const model::Measurement rows = model::rebind(measurement_, base_.machine, result_.end.machine);
    const timebase::TimeBaseFinding clock = timebase::examine_time_base(measurement_, base_.residual);
    // What effects of the machine explain is not a clock error. A late reading looks like a clock
    // error.
    const bool explained = !chosen_.empty() && is_mostly_explained() &&
                           !timebase::examine_time_base(rows, result_.end.residual).found;
    if (clock.found && !explained) {
      result_.verdict = Verdict::kInstrument;
      result_.explanation = "The time base of the measurement: " + clock.why;
      result_.time_base = clock;
      return;
    }
    const bool noise_is_left = down_to_noise(rows);
    const std::vector<std::size_t> pieces = pieces_of_one_function(finder_.evidence(), pool_, chosen_);
    if (!noise_is_left && pieces.empty()) {
      if (const auto sentence = outliers_to_blame(result_.end.machine, rows, result_.end.residual, limits_)) {
        result_.verdict = Verdict::kInstrument;
        result_.explanation = *sentence;
        return;
      }
    }
    if (!disproved_.empty()) {
      std::string text = "The check rows do not confirm " + disproved_.front();
      for (std::size_t i = 1; i < disproved_.size(); ++i) text += ", " + disproved_[i];
      not_borne_out_ = text + ".";
    }
    if (const std::string drift = drift_of_instrument(); chosen_.empty() && !drift.empty()) {
      result_.verdict = Verdict::kInstrument;
      result_.explanation = drift + (noise_is_left ? " Beside it there is nothing to add." : where_left());
      return;
    }
    if (chosen_.empty()) {
      const std::string why = noise_is_left ? does_not_carry() : "";
      result_.verdict = noise_is_left && why.empty() ? Verdict::kConsistent : Verdict::kUnexplained;
      result_.explanation =
          result_.verdict == Verdict::kConsistent ? "The residual is noise: there is nothing to add."
          : !why.empty()
              ? why
              : "There is more than noise, and nothing in the catalogue explains it." + where_left();
      if (!not_borne_out_.empty()) result_.explanation += " " + not_borne_out_;
      return;
    }
    if (const std::string& why = pool_.candidate(chosen_.front()).choice.effect->of_instrument;
        !why.empty()) {
      result_.verdict = Verdict::kInstrument;
      result_.explanation = why;
      return;
    }
    const Rivals& rivals = rivals_;
    name_confusions(rivals);
    result_.runner_up_distance = rivals.distance;
    if (!noise_is_left) {
      result_.verdict = Verdict::kUnexplained;
      result_.explanation =
          "Effects of the catalogue lower the residual, and it does not come down to the noise." +
          where_left();
    } else if (!pieces.empty()) {
      result_.verdict = Verdict::kUnexplained;
      result_.explanation = fmt::format(
          "{} effects come down to the noise together, and are more likely the pieces of one function of the "
          "position that is none of the catalogue's: {}",
          pieces.size(), pool_.candidate(pieces.front()).spoken);
      for (std::size_t i = 1; i < pieces.size(); ++i)
        result_.explanation += "; " + pool_.candidate(pieces[i]).spoken;
      result_.explanation += ".";
    } else if (const std::string why = does_not_carry(); !why.empty()) {
      result_.verdict = Verdict::kUnexplained;
      result_.explanation = why;
    } else if (const std::size_t nameless = terms_without_standing(); nameless > 0) {
      result_.verdict = Verdict::kUnexplained;
      result_.explanation = fmt::format(
          "The residual comes down to the noise with {} terms that only a search found: more likely pieces "
          "of what the catalogue does not hold.",
          nameless);
    } else if (const std::string doubt = doubt_of_shapes(); !doubt.empty()) {
      result_.verdict = Verdict::kUnexplained;
      result_.explanation =
          "The residual comes down to the noise, and what does it is not given a name: " + doubt + ".";
    } else if (const std::string other = other_periods(); !other.empty()) {
      result_.verdict = Verdict::kAmbiguous;
      result_.explanation = other;
    } else if (!rivals.close.empty()) {
      result_.verdict = Verdict::kAmbiguous;
      result_.explanation = fmt::format("One of {} causes that explain these data alike, {} first.",
                                        1 + rivals.close.size(), pool_.candidate(chosen_.front()).spoken);
    } else {
      result_.verdict = Verdict::kMissingEffect;
      result_.explanation = in_words();
    }
  }

  /// Returns why the named cause does not hold on the check rows; empty if it holds, or if they
  /// cannot decide. Their error must not exceed that of the fit rows, except for their own scatter
  /// and the uncertainty of the model's parameters.
  std::string does_not_carry() const {
    const auto& check = result_.end.normalised_check;
    if (!check) return {};
    const double with_u = fit::has_uncertainty(measurement_)
                              ? std::max(1.0, result_.end.chi_square / std::max(1.0, result_.end.freedom))
                              : 1;
    const double ratio = check->rms * check->rms / with_u;
    const double fitted = std::sqrt(2 / std::max(1.0, result_.end.freedom));
    const double std = std::hypot(check->square_std / with_u, ratio * fitted);
    if (ratio < 1 + options_.thresholds.proof.carries_sigmas * std) return {};
    return fmt::format(
        "The improvement is not confirmed on held-out rows: the residual of the check rows is {:.2g} times "
        "that of the fit rows.",
        std::sqrt(ratio));
  }

  /// Returns the number of searched terms that are more likely pieces of one function. It is all
  /// of them if two are at one degree of freedom, or if the check rows do not confirm two of them.
  /// 0: each is a cause of its own.
  std::size_t terms_without_standing() const {
    std::vector<effects::DofPlace> places;
    bool apart = true;
    for (const std::size_t item : chosen_) {
      if (!pool_.is_custom(item)) continue;
      const effects::DofPlace place = pool_.candidate(item).terms.front().place;
      apart =
          apart && proven_.contains(item) && std::find(places.begin(), places.end(), place) == places.end();
      places.push_back(place);
    }
    return places.size() > 1 && !apart ? places.size() : 0;
  }

  /// Returns periods that the positions cannot distinguish from the found ones, of the first
  /// accepted effect that has any; empty: each period is unique.
  std::string other_periods() {
    std::string text;
    for (const std::size_t item : chosen_) {
      const std::vector<double> aliases = finder_.aliases_of(item);
      if (aliases.empty()) continue;
      const auto shown = std::find(shown_.begin(), shown_.end(), item);
      if (shown != shown_.end())
        result_.candidates[static_cast<std::size_t>(shown - shown_.begin())].aliases = aliases;
      if (!text.empty()) continue;
      const effects::Choice& choice = pool_.candidate(item).choice;
      const model::Axis& axis = machine_.axes[*choice.axis];
      text = fmt::format("{}: {}, with any of {} periods: the positions of {} do not tell them apart. {:.5g}",
                         choice.effect->title, pool_.candidate(item).spoken, aliases.size() + 1, axis.name,
                         pool_[item].scored.scanned.front());
      constexpr std::size_t kListed = 20;  // largest number of periods in a sentence
      for (std::size_t i = 0; i < std::min(kListed, aliases.size()); ++i)
        text += fmt::format(", {:.5g}", aliases[i]);
      text += fmt::format(" {}{}. Measure {} in uneven steps.", axis.rotary ? "deg" : "mm",
                          aliases.size() > kListed ? " and shorter ones" : "", axis.name);
    }
    return text;
  }

  /// Returns the cause with its coefficients, the distance of the next cause, and the decrease by
  /// the whole stepwise model.
  std::string in_words() const {
    const CandidateFinding& cause = result_.candidates.front();
    std::string text = said_of(cause) + ".";
    if (rivals_.best)
      text += fmt::format(" The next best other cause, {}, is {:.0f} behind.",
                          pool_.candidate(*rivals_.best).spoken, rivals_.distance);
    std::vector<std::string> beside;  // the stepwise model starts with the given model
    for (std::size_t i = 1; i < result_.ladder.size(); ++i)
      if (result_.ladder[i].said != cause.candidate.spoken) beside.push_back(result_.ladder[i].said);
    if (!beside.empty()) text += fmt::format(" Beside it: {}.", fmt::join(beside, "; "));
    return text + check_rows_in_words();
  }

  /// Returns the result of every step on the check rows, and the step that makes them worse.
  std::string check_rows_in_words() const {
    std::string way, worse;
    const bool lengths = result_.ladder[0].check_rms_um.has_value();
    const auto left = [&](const LadderStep& step) {
      return lengths ? step.check_rms_um : step.check_rms_urad;
    };
    for (std::size_t i = 0; i < result_.ladder.size(); ++i) {
      const LadderStep& step = result_.ladder[i];
      if (!left(step)) return {};
      way += fmt::format("{}{:.4g}",
                         i == 0                           ? ""
                         : i + 1 == result_.ladder.size() ? " to "
                                                          : ", ",
                         *left(step));
      if (i > 0 && *left(step) > *left(result_.ladder[i - 1]))
        worse += (worse.empty() ? "" : ", ") + step.said;
    }
    std::string text = fmt::format(" With {} effect{} the check rows go from {} {}", chosen_.size(),
                                   chosen_.size() == 1 ? "" : "s", way, lengths ? "um" : "urad");
    if (!worse.empty()) text += "; worse by " + worse;
    return text + ".";
  }

  /// Returns why one of the accepted effects cannot be what its name states; empty if all can.
  std::string doubt_of_shapes() const {
    for (const std::size_t item : chosen_)
      if (const std::string doubt = doubt_of_shape(finder_.evidence(), pool_, chosen_, item); !doubt.empty())
        return doubt;
    return {};
  }

  /// Returns where the residual fails the tests, in up to three sentences.
  std::string where_left() const {
    std::string text;
    constexpr std::size_t kSentences = 3;  // number of sentences that a reader can follow
    for (std::size_t i = 0; i < std::min(kSentences, result_.left.findings.size()); ++i)
      text += " " + result_.left.findings[i].sentence + ".";
    return text;
  }

  void name_confusions(const Rivals& rivals) {
    const auto id = [&](std::size_t item) { return pool_.candidate(item).choice.effect->id; };
    const auto note = [&](CandidateFinding& finding, const std::string& name) {
      auto& list = finding.confounded_with;
      if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    };
    std::vector<std::size_t> alike = rivals.close;
    alike.push_back(chosen_.front());
    const auto is_alike = [&](std::size_t item) {
      return std::find(alike.begin(), alike.end(), item) != alike.end();
    };
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      if (rivals.best && shown_[i] == *rivals.best) result_.runner_up = i;
      if (!is_alike(shown_[i])) continue;
      for (const std::size_t other : alike)
        if (other != shown_[i]) note(result_.candidates[i], id(other));
      if (shown_[i] == chosen_.front())
        for (const std::size_t rival : rivals.same) note(result_.candidates[i], id(rival));
    }
  }

  const DiagnoseOptions& options_;
  const VerdictThresholds& limits_;
  const model::Measurement& measurement_;
  model::Machine machine_;
  fit::FitResult base_;
  std::string text_;  // of the machine, fitted
  Finder finder_;
  const Pool& pool_;                 // of the finder
  std::vector<std::size_t> chosen_;  // of the finder, without those that gain nothing in the fit
  std::vector<std::size_t> shown_;
  std::set<std::size_t> proven_;        // items that the check rows confirm
  std::vector<std::string> disproved_;  // labels of steps that the check rows contradict
  std::string not_borne_out_;
  Rivals rivals_;
  Diagnosis result_;
};

bool is_named(Verdict verdict) {
  return verdict == Verdict::kMissingEffect || verdict == Verdict::kAmbiguous;
}

}  // namespace

std::string said_of(const CandidateFinding& finding) {
  std::vector<effects::SpokenValue> values;
  for (const fit::ParameterEstimate& one : finding.parameters)
    values.push_back({one.name, one.value, one.std});
  return effects::spoken_with_size(finding.candidate, values);
}

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMissingEffect:
      return "missing-effect";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kUnexplained:
      return "unexplained";
    case Verdict::kInstrument:
      return "instrument";
    case Verdict::kConsistent:
      break;
  }
  return "consistent";
}

namespace {

/// Runs the search, and repeats it without gross outliers if these may be the cause.
Diagnosis searched(const std::string& text, const model::Machine& machine,
                   const model::Measurement& measurement, const DiagnoseOptions& options) {
  Diagnosis all = Diagnoser(text, machine, measurement, options).run();
  if (!all.base.mistake.empty()) return all;
  // Outliers beside found effects are not the whole cause either.
  const bool more_than_outliers =
      all.verdict == Verdict::kInstrument && all.ladder.size() > 1 && !all.time_base.found;
  // Without u, no limit defines an outlier. Outliers are therefore searched in every case.
  const bool by_spread = !fit::has_uncertainty(measurement) && !all.time_base.found;
  if (all.verdict != Verdict::kUnexplained && !more_than_outliers && !by_spread) return all;
  const model::Measurement rows = model::rebind(measurement, all.base.machine, all.end.machine);
  const auto rest =
      without_gross_outliers(all.end.machine, rows, all.end.residual, options.thresholds.verdict);
  if (!rest || rows.rows() != measurement.rows()) return all;
  Diagnosis clean = Diagnoser(text, machine, model::select_rows(measurement, rest->kept), options).run();
  if (by_spread && clean.verdict == Verdict::kConsistent) {
    clean.verdict = Verdict::kInstrument;
    clean.explanation = "Outliers, and noise beside them. " + rest->sentence;
    return clean;
  }
  if (is_named(clean.verdict) || (by_spread && clean.verdict == all.verdict)) {
    clean.explanation += " " + rest->sentence;
    return clean;
  }
  if (by_spread) all.explanation += " " + rest->sentence;
  return all;
}

/// Withdraws a good verdict if the fit contradicts it: the fit did not converge, or its residual
/// exceeds that of any machine.
void heed_the_fit(Diagnosis& answer) {
  if (answer.end.absurd.empty() && answer.end.converged) return;
  const std::string why = answer.end.absurd.empty() ? "the fit did not converge" : answer.end.absurd;
  if (answer.verdict == Verdict::kConsistent) {
    answer.verdict = answer.end.converged ? Verdict::kInstrument : Verdict::kUnexplained;
    answer.explanation = "Nothing is vouched for: " + why + ".";
  } else if (is_named(answer.verdict)) {
    answer.verdict = Verdict::kUnexplained;
    answer.explanation = "No cause is named: " + why + ". " + answer.explanation;
  }
}

}  // namespace

Diagnosis diagnose(const std::string& text, const model::Machine& given,
                   const model::Measurement& measurement, const DiagnoseOptions& options) {
  model::require_time_order(measurement);
  Diagnosis answer = searched(text, effects::with_base_row(given), measurement, options);
  heed_the_fit(answer);
  return answer;
}

}  // namespace vernier::diagnose
