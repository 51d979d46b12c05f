// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/accuracy/accuracy_plan.h"

#include <algorithm>
#include <cmath>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/format/columns.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/maths/halton.h"
#include "tools/maths/median.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/plan/accuracy/accuracy_aim.h"
#include "tools/plan/offered_poses.h"
#include "tools/text/error.h"
#include "tools/tolerance/machine_sources.h"

namespace vernier::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Poses to choose from: over the volume, and where accuracy is wanted.
constexpr std::size_t kOverVolume = 500, kAtAim = 300;
/// Standard deviation of an unknown set-up, mm and rad: large enough to have no influence.
constexpr double kAnywhere = 10;
/// Readings with this much less noise show the part of the uncertainty that no number of readings reduces.
constexpr double kFarBetter = 1e-3;

/// Poses one after the other; both of the same machine.
model::States joined_states(const model::States& a, const model::States& b) {
  std::vector<std::size_t> rows(a.count + b.count, 0);
  for (std::size_t i = 0; i < a.count; ++i) rows[i] = i;
  model::States all = model::select_states(a, rows);
  for (const auto list : {&model::States::axis, &model::States::direction, &model::States::input})
    for (std::size_t k = 0; k < (all.*list).size(); ++k)
      (all.*list)[k].tail(static_cast<Index>(b.count)) = (b.*list)[k];
  return all;
}

/// The first `most` of poses, evenly picked.
model::States thinned(const model::States& states, std::size_t most) {
  if (states.count <= most) return states;
  std::vector<std::size_t> rows(most);
  for (std::size_t i = 0; i < most; ++i) rows[i] = i * states.count / most;
  return model::select_states(states, rows);
}

class AccuracyPlanner {
 public:
  AccuracyPlanner(const Knowledge& knowledge, const AccuracyAim& aim) : knowledge_(knowledge) {
    for (std::size_t i = 0; i < knowledge.parameters.size(); ++i)
      if (!model::is_set_up(knowledge.parameters[i].kind)) own_.push_back(static_cast<Index>(i));
    if (own_.empty())
      throw text::InputError({knowledge.machine.file, 0}, knowledge.machine.name,
                             "no reading can determine a free parameter of the machine file");
    aim_ = aim_rows(knowledge, aim, own_);
    size_ = static_cast<Index>(knowledge.parameters.size()) + 9;
    weight_ = MatrixXd::Zero(size_, size_);
    weight_(own_, own_) = aim_.rows.transpose() * aim_.rows;
    prior_ = MatrixXd::Zero(size_, size_);
    prior_.topLeftCorner(size_ - 9, size_ - 9) = knowledge.covariance;
    if (knowledge.new_set_up) prior_.diagonal().segment(size_ - 9, 6).setConstant(kAnywhere * kAnywhere);
    prior_.diagonal().tail(3).setConstant(knowledge.run_mm * knowledge.run_mm);
    const model::States over = offered_poses(knowledge.machine, kOverVolume, 0);
    const model::States at =
        aim.part ? thinned(with_senses(aim.part->states), kAtAim)
                 : offered_poses(with_region(knowledge.machine, aim.region), kAtAim, kOverVolume);
    offered_ = joined_states(over, at);
  }

  AccuracyPlan plan(const AccuracyOptions& options) {
    AccuracyPlan plan;
    jacobian_ = rows_at(offered_);
    covariance_ = prior_;
    plan.now_um = expanded_um(covariance_);
    const MatrixXd floor = after(jacobian_, kFarBetter);
    plan.floor_um = expanded_um(floor);
    plan.unseen = limits_of(floor);
    std::vector<std::size_t> chosen;
    plan.steps.push_back({0, 0, plan.now_um});
    double now = plan.now_um;
    while (chosen.size() < std::min(options.most, offered_.count) && now > options.accuracy_um) {
      chosen.push_back(best(chosen));
      update(chosen.back());
      now = expanded_um(covariance_);
      note(plan, options, chosen, now, false);
      if (options.progress)
        options.progress(static_cast<double>(chosen.size()) / static_cast<double>(options.most));
    }
    note(plan, options, chosen, now, true);
    plan.after_um = now;
    plan.reached = !(options.accuracy_um > 0) || now <= options.accuracy_um;
    plan.limits = limits_of(covariance_);
    plan.random_um = random_um(chosen.size());
    for (const AimRows::Piece& piece : aim_.pieces)
      plan.parts.push_back({piece.name, piece_um(piece, prior_), piece_um(piece, covariance_)});
    plan.states = model::select_states(offered_, nearest_way(knowledge_.machine, offered_, chosen));
    return plan;
  }

