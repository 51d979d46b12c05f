// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tools/diagnose/causes.h"
#include "tools/diagnose/day.h"
#include "tools/diagnose/doubts/between_runs.h"
#include "tools/diagnose/doubts/course.h"
#include "tools/diagnose/doubts/of_a_file.h"
#include "tools/diagnose/doubts/shape.h"
#include "tools/diagnose/outliers.h"
#include "tools/diagnose/pieces.h"
#include "tools/diagnose/sentences.h"
#include "tools/fit/findings.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/noise/noise.h"
#include "tools/format/readings.h"
#include "tools/maths/decompositions.h"
#include "tools/model/rebind.h"

namespace vernier::diagnose {
namespace {

/// Returns the kind (Cause::kind) of the largest correlated error; empty if all readings are independent.
std::string kind_of(const fit::NoiseModel& noise) {
  double step = 0, set_up = noise.run;
  for (const fit::NoiseStep& one : noise.steps)
    (one.of_set_up() ? set_up : step) = std::max(one.of_set_up() ? set_up : step, std::abs(one.height));
  const double largest = std::max({step, set_up, noise.drift});
  if (largest <= 0) return {};
  return largest == noise.drift ? "drift" : largest == step ? "step" : "set-up";
}

class Decision {
 public:
  Decision(const Findings& found, Diagnosis& answer)
      : found_(found),
        limits_(found.options.thresholds.verdict),
        finder_(found.finder),
        pool_(found.finder.pool()),
        accepted_(found.accepted),
        answer_(answer),
        rows_(model::rebind(found.measurement, answer.base.machine, answer.end.machine)) {}

  void decide() {
    mark_open_steps();
    for (const Rule& rule : kRules) {
      std::string text = (this->*rule.explains)();
      if (text.empty()) continue;
      answer_.verdict = rule.verdict;
      answer_.explanation = std::move(text);
      // Without a named cause, the steps are candidates only.
      if (rule.verdict != Verdict::kMissingEffect && rule.verdict != Verdict::kAmbiguous)
        for (LadderStep& step : answer_.ladder) step.certain = false;
      return;
    }
  }

 private:
  /// A rule applies if it has an explanation.
  struct Rule {
    std::string (Decision::*explains)();
    Verdict verdict;
  };
  static const std::array<Rule, 21> kRules;

  // The rules, in the order of the table.

  /// The clock of the instrument is the more likely cause. What effects of the machine explain is
  /// not a clock error: a late reading looks like one.
  std::string time_base() {
    const timebase::TimeBaseFinding clock =
        timebase::examine_time_base(found_.measurement, answer_.base.residual);
    if (!clock.found) return {};
    const bool explained = !accepted_.empty() && is_mostly_explained() &&
                           !timebase::examine_time_base(rows_, answer_.end.residual).found;
    if (explained) return {};
    answer_.time_base = clock;
    answer_.instrument = "clock";
    return "The time base of the measurement: " + clock.why;
  }

  std::string outliers() {
    is_noise_ = answer_.remaining.is_noise = down_to_noise();
    pieces_ = pieces_of_one_function(finder_.evidence(), pool_, accepted_);
    if (!pieces_.empty() || (is_noise_ && !exceeds_u())) return {};
    const auto blamed = outliers_to_blame(answer_.end.machine, rows_, answer_.end.residual, limits_);
    if (!blamed) return {};
    if (blamed->is_step && !accepted_.empty()) {
      step_ = blamed->sentence;
      return {};
    }
    answer_.instrument = blamed->is_step ? "step" : "outliers";
    return blamed->sentence;
  }

  /// A step beside named effects may be of the machine: a base that moved within a run, not between two runs.
  std::string step_beside_a_name() {
    if (step_.empty()) return {};
    return fmt::format("{} No cause is named; {} is only a candidate.", step_,
                       pool_.candidate(accepted_.front()).spoken);
  }

  /// No instrument drifts from row to row: an error that does depends on the previous motion, or on a
  /// quantity that changes as fast.
  std::string error_from_row_to_row() {
    if (!accepted_.empty() || kind_of(answer_.noise) != "drift" || !drift_is_from_row_to_row()) return {};
    const std::string drift = drift_of_instrument();
    if (drift.empty()) return {};
    return with_refused(
        fmt::format("An error that changes from row to row remains, and no effect of the catalogue explains "
                    "it (noise "
                    "model: {}). It depends on the previous motion, or on a quantity that no column records.",
                    ::vernier::fit::in_words(answer_.noise, answer_.noise_unit)) +
        where_left(answer_.left));
  }

  std::string instrument_alone() {
    const std::string drift = accepted_.empty() ? drift_of_instrument() : "";
    if (drift.empty() || is_beyond_u()) return {};
    answer_.instrument = kind_of(answer_.noise);
    return drift +
           (is_noise_ ? " In addition to the drift there is nothing to add." : where_left(answer_.left));
  }

  std::string nothing_and_not_confirmed() {
    return with_refused(is_alone_in_noise() ? check_contradicts() : "");
  }

