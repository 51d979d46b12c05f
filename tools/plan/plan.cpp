// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/median.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/rebind.h"
#include "tools/plan/choice.h"
#include "tools/plan/offers.h"
#include "tools/plan/other_hypotheses.h"
#include "tools/plan/sentence.h"

namespace vernier::plan {
namespace {

/// One reading must not decide.
constexpr std::size_t kLeastPoints = 4;
/// So many points may always be spent on the other effects that explain the rows.
constexpr std::size_t kModerate = 16;
/// A plan that goes back to the first values of the inputs measures one row before, and two after.
constexpr std::size_t kLeastReturn = 3;
constexpr std::size_t kMostExisting = 1500;
/// Time for a part to take on a new temperature before it is measured again, s.
constexpr double kSoakS = 3600;

/// Sides of the two named effects, before those of the other hypotheses.
constexpr std::size_t kPair = 2;

/// First observation of each row, and one past the last.
std::vector<Eigen::Index> first_observations(const model::Measurement& m) {
  std::vector<Eigen::Index> first(m.rows() + 1, 0);
  for (const model::Observation& o : m.observations) ++first[o.row + 1];
  for (std::size_t row = 0; row < m.rows(); ++row) first[row + 1] += first[row];
  return first;
}

class Planner {
 public:
  Planner(const std::string& text, const model::Machine& machine, const model::Measurement& measurement,
          const std::string& a, const std::string& b, const std::vector<effects::Effect>& effects,
          const PlanOptions& options)
      : options_(options), model_(fit_model(text, machine, measurement)) {
    plan_.a = fit_hypothesis(model_, measurement, a, effects);
    plan_.b = fit_hypothesis(model_, measurement, b, effects);
    plan_.machine = model_.machine;
    free_shift_of_plan(plan_.a.machine);
    free_shift_of_plan(plan_.b.machine);
    drivers_ = drivers_of(std::vector<const FittedHypothesis*>{&plan_.a, &plan_.b});
    plan_.rows = model::select_rows(measurement, {});
    existing_ = rows_to_build_on(measurement, drivers_, kMostExisting);
    spread_ = spread();
    other_hypotheses_ = find_other_hypotheses(model_, measurement, {&plan_.a, &plan_.b}, effects,
                                              options.most_other_hypotheses);
    for (FittedHypothesis& other : other_hypotheses_) free_shift_of_plan(other.machine);
    keep_complete_others();
  }

  Plan plan() {
    Offers offers = offer_rows(model_.machine, existing_, drivers_, options_.offers);
    plan_.not_settable = offers.not_settable;
    const Sides sides = sides_of(offers.rows, offers.existing);
    plan_.a_true.needed = sides.needed[0];
    plan_.b_true.needed = sides.needed[1];
    note(sides, &Separation::now);
    plan_.lead_of_a = lead_of_a();
    // Distinguished by the expected or by the present evidence of the rows.
    plan_.told_already = sides.reached(kPair) >= 1 || std::abs(plan_.lead_of_a) > plan_.worse().needed;
    if (!plan_.told_already || options_.points) choose(offers);
    if (plan_.rows.rows() > 0 && plan_.separable)
      for (const FittedHypothesis& other : other_hypotheses_)
        plan_.ruled_out.push_back(other.candidate.spoken);
    if (plan_.rows.rows() > 0 && plan_.separable && follows_settable_input())
      (beyond_step_ >= 1 ? plan_.ruled_out : plan_.not_ruled_out)
          .emplace_back("one change of the machine or of its set-up when an input changes");
    plan_.sentence = Explanation(plan_, existing_).sentence();
    return std::move(plan_);
  }

 private:
  /// If every run has its BaseShift, the new run gets one too.
  static void free_shift_of_plan(model::Machine& machine) {
    bool own = false, plain = false;
    for (const model::BaseShift& shift : machine.base_shifts) {
      own = own || (shift.run && !shift.hidden);
      plain = plain || !shift.run;
    }
    if (!own || plain) return;
    model::BaseShift shift;
    shift.run = kPlanRun;
    machine.base_shifts.push_back(shift);
  }

  model::Measurement bound_to(const model::Measurement& rows, const FittedHypothesis& hypothesis) const {
    return model::rebind(rows, model_.machine, hypothesis.machine);
  }

