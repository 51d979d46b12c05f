// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/check_plan.h"

#include <algorithm>
#include <cmath>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/maths/median.h"
#include "tools/model/measurement.h"
#include "tools/plan/offered_poses.h"

namespace vernier::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kCheckOffered = 400;  // poses from which a short check is selected
/// Standard deviations above which a change is visible.
constexpr double kShown = 5;

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
    all_ = check::suspect_columns(machine, rows);
    spread_ = check::spread_of_fit(machine, all_.suspects, all_.parameters);
    // Columns are in units of the readings' uncertainty. Here they are converted back to um of the
    // tool point.
    const double per_pose = options.reading_um / std::sqrt(static_cast<double>(kCheckOffered));
    moves_um_ = per_pose * all_.columns.colwise().norm();
    for (std::size_t j = 0; j < all_.suspects.size(); ++j)
      if (!all_.suspects[j].of_instrument && moves_um_[static_cast<Index>(j)] > 0)
        looked_.push_back(static_cast<Index>(j));
  }

  CheckPlan plan() {
    const std::vector<std::size_t> chosen = choose();
    CheckPlan plan;
    const std::vector<std::size_t> way = nearest_way(machine_, offered_, chosen);
    plan.states = model::select_states(offered_, way);
    const VectorXd amounts = amounts_of(told_by(chosen));
    for (const Index j : looked_) {
      const check::Suspect& suspect = all_.suspects[static_cast<std::size_t>(j)];
      if (!seen(amounts, j)) {
        plan.not_seen.push_back(suspect.name);
        continue;
      }
      const double change = kShown / std::sqrt(amounts[j]);
      plan.shows.push_back({suspect, change, change * moves_um_[j]});
    }
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

  /// A change that needs a motion of the tool of a metre or more to be visible counts as
  /// invisible.
  bool seen(const VectorXd& amounts, Index j) const {
    constexpr double kMost_um = 1e6;  // a larger change means another machine
    return amounts[j] > 0 && kShown / std::sqrt(amounts[j]) * moves_um_[j] < kMost_um;
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
    const VectorXd amounts = amounts_of(told_by(poses));
    double worst = 0;
    for (const Index j : looked_)
      if (seen(amounts, j)) worst = std::max(worst, kShown / std::sqrt(amounts[j]) * moves_um_[j]);
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
  check::SuspectColumns all_;
  MatrixXd spread_;
  VectorXd moves_um_;          // of the tool point by a change of 1, rms over the poses
  std::vector<Index> looked_;  // tested parameters of the machine
};

}  // namespace

CheckPlan check_plan(const model::Machine& machine, const CheckPlanOptions& options) {
  return CheckPlanner(machine, options).plan();
}

std::string check_plan_csv(const model::Machine& machine, const CheckPlan& plan, double reading_um) {
  return "# Approach every pose in the direction of dir; fill in x, y, z as they are read; then: vernier "
         "check.\n" +
         pose_rows_csv(machine, plan.states, std::vector<char>(plan.states.count, 0), reading_um, "check");
}

}  // namespace vernier::plan