  std::string nothing_to_add() {
    if (!is_alone_in_noise()) return {};
    const std::string fit = fit_reduces_in_words(answer_.base);
    // A residual of any size can be without structure.
    if (is_noise_stated()) return with_refused("The residual is noise: there is nothing to add." + fit);
    const std::string nothing =
        "The residual has no structure that a candidate explains: there is nothing to add. ";
    if (fit::repeats_in_other_runs(found_.measurement))
      return with_refused(nothing + fit::kRepeatsInOtherRuns + fit);
    return with_refused(nothing +
                        "The readings have no u and no repeats, so the diagnosis cannot tell "
                        "whether a residual of this size is the noise of the instrument." +
                        fit);
  }

  std::string nothing_explains() {
    if (!accepted_.empty()) return {};
    const std::string drift = drift_of_instrument();
    return with_refused(
        "The residual is larger than the noise, and no effect of the catalogue explains the residual." +
        (drift.empty() ? "" : " " + drift) + where_left(answer_.left));
  }

  std::string effect_of_instrument() {
    const std::string& text = pool_.candidate(accepted_.front()).choice.effect->of_instrument;
    if (!text.empty()) answer_.instrument = "clock";
    return text;
  }

  /// An effect of another size than the residual beside it, such as an unknown tool of a robot: the search is
  /// linear, and what it found beside this effect, or doubts about it, is the part that is not linear. The
  /// fit of this effect alone is the evidence.
  std::string one_effect_is_nearly_all() {
    const double before = answer_.ladder[0].chi_square_per_freedom,
                 after = answer_.ladder[1].chi_square_per_freedom;
    const std::size_t cause = accepted_.front();
    if (after > limits_.nearly_all * before ||
        after > limits_.of_foreseen * finder_.share_left(cause) * before || !found_.close(0).empty() ||
        change_between_runs(0) || one_step(0))
      return {};
    for (std::size_t i = 2; i < answer_.ladder.size(); ++i) answer_.ladder[i].certain = false;
    compare_with_alternatives();
    if (is_noise_) return said_of_cause();
    return said_of_cause() +
           " It is so much larger than the remaining residual that other effects can be searched only beside "
           "it: add this effect, and diagnose again (the command improve does this).";
  }

  std::string not_down_to_noise() {
    compare_with_alternatives();
    if (is_noise_ || is_explained_on_check() || leaves_a_small_structure() || explains_most()) return {};
    return (is_of_the_size_of_noise()
                ? "Effects of the catalogue reduce the residual to the size of the noise, but the residual "
                  "still "
                  "has a structure, which noise does not have."
                : "Effects of the catalogue reduce the residual, but the residual remains larger than the "
                  "noise.") +
           where_left(answer_.left);
  }

  /// The residual has the size of the noise, and the structure in it is small beside the error that a
  /// confirmed step removes: 0.8 um of the interpolation between stations beside a backlash of 12 um. Such a
  /// step is certain, whatever the structure is. Steps that are not so much larger are not.
  bool leaves_a_small_structure() {
    if (!is_of_the_size_of_noise() || answer_.left.findings.empty() || answer_.ladder.front().rms_urad)
      return false;
    const double structure_um2 = mean_square_of_structure();
    const auto stands = [&](std::size_t step) {
      const std::size_t item = accepted_[step - 1];
      const double before = answer_.ladder[step - 1].rms_um.value_or(0),
                   after = answer_.ladder[step].rms_um.value_or(0);
      return found_.confirmed.contains(item) && !pool_.is_custom(item) && found_.close(step - 1).empty() &&
             structure_um2 < limits_.small_structure * (before * before - after * after);
    };
    if (!stands(1)) return false;
    for (std::size_t step = 2; step < answer_.ladder.size(); ++step)
      if (!stands(step)) answer_.ladder[step].certain = false;
    return true;
  }

  /// Mean square of the structure that is left, over all fit readings as the mean square of a step, um^2: a
  /// finding is in one kind of reading.
  double mean_square_of_structure() const {
    std::map<std::string, double> count;
    double all = 0, sum = 0;
    for (const model::Observation& one : rows_.observations) {
      if (rows_.check[one.row] != 0) continue;
      count[format::name_of(one.kind)] += 1;
      all += 1;
    }
    for (const residual::Finding& finding : answer_.left.findings)
      sum += finding.rms_um * finding.rms_um * count[finding.observation];
    return sum / std::max(1.0, all);
  }

  /// Certain steps explain most of the error beyond u, the first of them the larger part: they are named,
  /// whatever the rest is, and the sentence says that the rest is not noise. A step is certain if the check
  /// rows confirm it, no other cause explains it, and it explains more than it leaves; the first step may
  /// leave what the later ones explain.
  bool explains_most() {
    const std::vector<LadderStep>& ladder = answer_.ladder;
    const double before = ladder[0].chi_square_per_freedom - 1;
    const double chance = limits_.noise_sigmas * std::sqrt(2 / std::max(1.0, answer_.end.freedom));
    if (!fit::has_uncertainty(found_.measurement) || before < chance) return false;
    double explained = 0;
    std::vector<std::size_t> uncertain;
    for (std::size_t step = 1; step < ladder.size(); ++step) {
      const std::size_t item = accepted_[step - 1];
      const double left = ladder[step].chi_square_per_freedom - 1,
                   own = ladder[step - 1].chi_square_per_freedom - 1 - left;
      const bool stands = found_.confirmed.contains(item) && found_.close(step - 1).empty() &&
                          (step > 1 ? own >= left : !pool_.is_custom(item) && own > before - own);
      if (step == 1 && !stands) return false;
      if (!stands)
        uncertain.push_back(step);
      else if (!pool_.is_custom(item))
        explained += own;
    }
    if (explained < limits_.most_of_excess * before) return false;
    for (const std::size_t step : uncertain) answer_.ladder[step].certain = false;
    return true;
  }