  double weighted_square(const FittedHypothesis& hypothesis) const {
    const model::Measurement bound = bound_to(existing_, hypothesis);
    return fit::residuals(hypothesis.machine, bound).cwiseProduct(fit::fit_weights(bound)).squaredNorm();
  }

  /// Divisor of the weight 1/u: the standard deviation of the residual of the better effect, not below 1 if u
  /// is given.
  double spread() const {
    double least = 1e300;
    for (const FittedHypothesis* hypothesis : {&plan_.a, &plan_.b}) {
      const double freedom = std::max<double>(1, static_cast<double>(existing_.observations.size()) -
                                                     static_cast<double>(parameters_of(*hypothesis).size()));
      least = std::min(least, std::sqrt(weighted_square(*hypothesis) / freedom));
    }
    if (fit::has_uncertainty(existing_)) return std::max(1.0, least);
    return std::max(least, 1e-9);  // exact readings: a picometre
  }

  /// By how much B explains the rows so far worse than A: chi^2 and the price of the unknowns (BIC).
  double lead_of_a() const {
    const double price = std::log(static_cast<double>(existing_.observations.size()));
    const auto cost = [&](const FittedHypothesis& hypothesis) {
      return weighted_square(hypothesis) / (spread_ * spread_) +
             price * static_cast<double>(hypothesis.candidate.unknowns.size());
    };
    return cost(plan_.b) - cost(plan_.a);
  }

  model::ParameterSet parameters_of(const FittedHypothesis& hypothesis) const {
    std::vector<std::string> setups = existing_.states.names(existing_.states.setup);
    setups.emplace_back(kPlanRun);
    return {hypothesis.machine, setups};
  }

  /// Another hypothesis with an input that the rows lack here and there is left aside.
  void keep_complete_others() {
    std::erase_if(other_hypotheses_, [&](const FittedHypothesis& other) {
      return bound_to(existing_, other).rows() != existing_.rows();
    });
  }

  /// The predicted readings of an effect and their derivatives with respect to its free parameters, weighted.
  struct Linear {
    const FittedHypothesis* hypothesis;
    Eigen::VectorXd predicted;
    Eigen::MatrixXd jacobian;
  };
  Linear linear(const model::Measurement& rows, const FittedHypothesis& hypothesis) const {
    const model::Measurement bound = bound_to(rows, hypothesis);
    const model::Linearisation all = model::linearise(hypothesis.machine, bound, parameters_of(hypothesis));
    const Eigen::VectorXd weights = fit::fit_weights(bound) / spread_;
    return {&hypothesis, weights.cwiseProduct(all.predicted),
            weights.asDiagonal() * Eigen::MatrixXd(all.jacobian)};
  }

  /// Rows [0, existing) count, the others are offers. A true and B refitted, B true and A refitted, then each
  /// of them true and another hypothesis refitted.
  Sides sides_of(const model::Measurement& rows, std::size_t existing) const {
    const std::vector<Eigen::Index> first = first_observations(rows);
    Sides sides;
    const auto add = [&](const Linear& truth, const Linear& hypothesis) {
      sides.side.emplace_back(hypothesis.jacobian, truth.predicted - hypothesis.predicted, first, existing);
      // A truth with more unknowns pays for them in a diagnosis.
      const double more = static_cast<double>(truth.hypothesis->candidate.unknowns.size()) -
                          static_cast<double>(hypothesis.hypothesis->candidate.unknowns.size());
      const double price = std::log(static_cast<double>(first[existing_.rows()]));
      sides.needed.push_back(needed_non_centrality(options_.confidence, kLead + std::max(0.0, more) * price));
    };
    const Linear a = linear(rows, plan_.a), b = linear(rows, plan_.b);
    add(a, b);
    add(b, a);
    for (const FittedHypothesis& other : other_hypotheses_) {
      const Linear c = linear(rows, other);
      add(a, c);
      add(b, c);
    }
    return sides;
  }

  void note(const Sides& sides, double Separation::*what) {
    plan_.a_true.*what = sides.side[0].non_centrality();
    plan_.b_true.*what = sides.side[1].non_centrality();
  }

  void choose(const Offers& offers) {
    const std::size_t most = options_.points.value_or(std::max(kLeastPoints, options_.most_points));
    const std::vector<FittedHypothesis> others = std::move(other_hypotheses_);
    other_hypotheses_.clear();
    choose_at_most(offers, most);
    if (!plan_.separable || others.empty()) return;
    other_hypotheses_ = others;
    // An alternative that no moderate number of rows excludes must not use up the rows that can distinguish
    // the others.
    const std::size_t moderate =
        options_.points.value_or(std::min(most, std::max(kModerate, 3 * plan_.rows.rows())));
    choose_at_most(offers, moderate);
    while (drop_unreached()) choose_at_most(offers, other_hypotheses_.empty() ? most : moderate);
  }