  double uncertainty_um(const model::States& poses) const { return expanded_um(after(rows_at(poses), 1)); }

 private:
  /// Every pose is come to from either side, and no speed is left of a part's cut.
  model::States with_senses(const model::States& states) const {
    model::States all = states;
    for (std::size_t a = 0; a < knowledge_.machine.axes.size(); ++a) {
      for (const auto list : {&model::States::velocity, &model::States::acceleration})
        (all.*list)[a].setZero();
      all.since[a].setConstant(model::kLongWay);
      for (Index i = 0; i < all.direction[a].size(); ++i)
        all.direction[a][i] =
            maths::radical_inverse(static_cast<std::size_t>(i) + 1, 2 + a % 2) < 0.5 ? -1 : 1;
    }
    all.feed.setZero();
    return all;
  }

  /// Sensitivity of each coordinate that is read there to parameters, set-up and run: three rows per pose.
  MatrixXd rows_at(const model::States& poses) const {
    MatrixXd rows = MatrixXd::Zero(3 * static_cast<Index>(poses.count), size_);
    const model::ParameterSet& parameters = knowledge_.parameters;
    model::Machine machine = knowledge_.machine;
    if (knowledge_.new_set_up) machine.base_shifts.clear();
    machine.tool_shifts.clear();
    const model::ParameterSet here(machine, {""});
    const model::Measurement readings = fit::point_readings(poses);
    const MatrixXd columns(model::linearise(machine, readings, here).jacobian);
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t k = 0; k < parameters.size(); ++k)
        if (here[i].name == parameters[k].name)
          rows.col(static_cast<Index>(k)) = columns.col(static_cast<Index>(i));
    if (knowledge_.new_set_up) {
      Eigen::Matrix3Xd points = model::forward(machine, poses).position;
      const Eigen::Vector3d middle = points.rowwise().mean();
      points.colwise() -= middle;
      rows.middleCols(size_ - 9, 6) = fit::rigid_motions(points);
    }
    for (Index i = 0; i < rows.rows(); ++i) {
      rows(i, size_ - 3 + i % 3) = 1;
      if (!knowledge_.reads[static_cast<std::size_t>(i % 3)]) rows.row(i).setZero();
    }
    return rows;
  }

  double variance() const { return knowledge_.reading_mm * knowledge_.reading_mm; }

  double expanded_um(const MatrixXd& covariance) const {
    return 2 * maths::kUmPerMm * std::sqrt(std::max(0.0, covariance.cwiseProduct(weight_).sum()));
  }

  double piece_um(const AimRows::Piece& piece, const MatrixXd& covariance) const {
    const MatrixXd rows = aim_.rows.middleRows(piece.first, piece.count);
    const double square = (rows * MatrixXd(covariance(own_, own_))).cwiseProduct(rows).sum();
    return 2 * maths::kUmPerMm * std::sqrt(std::max(0.0, square)) / piece.scale;
  }

  /// C - C J^T (J C J^T + s^2)^-1 J C, block by block: of any number of rows.
  MatrixXd after(const MatrixXd& rows, double better) const {
    MatrixXd covariance = prior_;
    constexpr Index kAtOnce = 60;  // poses of an offer whose gain is reckoned in one product
    for (Index first = 0; first < rows.rows(); first += kAtOnce) {
      const auto block = rows.middleRows(first, std::min(kAtOnce, rows.rows() - first));
      const MatrixXd gain = covariance * block.transpose();
      MatrixXd inner = block * gain;
      inner.diagonal().array() += variance() * better * better;
      covariance -= gain * maths::solve_positive(inner, gain.transpose());
      covariance = (0.5 * (covariance + covariance.transpose())).eval();
    }
    return covariance;
  }

  void update(std::size_t pose) {
    const MatrixXd rows = jacobian_.middleRows(3 * static_cast<Index>(pose), 3);
    const MatrixXd gain = covariance_ * rows.transpose();
    const Eigen::Matrix3d inner = rows * gain + variance() * Eigen::Matrix3d::Identity();
    covariance_ -= gain * inner.llt().solve(gain.transpose());
  }

  /// The pose whose reading takes most off the mean square.
  std::size_t best(const std::vector<std::size_t>& taken) const {
    const MatrixXd known = jacobian_ * covariance_;
    const MatrixXd aimed = known * weight_;
    std::vector<char> out(offered_.count, 0);
    for (const std::size_t pose : taken) out[pose] = 1;
    double most = -1;
    std::size_t at = 0;
    for (std::size_t i = 0; i < offered_.count; ++i) {
      if (out[i] != 0) continue;
      const auto first = 3 * static_cast<Index>(i);
      const Eigen::Matrix3d inner = known.middleRows(first, 3) * jacobian_.middleRows(first, 3).transpose() +
                                    variance() * Eigen::Matrix3d::Identity();
      const Eigen::Matrix3d gained = aimed.middleRows(first, 3) * known.middleRows(first, 3).transpose();
      const double fall = inner.llt().solve(gained).trace();
      if (fall > most) most = fall, at = i;
    }
    return at;
  }

  double minutes_of(const std::vector<std::size_t>& chosen, const AccuracyOptions& options) const {
    const std::vector<std::size_t> way = nearest_way(knowledge_.machine, offered_, chosen);
    double seconds = options.reading_s * static_cast<double>(way.size());
    for (std::size_t i = 1; i < way.size(); ++i) {
      double longest = 0;
      for (std::size_t a = 0; a < knowledge_.machine.axes.size(); ++a) {
        const double step = std::abs(offered_.axis[a][static_cast<Index>(way[i])] -
                                     offered_.axis[a][static_cast<Index>(way[i - 1])]);
        const double speed = knowledge_.machine.axes[a].rotary ? options.turn_deg_min : options.feed_mm_min;
        longest = std::max(longest, 60 * step / speed);
      }
      seconds += longest;
    }
    return seconds / 60;
  }

  /// Lines of the table: the first few, then ever further apart, and the last.
  void note(AccuracyPlan& plan, const AccuracyOptions& options, const std::vector<std::size_t>& chosen,
            double now_um, bool last) const {
    // Times the points, from one look at the promised uncertainty to the next.
    constexpr double kFurther = 1.4;
    const auto before = static_cast<double>(plan.steps.back().points);
    const auto count = static_cast<double>(chosen.size());
    if (count <= before || (!last && count < std::max(before + 1, kFurther * before))) return;
    plan.steps.push_back({chosen.size(), minutes_of(chosen, options), now_um});
  }

  double random_um(std::size_t count) const {
    constexpr std::size_t kDraws = 5;  // of other poses: the same search from other beginnings
    double squares = 0;
    for (std::size_t draw = 0; draw < kDraws; ++draw) {
      std::vector<std::size_t> rows(count);
      for (std::size_t i = 0; i < count; ++i) rows[i] = i;
      model::States poses = model::select_states(offered_, std::vector<std::size_t>(count, 0));
      for (std::size_t a = 0; a < knowledge_.machine.axes.size(); ++a) {
        const auto range = model::work_range(knowledge_.machine, a);
        constexpr std::array<std::size_t, 10> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
        for (std::size_t i = 0; i < count; ++i)
          poses.axis[a][static_cast<Index>(i)] =
              (*range)[0] + ((*range)[1] - (*range)[0]) *
                                maths::radical_inverse(10000 + 997 * draw + i, kPrimes[a % kPrimes.size()]);
      }
      squares += std::pow(uncertainty_um(poses), 2);
    }
    return std::sqrt(squares / kDraws);
  }

  /// The remaining mean square, by source.
  std::vector<AccuracyLimit> limits_of(const MatrixXd& covariance) const {
    const MatrixXd product = covariance * weight_;
    const double total = std::max(product.trace(), 1e-300);
    std::vector<AccuracyLimit> limits;
    for (const tolerance::MachineSource& source :
         tolerance::machine_sources(knowledge_.machine, knowledge_.parameters, effects::built_in_effects())) {
      double share = 0;
      for (const std::size_t p : source.parameters)
        share += product(static_cast<Index>(p), static_cast<Index>(p));
      if (share / total > 0.01) limits.push_back({source.name, share / total});
    }
    std::sort(limits.begin(), limits.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
    return limits;
  }

  const Knowledge& knowledge_;
  std::vector<Index> own_;
  AimRows aim_;
  Index size_ = 0;           // parameters, six of a new set-up, three of the run
  MatrixXd weight_, prior_;  // weight of a covariance at the aim; state before the first reading
  model::States offered_;
  MatrixXd jacobian_, covariance_;
};