  bool is_of_the_size_of_noise() const {
    const double freedom = std::max(1.0, answer_.end.freedom);
    return fit::has_uncertainty(found_.measurement) &&
           answer_.remaining.chi_square_per_freedom < 1 + limits_.noise_sigmas * std::sqrt(2 / freedom);
  }

  std::string pieces() {
    return pieces_.empty() ? "" : or_rest("", pieces_in_words(names_of(pieces_)), pieces_);
  }

  /// u states the whole uncertainty of a reading. If named effects leave a drift that u does not contain, the
  /// drift may be another error of the machine that no recorded quantity follows. An input, the time or the
  /// run can follow this error by chance: the whitened residual does not show it.
  /// No instrument drifts from row to row: such a drift is an error of the machine beside every effect.
  std::string drift_beyond_u() {
    if (answer_.noise.drift <= 0 || !fit::has_uncertainty(found_.measurement)) return {};
    const bool quick = drift_is_from_row_to_row();
    const auto doubtful = std::find_if(accepted_.begin(), accepted_.end(),
                                       [&](std::size_t item) { return quick || can_follow_a_drift(item); });
    if (doubtful == accepted_.end()) return {};
    const double square = mean_square_beside_steps(quick);
    // Effects that explain less than the drift leaves may be a part of the same unknown error.
    if (square <= limits_.doubtful_uncertainty &&
        square - 1 <= explained_by_steps(0, answer_.ladder.size() - 1))
      return {};
    return fmt::format(
               "An error that changes {} remains, and u does not state this error: the residual of the "
               "readings is {:.2g} u (noise model: {}). Either the instrument drifts, or an error of the "
               "machine depends on no recorded quantity. No cause is named; {} is only a candidate.{}",
               quick ? "from row to row" : "slowly", std::sqrt(square),
               ::vernier::fit::in_words(answer_.noise, answer_.noise_unit), pool_.candidate(*doubtful).spoken,
               check_rows_in_words(answer_.ladder, accepted_.size())) +
           where_left(answer_.left);
  }

  /// An error that steps again and again, to as many steps as a model of the noise may have, and that u does
  /// not state: a load that nobody recorded rather than an instrument that was knocked. An effect of an input
  /// or of the time that explains less than the steps may be a part of it.
  std::string steps_beyond_u() {
    if (!fit::has_uncertainty(found_.measurement)) return {};
    std::set<std::size_t> rows;
    for (const fit::NoiseStep& step : answer_.noise.steps)
      if (!step.of_set_up()) rows.insert(step.row);
    if (rows.size() < limits_.most_steps) return {};
    const auto doubtful = std::find_if(accepted_.begin(), accepted_.end(),
                                       [&](std::size_t item) { return can_follow_a_drift(item); });
    if (doubtful == accepted_.end()) return {};
    const double left = answer_.ladder.back().chi_square_per_freedom;
    if (left - mean_square_beside_steps(false) <= answer_.ladder.front().chi_square_per_freedom - left)
      return {};
    return fmt::format(
        "The readings step at {} rows or more, and u does not state these steps. An error of the machine "
        "that depends on no recorded quantity, such as a load, can look like this. No cause is named; {} is "
        "only "
        "a candidate.{}",
        rows.size(), pool_.candidate(*doubtful).spoken,
        check_rows_in_words(answer_.ladder, accepted_.size()));
  }

  /// A warm-up in time beside an effect of a temperature: probably one response to heat that no thermometer
  /// of the survey follows. A warm-up that is small beside this effect is its lag, or that of the
  /// thermometer: the effect keeps its name, and the warm-up has none.
  std::string heat_without_thermometer() {
    const std::vector<std::size_t> parts = pieces_of_unrecorded_heat(finder_.evidence(), pool_, accepted_);
    if (parts.empty()) return "";
    const std::string why = unrecorded_heat_in_words(names_of(parts));
    const std::size_t warm_up = static_cast<std::size_t>(
        std::find(accepted_.begin(), accepted_.end(), parts.back()) - accepted_.begin());
    if (parts.front() != accepted_.front() ||
        explained_by_steps(warm_up, warm_up + 1) >= limits_.small_structure * explained_by_steps(0, 1))
      return why;
    answer_.ladder[warm_up + 1].certain = false;
    doubtful_.push_back(parts.back());
    rest_ = no_certain_cause(names_of({parts.back()}).front() + ".");
    return {};
  }