  /// Removes the other hypotheses that the plan does not exclude. False: none of them.
  bool drop_unreached() {
    const Sides real = sides_of(append_rows(existing_, plan_.rows), existing_.rows() + plan_.rows.rows());
    std::vector<FittedHypothesis> kept;
    for (std::size_t i = 0; i < other_hypotheses_.size(); ++i) {
      bool reached = true;
      for (const std::size_t side : {kPair + 2 * i, kPair + 2 * i + 1})
        reached = reached && real.side[side].non_centrality() >= real.needed[side];
      if (reached)
        kept.push_back(other_hypotheses_[i]);
      else
        plan_.not_ruled_out.push_back(other_hypotheses_[i].candidate.spoken);
    }
    const bool any = kept.size() < other_hypotheses_.size();
    other_hypotheses_ = std::move(kept);
    return any;
  }

  void choose_at_most(const Offers& offers, std::size_t most) {
    Sides sides = sides_of(offers.rows, offers.existing);
    std::size_t least = options_.points.value_or(kLeastPoints), room = most;
    std::vector<std::size_t> chosen;
    double goal = 1;
    constexpr int kRounds = 4;  // of selection; each one compensates the loss by the real order
    for (int round = 0; round < kRounds; ++round) {
      choose_rows(sides, chosen, least, room, goal);
      exchange_rows(sides, chosen);
      carry_out(offers, chosen, 0);
      if (beyond_step_ < 1 && !away_from_usual(offers, chosen).empty() && most > kLeastReturn) {
        // Of the points, three of five at most are measured before and after the others.
        constexpr std::size_t kOfPoints = 5, kChosen = 2;
        room = std::max<std::size_t>(1, most * kChosen / kOfPoints);
        least = std::min(least, room);
        if (chosen.size() > room) {
          chosen.clear();
          choose_rows(sides, chosen, least, room, goal);
          exchange_rows(sides, chosen);
        }
        go_back(offers, chosen, most);
      }
      // In their real order, at their real times, the rows may carry less information than one by one.
      const Sides real = sides_of(append_rows(existing_, plan_.rows), existing_.rows() + plan_.rows.rows());
      note(real, &Separation::planned);
      plan_.separable = real.reached(kPair) >= 1;
      const double reached = std::min(real.reached(), beyond_step_);
      if (reached >= 1 || chosen.size() >= room) break;
      goal = std::max(goal, sides.reached()) / std::max(reached, 0.2);
    }
  }

  /// Adds rows at the usual values of the inputs before and after the chosen rows, as many as make one step
  /// of the machine distinguishable from the effect of an input.
  void go_back(const Offers& offers, const std::vector<std::size_t>& chosen, std::size_t most) {
    const std::size_t away = away_from_usual(offers, chosen).size(), room = most - chosen.size();
    if (options_.points) return carry_out(offers, chosen, room);
    // Twice as many after as before: the rows measured so far are before as well.
    constexpr std::size_t kOfAway = 3;
    for (std::size_t count = kLeastReturn; count <= std::min(room, std::max(kLeastReturn, kOfAway * away));
         ++count) {
      carry_out(offers, chosen, count);
      if (beyond_step_ >= 1) return;
    }
  }

  /// Is an effect that the plan distinguishes driven by an input that the user can set?
  bool follows_settable_input() const {
    return follows_settable_input(plan_.a) || follows_settable_input(plan_.b);
  }
  bool follows_settable_input(const FittedHypothesis& hypothesis) const {
    const std::vector<std::string>& inputs = hypothesis.candidate.choice.inputs;
    return std::any_of(inputs.begin(), inputs.end(), [&](const std::string& name) {
      return std::find(plan_.not_settable.begin(), plan_.not_settable.end(), name) ==
             plan_.not_settable.end();
    });
  }