/// Median u of the coordinates, 1 mm without u: the unit of a weight.
double usual_reading_mm(const model::Measurement& m) {
  std::vector<double> all;
  for (const model::Observation& o : m.observations)
    if (o.kind <= model::ObservationKind::kZ) all.push_back(model::uncertainty_of(m, o));
  if (all.empty() || !fit::has_uncertainty(m)) return 1;
  return maths::median(std::move(all));
}

}  // namespace

Knowledge knowledge_of(const fit::FitResult& fitted, const model::Measurement& measurement) {
  Knowledge knowledge{fitted.machine, fitted.parameters, fitted.covariance, 0, 0, true, {}};
  for (const model::Observation& o : measurement.observations)
    if (o.kind <= model::ObservationKind::kZ) knowledge.reads[static_cast<std::size_t>(o.kind)] = true;
  if (!knowledge.reads[0] && !knowledge.reads[1] && !knowledge.reads[2])
    throw text::InputError(
        {measurement.files.empty() ? "" : measurement.files[0], 0}, format::words_of(format::columns::kPoint),
        "a plan for accuracy requires readings of the tool point, but this file has no such readings");
  const fit::NoiseModel& noise = fitted.noise;
  const double unit_mm = usual_reading_mm(measurement);
  const double own = std::sqrt(noise.own * noise.own + noise.pose * noise.pose + noise.drift * noise.drift);
  knowledge.reading_mm = unit_mm * std::max(std::sqrt(fitted.variance_factor), noise.independent() ? 0 : own);
  knowledge.run_mm = unit_mm * noise.run;
  knowledge.new_set_up =
      std::none_of(fitted.parameters.begin(), fitted.parameters.end(), [](const model::Parameter& p) {
        return p.kind == model::ParameterKind::kBaseShift && p.name.rfind("BaseShift.", 0) == 0;
      });
  return knowledge;
}