  /// The error of the check rows must not exceed that of the fit rows, except for their own scatter
  /// and the uncertainty of the model's parameters.
  std::string check_contradicts() {
    const auto& check = answer_.end.normalised_check;
    if (!check) return {};
    const double freedom = std::max(1.0, answer_.end.freedom);
    const double with_u =
        fit::has_uncertainty(found_.measurement) ? std::max(1.0, answer_.end.chi_square / freedom) : 1;
    const double ratio = check->rms * check->rms / with_u;
    const double std = std::hypot(check->square_std / with_u, ratio * std::sqrt(2 / freedom));
    if (ratio < 1 + found_.options.thresholds.proof.carries_sigmas * std) return {};
    return fmt::format(
        "The improvement is not confirmed on held-out rows: the residual of the check rows is {:.2g} times "
        "that of the fit rows.",
        std::sqrt(ratio));
  }

  /// Searched terms are likely pieces of one function if two of them are at one degree of freedom,
  /// or if the check rows do not confirm one of them.
  std::string terms_without_name() {
    std::vector<effects::DofPlace> places;
    bool apart = true;
    for (const std::size_t item : accepted_) {
      if (!pool_.is_custom(item)) continue;
      const effects::DofPlace place = pool_.candidate(item).terms.front().place;
      apart = apart && found_.confirmed.contains(item) &&
              std::find(places.begin(), places.end(), place) == places.end();
      places.push_back(place);
    }
    if (places.size() < 2 || apart) return {};
    return fmt::format(
        "{} terms without a physical name reduce the residual to the noise: they are probably parts of an "
        "effect that is not in the catalogue.",
        places.size());
  }

  /// One of the accepted effects cannot be what its name states.
  std::string shape_contradicts() {
    std::vector<std::size_t> doubtful;
    std::string why;  // of the first one
    for (const std::size_t item : accepted_)
      if (const std::string doubt = doubt_of(finder_.evidence(), pool_, accepted_, item); !doubt.empty()) {
        if (doubtful.empty()) why = doubt;
        doubtful.push_back(item);
      }
    if (doubtful.empty()) return {};
    if (is_most_of_the_error(doubtful)) {
      for (std::size_t step = 2; step < answer_.ladder.size(); ++step) answer_.ladder[step].certain = false;
      if (rest_.empty()) rest_ = no_certain_cause(why + ".");
      doubtful_.insert(doubtful_.end(), doubtful.begin(), doubtful.end());
      return {};
    }
    return or_rest("The residual is reduced to the noise, but the cause cannot be named: ", why + ".",
                   doubtful);
  }

  /// The first effect has no doubt of its own, no other cause, is confirmed by check rows, and explains most
  /// of what all effects explain: it keeps its name, whatever the doubtful ones are.
  bool is_most_of_the_error(const std::vector<std::size_t>& doubtful) const {
    const std::size_t first = accepted_.front();
    return std::find(doubtful.begin(), doubtful.end(), first) == doubtful.end() && !pool_.is_custom(first) &&
           answer_.ladder[1].of_check_rows && found_.close(0).empty() &&
           explained_by_steps(0, 1) >=
               limits_.most_of_excess * explained_by_steps(0, answer_.ladder.size() - 1);
  }

  /// Returns the reason why no cause is named; or nothing, if the first effect stays a cause whatever the
  /// doubtful ones are. The reason is then that of the rest.
  std::string or_rest(const std::string& begin, const std::string& why,
                      const std::vector<std::size_t>& doubtful) {
    const auto stands = [&](std::size_t item) {
      return stands_beside(finder_.evidence(), pool_, item, doubtful);
    };
    if (!stands(accepted_.front())) return begin + why;
    for (std::size_t i = 0; i < accepted_.size(); ++i)
      if (!stands(accepted_[i])) answer_.ladder[i + 1].certain = false;
    if (rest_.empty()) rest_ = no_certain_cause(why);
    doubtful_.insert(doubtful_.end(), doubtful.begin(), doubtful.end());
    return {};
  }

  /// The positions do not distinguish the found period from others. Sets the aliases of all
  /// accepted effects, and explains the first one that has any.
  std::string other_periods() {
    std::string text;
    for (const std::size_t item : accepted_) {
      if (std::find(doubtful_.begin(), doubtful_.end(), item) != doubtful_.end()) continue;
      const std::vector<double> aliases = finder_.aliases_of(item);
      if (aliases.empty()) continue;
      const auto listed = std::find(found_.listed.begin(), found_.listed.end(), item);
      if (listed != found_.listed.end())
        answer_.candidates[static_cast<std::size_t>(listed - found_.listed.begin())].aliases = aliases;
      if (text.empty())
        text = aliases_in_words(pool_.candidate(item), pool_[item].scored.scanned.front(), aliases,
                                found_.machine.axes[*pool_.candidate(item).choice.axis]);
    }
    return text.empty() ? text : text + rest();
  }