  /// beyond_one_step() of the worse effect, for the measured rows and these.
  double beyond_one_step_with(const model::Measurement& planned) const {
    const model::Measurement rows = append_rows(existing_, planned);
    const std::vector<Eigen::Index> first = first_observations(rows);
    const double price = std::log(static_cast<double>(first[existing_.rows()]));
    double worst = 1e300;
    for (const FittedHypothesis* hypothesis : {&plan_.a, &plan_.b}) {
      if (!follows_settable_input(*hypothesis)) continue;
      const model::Measurement bound = bound_to(rows, *hypothesis);
      model::Measurement constant = bound;
      for (std::size_t i = 0; i < constant.states.input.size(); ++i)
        constant.states.input[i].setConstant(hypothesis->machine.inputs[i].reference + 1);
      constant.states.time.setConstant(bound.states.time.maxCoeff());
      const model::Machine bare = without_effect(*hypothesis);
      const Eigen::VectorXd weights = fit::fit_weights(bound) / spread_;
      PredictedEffect effect;
      const auto size_in = [&](const model::Measurement& m) -> Eigen::VectorXd {
        return weights.cwiseProduct(model::predict(hypothesis->machine, m) - model::predict(bare, m));
      };
      effect.readings = size_in(bound);
      effect.constant = size_in(constant);
      effect.free = linear(rows, *hypothesis).jacobian(Eigen::all, others_than(*hypothesis));
      for (std::size_t row = 1; row < rows.rows(); ++row)
        if (rows.states.run[row] != rows.states.run[row - 1] ||
            (row >= existing_.rows() && settings(rows, row) != settings(rows, row - 1)))
          effect.places.push_back(first[row]);
      worst = std::min(worst, beyond_one_step(effect, options_.confidence, kLead, price));
    }
    return worst;
  }

  /// The free parameters that are none of the effect.
  std::vector<Eigen::Index> others_than(const FittedHypothesis& hypothesis) const {
    const std::vector<effects::CandidateUnknown>& own = hypothesis.candidate.unknowns;
    std::vector<Eigen::Index> others;
    Eigen::Index at = 0;
    for (const model::Parameter& parameter : parameters_of(hypothesis)) {
      if (std::none_of(own.begin(), own.end(), [&](const auto& one) { return one.name == parameter.name; }))
        others.push_back(at);
      ++at;
    }
    return others;
  }

  /// The values of all inputs in a row.
  static std::vector<double> settings(const model::Measurement& rows, std::size_t row) {
    const auto at = static_cast<Eigen::Index>(row);
    std::vector<double> values;
    for (const model::Column& column : rows.states.input) values.push_back(column[at]);
    for (const model::CandidateInput& candidate : rows.candidates) values.push_back(candidate.value[at]);
    return values;
  }

  /// Sets the inputs of a row that drive the effects to their usual values so far.
  void set_usual(model::Measurement& rows, std::size_t row) const {
    const auto at = static_cast<Eigen::Index>(row);
    const auto usual = [](const model::Column& column) {
      return maths::median(std::vector<double>{column.begin(), column.end()});
    };
    for (std::size_t i = 0; i < rows.states.input.size(); ++i)
      if (drivers_.inputs.contains(model_.machine.inputs[i].name))
        rows.states.input[i][at] = usual(existing_.states.input[i]);
    for (std::size_t i = 0; i < rows.candidates.size(); ++i)
      if (drivers_.inputs.contains(rows.candidates[i].name))
        rows.candidates[i].value[at] = usual(existing_.candidates[i].value);
  }

  /// The chosen rows with other values of the inputs than the usual ones.
  std::vector<std::size_t> away_from_usual(const Offers& offers,
                                           const std::vector<std::size_t>& chosen) const {
    std::vector<std::size_t> away;
    for (const std::size_t offer : chosen) {
      model::Measurement row = model::select_rows(offers.rows, {offers.existing + offer});
      const std::vector<double> set = settings(row, 0);
      set_usual(row, 0);
      if (settings(row, 0) != set) away.push_back(offer);
    }
    return away;
  }

  /// The inputs that drive the effects, with their values in a row: "T_bed 26 degC".
  std::string in_words(const model::Measurement& rows, std::size_t row) const {
    const auto at = static_cast<Eigen::Index>(row);
    std::string text;
    const auto add = [&](const std::string& name, const std::string& unit, double value) {
      if (drivers_.inputs.contains(name))
        text += fmt::format("{}{} {:.4g}{}{}", text.empty() ? "" : ", ", name, value, unit.empty() ? "" : " ",
                            unit);
    };
    for (std::size_t i = 0; i < rows.states.input.size(); ++i)
      add(model_.machine.inputs[i].name, model_.machine.inputs[i].unit, rows.states.input[i][at]);
    for (const model::CandidateInput& one : rows.candidates) add(one.name, one.unit, one.value[at]);
    return text;
  }

