// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/corrector.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/kinematics/correction.h"
#include "tools/maths/factors.h"
#include "tools/maths/median.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"

namespace vernier::offline {

double CorrectionSummary::largest_um(const model::Machine& machine) const {
  double squares = 0;
  for (std::size_t i = 0; i < largest.size(); ++i)
    if (!machine.axes[i].rotary) squares += largest[i] * largest[i];
  return maths::kUmPerMm * std::sqrt(squares);
}

double CorrectionSummary::largest_deg(const model::Machine& machine) const {
  double most = 0;
  for (std::size_t i = 0; i < largest.size(); ++i)
    if (machine.axes[i].rotary) most = std::max(most, largest[i]);
  return most;
}

Corrector::Corrector(const model::Machine& machine, CorrectorOptions options)
    : machine_(machine), nominal_(model::nominal_machine(machine)), options_(options) {
  summary_.largest.assign(machine.axes.size(), 0);
}

Eigen::MatrixXd Corrector::commands(const model::States& states) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(machine_.axes.size()),
                         static_cast<Eigen::Index>(states.count));
  const auto keep = [&](std::size_t axis, const model::Column& values) {
    result.row(static_cast<Eigen::Index>(axis)) = values.matrix().transpose();
  };
  if (!options_.back) {
    const kinematics::CorrectionResult corrected =
        kinematics::correct(machine_, states, {.with_rotary = options_.with_rotary});
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) keep(i, states.axis[i] + corrected.offset[i]);
    conditions_.clear();
    for (const kinematics::Inverse& one : corrected.each) conditions_.push_back(one.condition);
    return result;
  }
  kinematics::InverseOptions solving;
  solving.match = options_.with_rotary ? kinematics::Match::kDirection : kinematics::Match::kPosition;
  if (!options_.with_rotary) solving.axes = kinematics::linear_axes(machine_);
  solving.keep_ranges = false;
  solving.only_reachable = true;
  const kinematics::InverseResult solved =
      kinematics::solve(nominal_, model::forward(machine_, states), states, solving);
  for (std::size_t i = 0; i < machine_.axes.size(); ++i) keep(i, solved.states.axis[i]);
  return result;
}

void Corrector::count_beyond(const model::States& states, const Eigen::MatrixXd& commands,
                             const std::vector<std::size_t>& lines) {
  if (options_.back) return;
  for (std::size_t state = 0; state < states.count; ++state) {
    const auto at = static_cast<Eigen::Index>(state);
    BeyondLimit most;
    double share = 1;  // of the limit
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const auto& limit = machine_.axes[i].max_correction;
      const double size = std::abs(commands(static_cast<Eigen::Index>(i), at) - states.axis[i][at]);
      if (!limit || size <= share * *limit) continue;
      share = *limit > 0 ? size / *limit : std::numeric_limits<double>::infinity();
      most = {i, size, state < lines.size() ? lines[state] : 0,
              state < conditions_.size() ? conditions_[state] : 0};
    }
    if (most.size > 0) summary_.beyond.push_back(most);
  }
  if (!conditions_.empty()) summary_.usual_condition = maths::median(conditions_);
}

void Corrector::count(const model::States& states, const Eigen::MatrixXd& commands,
                      const std::vector<std::size_t>& lines) {
  count_beyond(states, commands, lines);
  // The result is tested with the chain, not by the report of the solver.
  model::States there = states;
  for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
    there.axis[i] = commands.row(static_cast<Eigen::Index>(i)).transpose().array();
    if (states.count > 0)
      summary_.largest[i] = std::max(summary_.largest[i], (there.axis[i] - states.axis[i]).abs().maxCoeff());
  }
  const model::Machine &from = options_.back ? nominal_ : machine_, &to = options_.back ? machine_ : nominal_;
  const Eigen::Matrix3Xd left = model::forward(from, there).position - model::forward(to, states).position;
  constexpr double kReached = 1e-6;  // mm, in addition to errors that the axes cannot correct
  const Eigen::Matrix3Xd before = model::forward(from, states).position - model::forward(to, states).position;
  for (Eigen::Index i = 0; i < left.cols(); ++i) {
    summary_.left_mm = std::max(summary_.left_mm, left.col(i).norm());
    if (left.col(i).norm() > kReached && left.col(i).norm() >= before.col(i).norm()) ++summary_.not_converged;
  }
  summary_.positions += states.count;
}

void refuse_done(const std::string& text, const std::string& file, bool back) {
  const char* mark = back ? kBackMark : kCorrectedMark;
  const auto at = text.find(mark);
  if (at == std::string::npos) return;
  const auto line = 1 + static_cast<std::size_t>(
                            std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  throw text::InputError(
      {file, line}, mark,
      back ? "these positions are already those of an ideal machine; a second conversion would add the error"
           : "this file was already corrected; a second correction would reverse the sign of the error");
}

}  // namespace vernier::offline