  std::string several_causes() {
    const std::size_t others = found_.close(0).size();
    const bool or_set_up = set_up_explains_it_too();
    const bool or_day = !or_set_up && daily_drift_explains(finder_.evidence(), pool_, accepted_.front(),
                                                           {accepted_.begin() + 1, accepted_.end()},
                                                           found_.options.thresholds.acceptance.distance);
    const bool or_run = !or_set_up && !or_day && change_between_runs(0);
    const bool or_step = !or_set_up && !or_day && one_step(0);
    const bool or_change = or_set_up || or_run || or_step;
    const std::string drifting =
        or_change || or_day ? std::string()
                            : file_whose_drift_explains(finder_.evidence(), pool_, accepted_.front(),
                                                        {accepted_.begin() + 1, accepted_.end()},
                                                        found_.options.thresholds.acceptance.distance);
    const bool or_file = !drifting.empty();
    if (others == 0 && !or_change && !or_day && !or_file) return {};
    if (or_change) answer_.instrument = "set-up";
    if (or_day || or_file) answer_.instrument = "drift";
    std::string further;
    if (or_set_up)
      further = " An instrument that was set up anew between the runs is a further possible cause.";
    else if (or_run)
      further =
          " A change of the machine or of its set-up between the runs, such as a collision, is a further "
          "possible cause.";
    else if (or_step)
      further = one_step_in_words();
    if (or_step) further += go_back_in_words();
    if (or_day) further += " An instrument that drifts with the time of day is a further possible cause.";
    if (or_file)
      further += fmt::format(" A drift of the instrument of {} alone is a further possible cause.", drifting);
    return fmt::format("{} causes explain these data equally well; the most likely cause is {}.",
                       1 + others + (or_change || or_day || or_file ? 1 : 0),
                       pool_.candidate(accepted_.front()).spoken) +
           further + rest();
  }

  /// The sentence about the first effect, the next best cause and the certain steps beside it.
  std::string said_of_cause() const {
    const std::vector<Alternative>& other = found_.alternatives.front().other;
    return cause_in_words(answer_.candidates.front(),
                          other.empty() ? std::string() : pool_.candidate(other.front().item).spoken,
                          other.empty() ? 0 : other.front().distance, answer_.ladder, accepted_.size()) +
           or_a_reflector() + or_a_drift();
  }

  static std::string no_certain_cause(const std::string& what) {
    return " The other part of the error has no certain cause: " + what;
  }

  /// The same effect of two axes can have the same columns: a lag on a circle.
  std::string only_the_difference() const {
    for (std::size_t i = 0; i < accepted_.size(); ++i)
      if (const std::vector<std::string> names = of_other_axes(found_, i); !names.empty())
        return difference_in_words(pool_.candidate(accepted_[i]).spoken, names);
    return {};
  }

  /// An offset behind the last axis moves the tool point only, as the place of a reflector on the tool does.
  std::string or_a_reflector() const {
    const model::Machine& machine = found_.machine;
    if (!machine.tool_shifts.empty() || found_.measurement.observations.empty()) return {};
    for (const std::size_t item : accepted_) {
      const effects::Choice& choice = pool_.candidate(item).choice;
      if (choice.form->place != effects::PlaceRule::kPoint || !choice.place || choice.place->workpiece)
        continue;
      const auto moves = [](const model::Transform& transform) {
        for (std::size_t dof = 0; dof < transform.dof_count(); ++dof)
          if (model::any_node(*transform.dof[dof], [](const model::Expr& node) {
                return node.op == model::Op::kSymbol && (node.symbol.kind == model::SymbolKind::kAxis ||
                                                         node.symbol.kind == model::SymbolKind::kTableValue);
              }))
            return true;
        return false;
      };
      const auto behind = machine.tool.begin() + static_cast<std::ptrdiff_t>(choice.place->transform) + 1;
      const bool turns = std::any_of(machine.axes.begin(), machine.axes.end(),
                                     [](const model::Axis& axis) { return axis.rotary; });
      if (turns && std::none_of(behind, machine.tool.end(), moves)) return reflector_in_words(machine.file);
    }
    return {};
  }

  std::string one_cause() {
    std::string text = said_of_cause() + only_the_difference();
    if (!is_noise_)
      text += " The remaining residual is not noise." + where_left(answer_.left);
    else
      text += most_remains();
    return text + rest();
  }

  /// Without u and without repeats nothing states the noise: what the named effects leave can be another
  /// error.
  std::string most_remains() const {
    constexpr double kMostIsLeft = 0.5;  // of the mean square
    const fit::RoleStatistics &before = answer_.base.after, &after = answer_.end.after;
    if (is_noise_stated() || !before.rms_um || !after.rms_um ||
        *after.rms_um * *after.rms_um < kMostIsLeft * *before.rms_um * *before.rms_um)
      return {};
    return most_remains_in_words(*before.rms_um, *after.rms_um);
  }

  /// Sentences about the parts of the error that have no certain cause beside the named one.
  std::string rest() const { return open_steps_in_words(answer_.ladder) + rest_; }

  // What the rules need.

  /// What the steps of the ladder after `from` up to `to` explain, in chi^2 per degree of freedom.
  double explained_by_steps(std::size_t from, std::size_t to) const {
    return answer_.ladder[from].chi_square_per_freedom - answer_.ladder[to].chi_square_per_freedom;
  }

