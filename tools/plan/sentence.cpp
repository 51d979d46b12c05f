// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/sentence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/format/columns.h"
#include "tools/maths/median.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/rebind.h"
#include "tools/plan/offers.h"

namespace vernier::plan {
namespace {

/// A larger ratio means only that the effect appears.
constexpr double kMostRatio = 20;

double median(const model::Column& column) { return maths::median({column.begin(), column.end()}); }

std::string behaves(double r) {
  if (std::abs(r) >= kMostRatio) return "appears";
  if (std::abs(r - 1) < 0.1) return "stays";
  if (std::abs(r) < 0.1) return "vanishes";
  if (std::abs(r + 1) < 0.1) return "changes sign";
  if (std::abs(r - 2) < 0.1) return "doubles";
  if (std::abs(r - 0.5) < 0.05) return "halves";
  return fmt::format("becomes {:.2g} times as large{}", std::abs(r), r < 0 ? " with the other sign" : "");
}

/// "15 and 35", "15, 20 and 35", "15 to 35".
std::string listed(const model::Column& column) {
  std::set<std::string> seen;
  std::vector<double> sorted(column.begin(), column.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::string> words;
  for (const double value : sorted)
    if (seen.insert(fmt::format("{:.4g}", value)).second) words.push_back(fmt::format("{:.4g}", value));
  constexpr std::size_t kListed = 3;  // values that a sentence lists
  if (words.size() == 1) return words[0];
  if (words.size() > kListed) return words.front() + " to " + words.back();
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} and {}", fmt::join(words, ", "), last);
}

std::string so_far(const model::Column& old) {
  const double low = old.minCoeff(), high = old.maxCoeff();
  if (high - low <= 1e-3 * std::max(std::abs(low), std::abs(high))) return fmt::format("so far {:.4g}", low);
  return fmt::format("so far {:.4g} to {:.4g}", low, high);
}

std::string with_unit(const std::string& unit) { return unit.empty() ? std::string() : " " + unit; }

/// Length of each row's velocity, mm/s or deg/s.
model::Column speed_of(const model::States& states) {
  model::Column square = model::Column::Zero(static_cast<Eigen::Index>(states.count));
  for (const model::Column& v : states.velocity) square += v * v;
  return square.sqrt();
}

model::Column moving_only(const model::Column& speed) {
  std::vector<double> values;
  for (const double v : speed)
    if (v > 0) values.push_back(v);
  return Eigen::Map<const model::Column>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

Explanation::Explanation(const Plan& plan, const model::Measurement& existing)
    : plan_(plan), existing_(existing) {}

Explanation::Contrast Explanation::speed() const {
  Contrast c;
  const model::Column planned = speed_of(plan_.rows.states), old = moving_only(speed_of(existing_.states));
  if (old.size() == 0) return c;
  const double usual = median(old);
  std::vector<std::size_t> which;
  double farthest = usual;
  for (const double v : planned)
    if (v > 0 && std::abs(std::log(v / usual)) > std::abs(std::log(farthest / usual)) + 1e-9) farthest = v;
  if (std::abs(farthest / usual - 1) < 0.2) return c;
  for (std::size_t row = 0; row < plan_.rows.rows(); ++row)
    if (std::abs(planned[static_cast<Eigen::Index>(row)] / farthest - 1) < 1e-6) which.push_back(row);
  c.planned = c.as_was = model::select_rows(plan_.rows, which);
  const double back = usual / farthest;
  for (model::Column& v : c.as_was.states.velocity) v *= back;
  for (model::Column& a : c.as_was.states.acceleration) a *= back * back;
  c.as_was.states.feed *= back;
  c.where = fmt::format("at speeds of {} mm/s or deg/s ({})", listed(moving_only(planned)), so_far(old));
  c.farthest = fmt::format("{:.4g} mm/s or deg/s", farthest);
  const model::Column feed = moving_only(plan_.rows.states.feed);
  if (feed.size() == moving_only(planned).size() && existing_.has_recorded(format::columns::kFeed)) {
    c.where = fmt::format("at F{} mm/min ({})", listed(feed), so_far(moving_only(existing_.states.feed)));
    c.farthest = fmt::format("F{:.4g}", c.planned.states.feed[0]);
  }
  c.usable = true;
  return c;
}

Explanation::Contrast Explanation::sense(std::size_t axis) const {
  Contrast c;
  const model::Column& old = existing_.states.direction[axis];
  constexpr double kOneSided = 0.9;  // mean direction above which rows count as taken in one direction
  const double usual = old.mean();
  if (std::abs(usual) < kOneSided) return c;
  std::vector<std::size_t> which;
  for (std::size_t row = 0; row < plan_.rows.rows(); ++row)
    if (plan_.rows.states.direction[axis][static_cast<Eigen::Index>(row)] * usual < 0) which.push_back(row);
  if (which.empty()) return c;
  c.planned = c.as_was = model::select_rows(plan_.rows, which);
  c.as_was.states.direction[axis] *= -1;
  c.as_was.states.velocity[axis] *= -1;
  const std::string& name = plan_.machine.axes[axis].name;
  c.where = fmt::format("with {} approached from both sides (until now from one side only)", name);
  c.farthest = "the new approach direction";
  c.usable = true;
  return c;
}

Explanation::Contrast Explanation::level(const std::string& name, const std::string& unit,
                                         const model::Column& planned, const model::Column& old,
                                         const std::function<void(model::Measurement&, double)>& set) const {
  Contrast c;
  const double usual = median(old), range = std::max(old.maxCoeff() - old.minCoeff(), 1e-9);
  Eigen::Index at = 0;
  const double away = (planned - usual).abs().maxCoeff(&at);
  constexpr double kOtherLevel = 0.2;  // of the range: nearer is the same level
  if (away < kOtherLevel * range) return c;
  std::vector<std::size_t> which;
  for (std::size_t row = 0; row < plan_.rows.rows(); ++row)
    if (std::abs(planned[static_cast<Eigen::Index>(row)] - planned[at]) < 0.05 * away) which.push_back(row);
  c.planned = c.as_was = model::select_rows(plan_.rows, which);
  set(c.as_was, usual);
  c.where = fmt::format("at {} {}{} ({})", name, listed(planned), with_unit(unit), so_far(old));
  c.farthest = fmt::format("{} {:.4g}{}", name, planned[at], with_unit(unit));
  c.usable = true;
  return c;
}

std::vector<Explanation::Contrast> Explanation::contrasts() const {
  std::vector<Contrast> list = {speed()};
  const model::Measurement& next = plan_.rows;
  const model::Machine& machine = plan_.machine;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) list.push_back(sense(a));
  for (std::size_t i = 0; i < machine.inputs.size(); ++i)
    list.push_back(level(machine.inputs[i].name, machine.inputs[i].unit, next.states.input[i],
                         existing_.states.input[i],
                         [i](model::Measurement& m, double value) { m.states.input[i].setConstant(value); }));
  for (std::size_t i = 0; i < next.candidates.size(); ++i) {
    const model::Column& old = existing_.candidates[i].value;
    if (!old.isFinite().all()) continue;
    list.push_back(
        level(next.candidates[i].name, next.candidates[i].unit, next.candidates[i].value, old,
              [i](model::Measurement& m, double value) { m.candidates[i].value.setConstant(value); }));
  }
  list.push_back(level("t", "s", next.states.time, existing_.states.time,
                       [](model::Measurement& m, double value) { m.states.time.setConstant(value); }));
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    list.push_back(level(machine.axes[a].name, machine.axes[a].rotary ? "deg" : "mm", next.states.axis[a],
                         model::commanded(existing_, a),
                         [a](model::Measurement& m, double value) { m.states.axis[a].setConstant(value); }));
  return list;
}

double Explanation::ratio(const FittedHypothesis& hypothesis, const Contrast& contrast) const {
  const model::Machine bare = without_effect(hypothesis);
  const auto shift = [&](const model::Measurement& rows) -> Eigen::VectorXd {
    const model::Measurement bound = model::rebind(rows, plan_.machine, hypothesis.machine);
    return model::predict(hypothesis.machine, bound) - model::predict(bare, bound);
  };
  const Eigen::VectorXd now = shift(contrast.planned), was = shift(contrast.as_was);
  if (now.norm() == 0 && was.norm() == 0) return 1;
  const double direct = now.dot(was) / std::max(was.squaredNorm(), 1e-300);
  if (was.norm() < now.norm() / kMostRatio) return kMostRatio;
  return std::clamp(direct, -kMostRatio, kMostRatio);
}

Explanation::Answer Explanation::answer(const Contrast& contrast) const {
  return {ratio(plan_.a, contrast), ratio(plan_.b, contrast)};
}

std::string Explanation::sentence() const {
  const std::string &a = plan_.a.candidate.spoken, &b = plan_.b.candidate.spoken;
  const Separation& worse = plan_.worse();
  std::string beyond;
  for (const std::string& name : plan_.not_settable)
    beyond += fmt::format(" The column {} is logged, but a plan cannot set its value.", name);
  if (plan_.told_already && plan_.rows.rows() == 0) {
    const std::string &better = plan_.lead_of_a > 0 ? a : b, &other = plan_.lead_of_a > 0 ? b : a;
    const double lead = std::abs(plan_.lead_of_a);
    if (lead < kLead)
      return fmt::format(
          "The rows measured so far could distinguish the two effects (non-centrality {:.3g}, required "
          "{:.3g}), but {} explains these rows better than {} by only {:.3g}. Measure the same rows again: "
          "if the difference does not grow, neither effect is the whole cause.",
          worse.now, worse.needed, better, other, lead);
    return fmt::format(
        "The rows measured so far already distinguish the two effects: {} explains the rows better than {} "
        "by {:.3g} (non-centrality {:.3g}, required {:.3g}).",
        better, other, lead, worse.now, worse.needed);
  }
  if (!plan_.separable)
    return fmt::format(
        "{} and {} cannot be separated by {} points of any admissible pose, approach direction, speed, time "
        "or input: these points reach a non-centrality of {:.3g}, but {:.3g} is required.{}",
        a, b, plan_.rows.rows(), worse.planned, worse.needed, beyond);
  double best = 0;
  std::string where = "in combinations that the existing rows do not contain", why;
  for (const Contrast& contrast : contrasts()) {
    if (!contrast.usable) continue;
    const Answer answers = answer(contrast);
    const double score = std::abs(answers.a - answers.b) / (1 + std::abs(answers.a) + std::abs(answers.b));
    constexpr double kWorthSaying =
        0.05;  // share of the prediction: a smaller one is not visible in a reading
    if (score < std::max(best + 1e-6, kWorthSaying)) continue;
    best = score;
    where = contrast.where;
    why =
        fmt::format(": at {}, {} {}, {} {}", contrast.farthest, a, behaves(answers.a), b, behaves(answers.b));
  }
  const std::string order =
      plan_.back_to.empty()
          ? ""
          : fmt::format(
                " Begin and end at {}: one change of the machine, such as a collision, does not "
                "disappear when the input is back at its first value.",
                plan_.back_to);
  return fmt::format("Measure {} points {}{}.{}{}", plan_.rows.rows(), where, why, order, beyond);
}

}  // namespace vernier::plan
