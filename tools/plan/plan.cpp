// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
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
    const std::size_t least = options_.points.value_or(kLeastPoints);
    std::vector<std::size_t> chosen;
    double goal = 1;
    constexpr int kRounds = 4;  // of selection; each one compensates the loss by the real order
    for (int round = 0; round < kRounds; ++round) {
      choose_rows(sides, chosen, least, most, goal);
      exchange_rows(sides, chosen);
      // In their real order, at their real times, the rows may carry less information than one by one.
      plan_.rows = carried_out(offers, chosen);
      const Sides real = sides_of(append_rows(existing_, plan_.rows), existing_.rows() + plan_.rows.rows());
      note(real, &Separation::planned);
      plan_.separable = real.reached(kPair) >= 1;
      if (real.reached() >= 1 || chosen.size() >= most) break;
      goal = std::max(goal, sides.reached()) / std::max(real.reached(), 0.2);
    }
  }

  /// Grouped by time, then by inputs (a temperature is set once), then by speed and place; one run.
  model::Measurement carried_out(const Offers& offers, const std::vector<std::size_t>& chosen) const {
    std::vector<std::size_t> order;
    for (const std::size_t offer : chosen) order.push_back(offers.existing + offer);
    const model::Measurement& all = offers.rows;
    const auto settings = [&](std::size_t row) {
      const auto at = static_cast<Eigen::Index>(row);
      std::vector<double> values;
      for (const model::Column& column : all.states.input) values.push_back(column[at]);
      for (const model::CandidateInput& candidate : all.candidates) values.push_back(candidate.value[at]);
      return values;
    };
    const auto key = [&](std::size_t row) {
      const auto at = static_cast<Eigen::Index>(row);
      std::vector<double> rest = {all.states.feed[at]};
      for (const model::Column& q : all.states.axis) rest.push_back(q[at]);
      return std::tuple(all.states.time[at], settings(row), rest);
    };
    std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return key(x) < key(y); });
    model::Measurement rows = model::select_rows(all, order);
    model::make_one_run(rows.states, kPlanRun);
    double time = -1e300;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool other = i > 0 && settings(order[i]) != settings(order[i - 1]);
      const auto at = static_cast<Eigen::Index>(i);
      time = std::max(rows.states.time[at], i == 0 ? -1e300 : time + (other ? kSoakS : pace()));
      rows.states.time[at] = time;
      rows.states.visit[at] = static_cast<double>(i);
    }
    return rows;
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