  /// Do u or repeats state the noise of the readings?
  bool is_noise_stated() const {
    return fit::has_uncertainty(found_.measurement) || fit::noise_um(found_.measurement) ||
           fit::noise_urad(found_.measurement);
  }

  /// Is a change between the runs as good a cause as the accepted effect at this position?
  bool change_between_runs(std::size_t position) const {
    return sizes_of_runs_explain(finder_.evidence(), pool_, accepted_, position,
                                 found_.options.thresholds.acceptance.distance);
  }

  /// Is one step of the machine, at a change of the input of the accepted effect, as good a cause?
  bool one_step(std::size_t position) const {
    return one_step_explains(finder_.evidence(), pool_, accepted_, position,
                             found_.options.thresholds.acceptance.distance);
  }

  /// A shift of all poses with the time alone is the same for a machine and for its instrument.
  std::string or_a_drift() const {
    const auto drivers = drivers_of(finder_.evidence().machine(), pool_.candidate(accepted_.front()));
    const bool time_alone = !drivers.empty() && std::ranges::all_of(drivers, [](const auto& driver) {
      return static_cast<model::SymbolKind>(driver.first) == model::SymbolKind::kTime;
    });
    return time_alone ? drift_of_instrument_in_words() : "";
  }

  /// A later step with several causes is not certain: a cause that only fits as well need not fit at other
  /// temperatures, speeds or times.
  void mark_open_steps() {
    for (std::size_t i = 1; i < accepted_.size(); ++i) {
      if (change_between_runs(i) || one_step(i)) answer_.ladder[i + 1].certain = false;
      if (found_.close(i).empty()) continue;
      answer_.ladder[i + 1].certain = false;
      answer_.ladder[i + 1].causes = causes_of_step(found_, i);
    }
  }

  /// A shift in one run may be a moved base. Shifts in several runs, or beside set-up noise, are those of an
  /// instrument that was set up anew as well, unless they occur within a set-up.
  bool set_up_explains_it_too() const {
    if (pool_.candidate(accepted_.front()).choice.runs.empty()) return false;
    std::set<std::string> runs;  // that one of the steps shifts
    for (const std::size_t item : accepted_)
      for (const std::string& run : pool_.candidate(item).choice.runs) runs.insert(run);
    if (runs.size() == 1 && kind_of(answer_.noise) != "set-up") return false;
    const model::States& states = rows_.states;
    std::set<std::size_t> shifted, others;  // set-ups
    for (std::size_t row = 0; row < states.run.size(); ++row) {
      const bool moved = runs.contains(states.run_names[states.run[row]]);
      (moved ? shifted : others).insert(states.of(states.setup, row));
    }
    return std::none_of(shifted.begin(), shifted.end(),
                        [&](std::size_t set_up) { return others.contains(set_up); });
  }

  /// With u: is chi^2 larger than noise of this size explains? A single outlier among many readings raises it
  /// without a structure.
  bool exceeds_u() const {
    const double freedom = std::max(1.0, answer_.end.freedom);
    return fit::has_uncertainty(found_.measurement) &&
           answer_.end.chi_square / freedom > 1 + limits_.noise_sigmas * std::sqrt(2 / freedom);
  }

  bool is_alone_in_noise() const { return accepted_.empty() && is_noise_; }

  /// Appends the steps that the check rows contradict to an explanation that is not empty.
  std::string with_refused(std::string text) const {
    const std::string refused = not_confirmed_in_words(found_.not_confirmed);
    if (!text.empty() && !refused.empty()) text += " " + refused;
    return text;
  }

  std::vector<std::string> names_of(const std::vector<std::size_t>& items) const {
    std::vector<std::string> names;
    for (const std::size_t item : items) names.push_back(pool_.candidate(item).spoken);
    return names;
  }

