// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/check_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/maths/median.h"
#include "tools/model/measurement.h"
#include "tools/plan/offered_poses.h"
#include "tools/text/words.h"

namespace vernier::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kCheckOffered = 400;  // poses from which a short check is selected
/// Standard deviations above which a change is visible.
constexpr double kShown = 5;
/// Motion of the tool point by a change of 1, um, below which the motion is rounding: 5e-9 um is the last
/// digit of a position of 20 m.
constexpr double kRounding_um = 1e-8;
constexpr std::size_t kNamed = 12;  // entries of a printed list

/// Information of the chosen readings: sums over their rows.
struct Told {
  MatrixXd gram, with_set_up, set_up;
};

class CheckPlanner {
 public:
  CheckPlanner(const model::Machine& machine, const CheckPlanOptions& options)
      : machine_(machine), options_(options), offered_(offered_poses(machine, kCheckOffered, 0)) {
    model::Measurement rows = fit::point_readings(offered_);
    rows.uncertainty.setConstant(1e-3 * options.reading_um);
    all_ = check::quantity_columns(machine, rows);
    spread_ = check::spread_of_fit(machine, all_.quantities, all_.parameters);
    // Columns are in units of the readings' uncertainty. Here they are converted back to um of the
    // tool point.
    const double per_pose = options.reading_um / std::sqrt(static_cast<double>(kCheckOffered));
    moves_um_ = per_pose * all_.columns.colwise().norm();
    for (std::size_t j = 0; j < all_.quantities.size(); ++j) {
      if (all_.quantities[j].of_instrument) continue;
      const auto at = static_cast<Index>(j);
      (moves_um_[at] > kRounding_um ? looked_ : at_rest_).push_back(at);
    }
  }

  CheckPlan plan() {
    const std::vector<std::size_t> chosen = choose();
    CheckPlan plan;
    const std::vector<std::size_t> way = nearest_way(machine_, offered_, chosen);
    plan.states = model::select_states(offered_, way);
    const Told told = told_by(chosen);
    const VectorXd amounts = amounts_of(told);
    for (const Index j : looked_) {
      const check::CheckedQuantity& quantity = all_.quantities[static_cast<std::size_t>(j)];
      if (!seen(told, amounts, j)) {
        plan.not_seen.push_back(quantity.name);
        continue;
      }
      const double change = kShown / std::sqrt(amounts[j]);
      plan.shows.push_back({quantity, change, change * moves_um_[j]});
    }
    for (const Index j : at_rest_) plan.not_seen.push_back(all_.quantities[static_cast<std::size_t>(j)].name);
    std::stable_sort(plan.shows.begin(), plan.shows.end(),
                     [](const Shown& a, const Shown& b) { return a.tool_um > b.tool_um; });
    plan.random_um = random_um(chosen.size());
    return plan;
  }

 private:
  void add(Told& told, std::size_t pose) const {
    const auto x = all_.columns.middleRows(3 * static_cast<Index>(pose), 3);
    const auto s = all_.set_up.middleRows(3 * static_cast<Index>(pose), 3);
    told.gram += x.transpose() * x;
    told.with_set_up += s.transpose() * x;
    told.set_up += s.transpose() * s;
  }
  Told nothing() const {
    const Index k = all_.columns.cols(), s = all_.set_up.cols();
    return {MatrixXd::Zero(k, k), MatrixXd::Zero(s, k), MatrixXd::Zero(s, s)};
  }
  Told told_by(const std::vector<std::size_t>& poses) const {
    Told told = nothing();
    for (const std::size_t pose : poses) add(told, pose);
    return told;
  }

  /// Information on a change of each tested parameter by 1, after the set-up and the uncertainty
  /// of the fit are eliminated.
  VectorXd amounts_of(const Told& told) const {
    MatrixXd gram = told.gram;
    if (told.set_up.cols() > 0) {
      // A set-up that the chosen poses do not determine is free.
      constexpr double kFree = 1e-9;
      MatrixXd set_up = told.set_up;
      set_up.diagonal().array() += kFree * (1 + set_up.diagonal().maxCoeff());
      gram -= told.with_set_up.transpose() * maths::solve_symmetric(set_up, told.with_set_up);
    }
    const auto p = static_cast<Index>(all_.parameters);
    const MatrixXd left = spread_.transpose() * gram.topRows(p);  // factors x tested parameters
    const MatrixXd inner = MatrixXd::Identity(spread_.cols(), spread_.cols()) + left.leftCols(p) * spread_;
    VectorXd amounts = gram.diagonal();
    amounts -= left.cwiseProduct(maths::solve_positive(inner, left)).colwise().sum().transpose();
    return amounts;
  }