Knowledge knowledge_of(const model::Machine& fitted) {
  const fit::Reach reach(fitted);
  if (!reach.known())
    throw text::InputError(
        {fitted.file, 0}, fitted.name,
        "was never fitted (no <fitted>): the present uncertainty is not known. Run vernier fit first");
  Knowledge knowledge;
  knowledge.machine = reach.machine();
  knowledge.parameters = reach.parameters();
  knowledge.covariance = reach.factor() * reach.factor().transpose();
  return knowledge;
}

AccuracyPlan accuracy_plan(const Knowledge& knowledge, const AccuracyAim& aim,
                           const AccuracyOptions& options) {
  return AccuracyPlanner(knowledge, aim).plan(options);
}

double expected_accuracy_um(const Knowledge& knowledge, const AccuracyAim& aim, const model::States& poses) {
  return AccuracyPlanner(knowledge, aim).uncertainty_um(poses);
}

std::string accuracy_plan_csv(const Knowledge& knowledge, const AccuracyPlan& plan) {
  return "# Approach every pose in the direction of dir; fill in x, y, z as they are read; then fit "
         "these "
         "rows together with the others.\n" +
         pose_rows_csv(knowledge.machine, plan.states, std::vector<char>(plan.states.count, 0),
                       maths::kUmPerMm * knowledge.reading_mm, kAccuracyRun);
}

}  // namespace vernier::plan