  /// The residual at the end of the stepwise model (mm, deg) without the correlated errors of the
  /// fit rows: the residual of independent readings.
  Eigen::VectorXd independent_residual() const {
    const fit::NoiseModel& noise = answer_.noise;
    Eigen::VectorXd residual = answer_.end.residual;
    if (noise.independent() && noise.own == 1) return residual;
    const Eigen::VectorXd weights = fit::fit_weights(rows_);
    const std::vector<std::size_t> fitted = fit::fitted_readings(weights);
    Eigen::MatrixXd left = weights(fitted).cwiseProduct(residual(fitted));
    const fit::NoiseLayout layout = fit::noise_layout(rows_, fitted, found_.options.thresholds.layout);
    fit::whiten(layout, noise, left);
    if (!noise.steps.empty()) {
      // The fit did not contain the steps and absorbed part of them. That part is removed together
      // with them.
      const Eigen::MatrixXd &seen = finder_.evidence().absorbed(), named = pool_.columns(accepted_);
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
    const double unit = fit::has_uncertainty(rows_) ? 1 : noise.own;
    residual(fitted) = unit * left.col(0).cwiseQuotient(weights(fitted));
    return residual;
  }

  bool drift_is_from_row_to_row() const {
    constexpr double kRowsWithoutU = 2;  // without u a longer drift can be the noise of the instrument itself
    const double rows = fit::has_uncertainty(found_.measurement) ? limits_.rows_of_a_drift : kRowsWithoutU;
    const fit::NoiseLayout layout = fit::noise_layout(rows_, fit::fitted_readings(fit::fit_weights(rows_)),
                                                      found_.options.thresholds.layout);
    return answer_.noise.time_constant < rows * layout.step;
  }

  /// Can a term repeat a part of a drift? True if the term depends on an input, the time or the run, at any
  /// position, or if only a search of products found it.
  bool can_follow_a_drift(std::size_t item) const {
    return pool_.is_custom(item) ||
           change_in_time(drivers_of(finder_.evidence().machine(), pool_.candidate(item)));
  }

  /// Returns the mean square of the weighted residual of the fit readings, correlated errors included, except
  /// for the steps of the instrument. `drifting`: true selects the readings that drift.
  double mean_square_beside_steps(bool drifting) const {
    const fit::NoiseModel& noise = answer_.noise;
    const Eigen::VectorXd weights = fit::fit_weights(rows_);
    const std::vector<std::size_t> fitted = fit::fitted_readings(weights);
    Eigen::VectorXd left = weights(fitted).cwiseProduct(answer_.end.residual(fitted));
    if (!noise.steps.empty()) {
      const fit::NoiseLayout layout = fit::noise_layout(rows_, fitted, found_.options.thresholds.layout);
      const Eigen::MatrixXd columns = fit::step_columns(layout, noise.steps, left.size());
      left -= columns * maths::least_norm(columns, left);
    }
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      const auto kind = static_cast<int>(rows_.observations[fitted[i]].kind);
      if (drifting && !fit::is_drifting(noise.drifts, kind)) continue;
      sum += std::pow(left[static_cast<Eigen::Index>(i)], 2);
      ++count;
    }
    const double freedom = std::max(1.0, answer_.end.freedom) / static_cast<double>(fitted.size());
    return sum / std::max(1.0, freedom * count);
  }

  /// Returns a sentence about the instrument if errors correlated in time or by run are as large
  /// as the independent noise; else empty.
  std::string drift_of_instrument() const {
    const fit::NoiseModel& noise = answer_.noise;
    double drift = std::hypot(noise.run, noise.drift);
    for (const fit::NoiseStep& step : noise.steps) drift = std::max(drift, std::abs(step.height));
    if (drift < limits_.drift_share * noise.own || noise.support < limits_.drift_support) return {};
    return "The residual drifts or changes in steps, as the readings of a moving instrument or base do: " +
           ::vernier::fit::in_words(noise, answer_.noise_unit) +
           ". An error that the catalogue does not contain can look the same.";
  }

  /// True if the errors of single readings, beside drift, set-ups and poses, exceed the stated
  /// uncertainty by more than a too small uncertainty explains. The others may have any size.
  bool is_beyond_u() const {
    const fit::NoiseModel& noise = answer_.noise;
    return fit::has_uncertainty(found_.measurement) && !noise.independent() &&
           noise.own * noise.own > limits_.implausible_uncertainty;
  }

  /// Is one of the candidates, accepted or not, significant beside the accepted effects and noise
  /// of the size of the residual?
  bool something_stands_out() const {
    for (std::size_t item = 0; item < pool_.size(); ++item) {
      const bool chosen = std::find(accepted_.begin(), accepted_.end(), item) != accepted_.end();
      if (!chosen && finder_.p_value_beside(item, accepted_) < limits_.stands_out) return true;
    }
    return false;
  }

  /// Is the residual of the fit at the end of the stepwise model noise? If the uncertainty is
  /// given, chi^2 decides. If chi^2 is so little above it that the uncertainty may be too small,
  /// or if no uncertainty is given, remaining structure decides.
  bool down_to_noise() {
    const model::Machine& machine = answer_.end.machine;
    residual::StructureOptions structure;
    structure.fitted_parameters = static_cast<std::size_t>(answer_.end.observability.rank);
    const Eigen::VectorXd left = independent_residual();
    answer_.left = residual::failure_picture(machine, rows_, left, structure);
    const bool structured = answer_.left.omnibus_p < limits_.structure;
    const double freedom = std::max(1.0, answer_.end.freedom);
    const Eigen::VectorXd weights = fit::fit_weights(rows_);
    const fit::NoiseModel& noise = answer_.noise;
    const bool told = !noise.independent() || noise.own != 1;
    const double reduced =
        (told ? weights.cwiseProduct(left).squaredNorm() : answer_.end.chi_square) / freedom;
    answer_.remaining.chi_square_per_freedom = reduced;
    if (!fit::has_uncertainty(found_.measurement)) return !structured || stands_without_u();
    // Noise above the stated value is accepted only if no tested candidate is significant, and if
    // there are enough readings to show structure.
    const double own = noise.independent() ? answer_.end.chi_square / freedom : noise.own * noise.own;
    if (own > limits_.doubtful_uncertainty) {
      if (own > limits_.implausible_uncertainty || something_stands_out()) return false;
      // With too few readings to show structure, the requirement is the same as without u.
      if (noise.independent() && freedom < limits_.enough_readings) return !structured && stands_without_u();
    }
    const double sigmas = (reduced - 1) / std::sqrt(2 / freedom);
    if (structured) return false;
    if (sigmas < limits_.noise_sigmas) return true;
    // u may be too small. The check rows can refuse the form of an effect whose error is real.
    return reduced < limits_.doubtful_uncertainty && !something_stands_out();
  }

