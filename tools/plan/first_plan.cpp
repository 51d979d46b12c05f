// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/first_plan.h"

#include <algorithm>
#include <cmath>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/maths/orthonormal.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/measurement.h"
#include "tools/plan/offered_poses.h"
#include "tools/text/error.h"

namespace vernier::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Poses that may be chosen, and poses that uncertainty is looked at.
constexpr std::size_t kOffered = 800, kJudged = 150;

/// In the measuring frame, as the columns are.
Eigen::Matrix3Xd points_of(const model::Machine& machine, const model::Measurement& rows) {
  const Eigen::VectorXd predicted = model::predict(machine, rows);
  return Eigen::Map<const Eigen::Matrix3Xd>(predicted.data(), 3, predicted.size() / 3);
}

/// How the parameters move the tool point over the volume, every tool of the file, but for a rigid motion.
MatrixXd weight_of(const model::Machine& machine, const PlannedParameters& planned) {
  std::vector<model::Machine> tooled = {machine};
  for (const model::Tool& tool : machine.tools) tooled.push_back(model::with_tool(machine, tool.point));
  const model::Measurement rows = fit::point_readings(offered_poses(machine, kJudged, 7919));
  const Index count = planned.scale.size();
  MatrixXd weight = MatrixXd::Zero(count, count);
  for (const model::Machine& one : tooled) {
    const MatrixXd all =
        MatrixXd(model::linearise(one, rows, planned.all).jacobian) * planned.scale.asDiagonal();
    MatrixXd own = MatrixXd::Zero(all.rows(), all.cols());
    own(Eigen::all, planned.own) = all(Eigen::all, planned.own);
    const MatrixXd basis = maths::orthonormal(fit::rigid_motions(points_of(one, rows)), 1e-9, nullptr);
    own -= basis * (basis.transpose() * own);
    weight += own.transpose() * own / static_cast<double>(kJudged * tooled.size());
  }
  return weight;
}

class FirstPlanner {
 public:
  FirstPlanner(const model::Machine& machine, const FirstPlanOptions& options)
      : machine_(machine), options_(options), planned_(planned_parameters(machine, options.expected_um)) {}

  /// Of any poses.
  double uncertainty_um(const model::States& poses) const {
    const model::Measurement rows = fit::point_readings(poses);
    const MatrixXd columns =
        MatrixXd(model::linearise(machine_, rows, planned_.all).jacobian) * planned_.scale.asDiagonal();
    const MatrixXd information =
        MatrixXd::Identity(columns.cols(), columns.cols()) + columns.transpose() * columns / variance();
    return expanded_um(
        maths::solve_positive(information, MatrixXd::Identity(columns.cols(), columns.cols())));
  }

  FirstPlan plan() {
    FirstPlan plan;
    covariance_ = MatrixXd::Identity(planned_.jacobian.cols(), planned_.jacobian.cols());
    plan.before_um = expanded_um(covariance_);
    plan.least_um = expanded_um(after_all());
    const std::vector<std::size_t> chosen = choose(plan);
    plan.after_um = expanded_um(covariance_);
    plan.random_um = expanded_um(after_random(chosen.size()));
    plan.reached = !options_.accuracy_um || plan.after_um <= *options_.accuracy_um;
    order(chosen, plan);
    return plan;
  }

 private:
  double expanded_um(const MatrixXd& covariance) const { return planned_.expanded_um(covariance); }

  double variance() const { return std::pow(1e-3 * options_.reading_um, 2); }
  auto row(std::size_t pose) const { return planned_.jacobian.middleRows(3 * static_cast<Index>(pose), 3); }

  static void update(MatrixXd& covariance, const MatrixXd& row, double variance) {
    const MatrixXd gain = covariance * row.transpose();
    const Eigen::Matrix3d inner = row * gain + variance * Eigen::Matrix3d::Identity();
    covariance -= gain * inner.llt().solve(gain.transpose());
  }

  MatrixXd after_all() const {
    const MatrixXd information = MatrixXd::Identity(planned_.jacobian.cols(), planned_.jacobian.cols()) +
                                 planned_.jacobian.transpose() * planned_.jacobian / variance();
    return maths::solve_positive(information,
                                 MatrixXd::Identity(planned_.jacobian.cols(), planned_.jacobian.cols()));
  }

  MatrixXd after_random(std::size_t count) const {
    MatrixXd covariance = MatrixXd::Identity(planned_.jacobian.cols(), planned_.jacobian.cols());
    for (std::size_t i = 0; i < count; ++i) update(covariance, row((i * 383 + 11) % kOffered), variance());
    return covariance;
  }