  double worth(const VectorXd& amounts) const {
    double sum = 0;
    for (const Index j : looked_) {
      const double change = options_.expected_um / moves_um_[j];
      sum += std::log1p(std::max(0.0, amounts[j]) * change * change);
    }
    return sum;
  }

  /// False if nearly all information on a change is lost to the set-up and the uncertainty of the fit: the
  /// change is the same as another set-up. A set-up counts as free down to 1e-9 of its information
  /// (amounts_of), which a parameter then keeps.
  bool seen(const Told& told, const VectorXd& amounts, Index j) const {
    constexpr double kKept = 1e-6;  // between 1e-9 and 1e-3, the least that a precise fit leaves
    return amounts[j] > kKept * told.gram(j, j);
  }

  std::vector<std::size_t> choose() const {
    std::vector<std::size_t> chosen;
    Told told = nothing();
    std::vector<char> taken(kCheckOffered, 0);
    while (chosen.size() < std::min(options_.points, kCheckOffered)) {
      double most = -1;
      std::size_t best = 0;
      for (std::size_t i = 0; i < kCheckOffered; ++i) {
        if (taken[i] != 0) continue;
        Told with = told;
        add(with, i);
        const double value = worth(amounts_of(with));
        if (value > most) most = value, best = i;
      }
      chosen.push_back(best);
      taken[best] = 1;
      add(told, best);
    }
    return chosen;
  }

  double worst_um(const std::vector<std::size_t>& poses) const {
    const Told told = told_by(poses);
    const VectorXd amounts = amounts_of(told);
    double worst = 0;
    for (const Index j : looked_)
      if (seen(told, amounts, j)) worst = std::max(worst, kShown / std::sqrt(amounts[j]) * moves_um_[j]);
    return worst;
  }

  double random_um(std::size_t count) const {
    constexpr std::size_t kDraws = 9;  // of other starts of the exchange
    std::vector<double> worst;
    for (std::size_t draw = 0; draw < kDraws; ++draw) {
      std::vector<std::size_t> poses;
      for (std::size_t i = 0; i < count; ++i) poses.push_back((i * 383 + draw * 71 + 11) % kCheckOffered);
      worst.push_back(worst_um(poses));
    }
    return maths::median(std::move(worst));
  }

  const model::Machine& machine_;
  const CheckPlanOptions& options_;
  model::States offered_;
  check::QuantityColumns all_;
  MatrixXd spread_;
  VectorXd moves_um_;           // of the tool point by a change of 1, rms over the poses
  std::vector<Index> looked_;   // tested parameters of the machine
  std::vector<Index> at_rest_;  // of these, such that do not move the tool point
};

}  // namespace

CheckPlan check_plan(const model::Machine& machine, const CheckPlanOptions& options) {
  return CheckPlanner(machine, options).plan();
}

std::string check_plan_text(const CheckPlan& plan, double reading_um) {
  std::string text =
      fmt::format("smallest change that {} poses with a standard uncertainty of {:g} um detect:\n",
                  plan.states.count, reading_um);
  const std::size_t named = std::min(plan.shows.size(), kNamed);
  for (std::size_t i = 0; i < named; ++i)
    text += fmt::format("  {:<36} {:>10.3g} {:<4} ({:.3g} um at the tool)\n", plan.shows[i].quantity.name,
                        plan.shows[i].change, plan.shows[i].quantity.unit, plan.shows[i].tool_um);
  if (plan.shows.size() > named)
    text += fmt::format("  and {} other parameters; the smallest of their changes is {:.3g} um at the tool\n",
                        plan.shows.size() - named, plan.shows.back().tool_um);
  if (!plan.not_seen.empty()) {
    std::vector<std::string> first = plan.not_seen;
    first.resize(std::min(first.size(), kNamed));
    text += fmt::format(
        "the check cannot detect a change of these parameters (no motion of the tool point, or the same "
        "motion as another set-up): {}",
        text::joined(first, ", "));
    if (first.size() < plan.not_seen.size())
      text += fmt::format(" and {} others", plan.not_seen.size() - first.size());
    text += '\n';
  }
  const double worst = plan.shows.empty() ? 0 : plan.shows.front().tool_um;
  return text + fmt::format("the same number of random poses gives {:.3g} um, these poses {:.3g} um\n",
                            plan.random_um, worst);
}

std::string check_plan_csv(const model::Machine& machine, const CheckPlan& plan, double reading_um) {
  return "# Approach every pose in the direction of dir; fill in x, y, z as they are read; then: vernier "
         "check.\n" +
         pose_rows_csv(machine, plan.states, std::vector<char>(plan.states.count, 0), reading_um, "check");
}

}  // namespace vernier::plan