  /// Sets the planned rows: the chosen ones grouped by time, then by inputs (a temperature is set once), then
  /// by speed and place; one run. `back`: number of rows before and after them at the usual values of the
  /// inputs, at the places of chosen rows.
  void carry_out(const Offers& offers, const std::vector<std::size_t>& chosen, std::size_t back) {
    std::vector<std::size_t> order;
    for (const std::size_t offer : chosen) order.push_back(offers.existing + offer);
    const model::Measurement& all = offers.rows;
    const auto key = [&](std::size_t row) {
      const auto at = static_cast<Eigen::Index>(row);
      std::vector<double> rest = {all.states.feed[at]};
      for (const model::Column& q : all.states.axis) rest.push_back(q[at]);
      return std::tuple(all.states.time[at], settings(all, row), rest);
    };
    std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return key(x) < key(y); });
    const std::size_t before = back / kLeastReturn, last = before + order.size();
    const double begin = order.empty() ? 0 : all.states.time[static_cast<Eigen::Index>(order.front())];
    const std::vector<std::size_t> away =
        back > 0 ? away_from_usual(offers, chosen) : std::vector<std::size_t>{};
    for (std::size_t i = 0; i < back; ++i) {
      const std::size_t row = offers.existing + away[i % away.size()];
      order.insert(i < before ? order.begin() + static_cast<std::ptrdiff_t>(i) : order.end(), row);
    }
    model::Measurement rows = model::select_rows(all, order);
    model::make_one_run(rows.states, kPlanRun);
    for (std::size_t i = 0; i < rows.rows() && back > 0; ++i) {
      if (i < before) rows.states.time[static_cast<Eigen::Index>(i)] = begin;
      if (i < before || i >= last) set_usual(rows, i);
    }
    double time = -1e300;
    for (std::size_t i = 0; i < rows.rows(); ++i) {
      const bool other = i > 0 && settings(rows, i) != settings(rows, i - 1);
      const auto at = static_cast<Eigen::Index>(i);
      time = std::max(rows.states.time[at], i == 0 ? -1e300 : time + (other ? kSoakS : pace()));
      rows.states.time[at] = time;
      rows.states.visit[at] = static_cast<double>(i);
    }
    plan_.rows = std::move(rows);
    plan_.back_to = back > 0 ? in_words(plan_.rows, 0) : "";
    beyond_step_ = beyond_one_step_with(plan_.rows);
  }

  /// Time from one row to the next as it was recorded.
  double pace() const {
    const model::Column& t = existing_.states.time;
    return (t.maxCoeff() - t.minCoeff()) / std::max(1.0, static_cast<double>(existing_.rows()) - 1);
  }

  const PlanOptions& options_;
  effects::MachineText model_;
  Plan plan_;
  Drivers drivers_;
  model::Measurement existing_;
  std::vector<FittedHypothesis> other_hypotheses_;
  double spread_ = 1;
  double beyond_step_ = 1e300;  // beyond_one_step_with() the planned rows
};

}  // namespace

const Separation& Plan::worse() const {
  const auto reached = [](const Separation& s) {
    return std::max(s.planned, s.now) / std::max(s.needed, 1e-300);
  };
  return reached(a_true) < reached(b_true) ? a_true : b_true;
}

Plan plan_next(const std::string& text, const model::Machine& machine, const model::Measurement& measurement,
               const std::string& a, const std::string& b, const std::vector<effects::Effect>& effects,
               const PlanOptions& options) {
  return Planner(text, machine, measurement, a, b, effects, options).plan();
}

std::vector<std::string> next_measurement(const std::string& text, const model::Machine& machine,
                                          const model::Measurement& measurement, const std::string& a,
                                          const std::string& b, const std::vector<effects::Effect>& effects,
                                          const PlanOptions& options) {
  const Plan plan = plan_next(text, machine, measurement, a, b, effects, options);
  std::vector<std::string> list = {plan.sentence};
  if (plan.separable)
    list.push_back(fmt::format(
        "To write the planned rows: vernier plan MACHINE MEAS --separate '{}' --separate '{}' -o plan.csv",
        plan.a.add, plan.b.add));
  return list;
}

}  // namespace vernier::plan