  /// Is the first effect larger than the residual beside it, and is most of chi^2 explained?
  bool stands_without_u() const {
    return !accepted_.empty() && is_mostly_explained() &&
           finder_.growth_without(accepted_.front()) > limits_.larger_than_rest;
  }

  bool is_mostly_explained() const {
    return answer_.end.chi_square < (1 - limits_.mostly_explained) * answer_.base.chi_square;
  }

  /// Without u nothing states the noise: the residual may have structure. Do confirmed steps, the first of
  /// them a named effect, remove nearly all of the error of the check rows?
  bool is_explained_on_check() const {
    if (fit::has_uncertainty(found_.measurement) || pool_.is_custom(accepted_.front())) return false;
    for (const std::size_t item : accepted_)
      if (!found_.confirmed.contains(item)) return false;
    const std::optional<double>& before = answer_.ladder.front().check_rms_um;
    const std::optional<double>& after = answer_.ladder.back().check_rms_um;
    return before && after && *after * *after < (1 - limits_.explained_on_check) * *before * *before;
  }

  void compare_with_alternatives() {
    name_confusions();
    if (const auto& other = found_.alternatives.front().other; !other.empty())
      answer_.runner_up_distance = other.front().distance;
  }

  /// Sets which listed candidates cannot be distinguished from the cause.
  void name_confusions() {
    const Alternatives& alternatives = found_.alternatives.front();
    const auto id = [&](std::size_t item) { return pool_.candidate(item).choice.effect->id; };
    const auto note = [&](CandidateFinding& finding, const std::string& name) {
      auto& list = finding.confounded_with;
      if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    };
    std::vector<std::size_t> alike = found_.close(0);
    alike.push_back(accepted_.front());
    const auto is_alike = [&](std::size_t item) {
      return std::find(alike.begin(), alike.end(), item) != alike.end();
    };
    for (std::size_t i = 0; i < found_.listed.size(); ++i) {
      if (!alternatives.other.empty() && found_.listed[i] == alternatives.other.front().item)
        answer_.runner_up = i;
      if (!is_alike(found_.listed[i])) continue;
      for (const std::size_t other : alike)
        if (other != found_.listed[i]) note(answer_.candidates[i], id(other));
      if (found_.listed[i] == accepted_.front())
        for (const std::size_t other : alternatives.same) note(answer_.candidates[i], id(other));
    }
  }

  const Findings& found_;
  const VerdictThresholds& limits_;
  const Finder& finder_;
  const Pool& pool_;  // of the finder
  const std::vector<std::size_t>& accepted_;
  Diagnosis& answer_;
  const model::Measurement rows_;  // for the machine at the end of the stepwise model
  bool is_noise_ = false;          // is the residual at that end noise?
  std::vector<std::size_t> pieces_;
  std::vector<std::size_t> doubtful_;  // effects beside a named one that cannot be what their names state
  std::string rest_;                   // why
  std::string step_;  // sentence about rows that step together, if the residual of the other rows is noise
};

// The order is the precedence: the instrument before the machine, no name before a doubtful name,
// several names before one.
const std::array<Decision::Rule, 21> Decision::kRules = {{
    {&Decision::time_base, Verdict::kInstrument},
    {&Decision::outliers, Verdict::kInstrument},
    {&Decision::step_beside_a_name, Verdict::kUnexplained},
    {&Decision::error_from_row_to_row, Verdict::kUnexplained},
    {&Decision::instrument_alone, Verdict::kInstrument},
    {&Decision::nothing_and_not_confirmed, Verdict::kUnexplained},
    {&Decision::nothing_to_add, Verdict::kConsistent},
    {&Decision::nothing_explains, Verdict::kUnexplained},
    {&Decision::effect_of_instrument, Verdict::kInstrument},
    {&Decision::one_effect_is_nearly_all, Verdict::kMissingEffect},
    {&Decision::not_down_to_noise, Verdict::kUnexplained},
    {&Decision::pieces, Verdict::kUnexplained},
    {&Decision::drift_beyond_u, Verdict::kUnexplained},
    {&Decision::steps_beyond_u, Verdict::kUnexplained},
    {&Decision::heat_without_thermometer, Verdict::kUnexplained},
    {&Decision::check_contradicts, Verdict::kUnexplained},
    {&Decision::terms_without_name, Verdict::kUnexplained},
    {&Decision::shape_contradicts, Verdict::kUnexplained},
    {&Decision::other_periods, Verdict::kAmbiguous},
    {&Decision::several_causes, Verdict::kAmbiguous},
    {&Decision::one_cause, Verdict::kMissingEffect},
}};

}  // namespace

void set_verdict(const Findings& found, Diagnosis& answer) { Decision(found, answer).decide(); }

}  // namespace vernier::diagnose