  std::vector<std::size_t> choose(const FirstPlan& plan) {
    std::vector<std::size_t> chosen;
    double now = plan.before_um;
    const double enough = options_.accuracy_um.value_or(2 * options_.reading_um);
    std::vector<char> taken(kOffered, 0);
    while (chosen.size() < std::min(options_.most, kOffered) && now > enough) {
      const MatrixXd in_volume = covariance_ * planned_.weight * covariance_;
      double most = -1;
      std::size_t best = 0;
      for (std::size_t i = 0; i < kOffered; ++i) {
        if (taken[i] != 0) continue;
        const MatrixXd one = row(i);
        const Eigen::Matrix3d inner =
            one * covariance_ * one.transpose() + variance() * Eigen::Matrix3d::Identity();
        const double fall = inner.llt().solve(one * in_volume * one.transpose()).trace();
        if (fall > most) {
          most = fall;
          best = i;
        }
      }
      chosen.push_back(best);
      taken[best] = 1;
      update(covariance_, row(best), variance());
      now = expanded_um(covariance_);
    }
    return chosen;
  }

  /// A way through the poses, always to the nearest that is left; check poses and the first one in between.
  void order(const std::vector<std::size_t>& chosen, FirstPlan& plan) const {
    const std::vector<std::size_t> way = nearest_way(machine_, planned_.offered, chosen);
    const auto checks =
        static_cast<std::size_t>(std::ceil(options_.check_share * static_cast<double>(way.size())));
    const model::States extra = offered_poses(machine_, std::max<std::size_t>(1, checks), 104729);
    // Poses from one visit of the reference to the next: a drift is followed by them.
    constexpr std::size_t kReferenceEvery = 25;
    std::vector<std::pair<const model::States*, std::size_t>> rows;
    const auto take = [&](const model::States& from, std::size_t at, bool check) {
      rows.emplace_back(&from, at);
      plan.check.push_back(check ? 1 : 0);
    };
    std::size_t next_check = 0;
    for (std::size_t i = 0; i < way.size(); ++i) {
      if (i > 0 && i % kReferenceEvery == 0) {
        take(planned_.offered, way.front(), false);
        ++plan.references;
      }
      take(planned_.offered, way[i], false);
      if ((i + 1) * checks / way.size() > next_check) take(extra, next_check++, true);
    }
    if (way.size() > 1) {
      take(planned_.offered, way.front(), false);
      ++plan.references;
    }
    plan.states = model::select_states(planned_.offered, std::vector<std::size_t>(rows.size(), 0));
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (auto list : {&model::States::axis, &model::States::direction})
        for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
          (plan.states.*list)[axis][static_cast<Index>(i)] =
              (rows[i].first->*list)[axis][static_cast<Index>(rows[i].second)];
  }

  const model::Machine& machine_;
  const FirstPlanOptions& options_;
  PlannedParameters planned_;
  MatrixXd covariance_;  // of the parameters, after the chosen poses
};

}  // namespace

double PlannedParameters::expanded_um(const MatrixXd& covariance) const {
  return 2 * maths::kUmPerMm * std::sqrt(std::max(0.0, covariance.cwiseProduct(weight).sum()));
}

PlannedParameters planned_parameters(const model::Machine& machine, double expected_um) {
  PlannedParameters planned{model::ParameterSet(machine, {""}),  {}, {}, {},
                            offered_poses(machine, kOffered, 0), {}, {}};
  for (std::size_t i = 0; i < planned.all.size(); ++i)
    (model::is_set_up(planned.all[i].kind) ? planned.set_up : planned.own).push_back(static_cast<Index>(i));
  if (planned.own.empty())
    throw text::InputError({machine.file, 0}, machine.name,
                           "no reading can determine a free parameter of the machine file");
  planned.jacobian = model::linearise(machine, fit::point_readings(planned.offered), planned.all).jacobian;
  planned.scale = Eigen::VectorXd::Ones(planned.jacobian.cols());
  for (Index j = 0; j < planned.jacobian.cols(); ++j) {
    const double size = planned.jacobian.col(j).norm() / std::sqrt(static_cast<double>(kOffered));
    constexpr double kFree = 1e4;  // a set-up may be anything
    const bool shift = std::find(planned.set_up.begin(), planned.set_up.end(), j) != planned.set_up.end();
    if (size > 0) planned.scale[j] = (shift ? kFree : 1) * 1e-3 * expected_um / size;
  }
  planned.jacobian = planned.jacobian * planned.scale.asDiagonal();
  planned.weight = weight_of(machine, planned);
  return planned;
}

FirstPlan first_plan(const model::Machine& machine, const FirstPlanOptions& options) {
  return FirstPlanner(machine, options).plan();
}

double planned_uncertainty_um(const model::Machine& machine, const model::States& poses,
                              const FirstPlanOptions& options) {
  return FirstPlanner(machine, options).uncertainty_um(poses);
}

std::string first_plan_csv(const model::Machine& machine, const FirstPlan& plan, double reading_um) {
  return "# Approach every pose in the direction of dir. The first pose is repeated: a drift shows there.\n"
         "# Fill in x, y, z as they are read; rows with the role check only test the fit.\n" +
         pose_rows_csv(machine, plan.states, plan.check, reading_um, "first");
}

}  // namespace vernier::plan
