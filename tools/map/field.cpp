// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/map/field.h"

#include <algorithm>
#include <cmath>

#include "tools/kinematics/correction.h"
#include "tools/text/error.h"

namespace vernier::map {
namespace {

using Eigen::Index;

/// Tolerance of a reached point.
constexpr double kSlack_mm = 1e-6;

const model::Axis& ranged(const model::Machine& machine, std::size_t axis) {
  const model::Axis& one = machine.axes[axis];
  if (!one.min || !one.max)
    throw text::InputError({machine.file, one.line}, one.name,
                           "this axis has no min and max; give them in the machine file");
  return one;
}

/// Number of each axis of `correction` in `machine`.
std::vector<std::size_t> same_axes(const model::Machine& machine, const model::Machine& correction) {
  std::vector<std::size_t> numbers;
  for (const model::Axis& axis : correction.axes) {
    const auto found = machine.find_axis(axis.name);
    if (!found)
      throw text::InputError({correction.file, axis.line}, axis.name,
                             "the machine that is corrected has no axis of this name");
    numbers.push_back(*found);
  }
  return numbers;
}

/// The states of `machine` as states of another model of it: axes by number, inputs by name. Inputs that
/// `machine` lacks are at their reference.
model::States states_for(const model::Machine& other, const std::vector<std::size_t>& axes,
                         const model::Machine& machine, const model::States& from) {
  model::States states = model::make_states(from.count, other);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    states.axis[i] = from.axis[axes[i]];
    states.direction[i] = from.direction[axes[i]];
    states.since[i] = from.since[axes[i]];
    states.velocity[i] = from.velocity[axes[i]];
    states.acceleration[i] = from.acceleration[axes[i]];
  }
  for (std::size_t i = 0; i < other.inputs.size(); ++i)
    for (std::size_t k = 0; k < machine.inputs.size(); ++k)
      if (machine.inputs[k].name == other.inputs[i].name) states.input[i] = from.input[k];
  states.feed = from.feed, states.curvature = from.curvature;
  states.time = from.time, states.visit = from.visit, states.normal = from.normal;
  return states;
}

}  // namespace

ErrorField error_field(const model::Machine& machine, const model::States& at,
                       const std::vector<std::size_t>& axes, std::size_t count) {
  if (axes.empty() || axes.size() > 3)
    throw text::InputError({machine.file, 0}, "", "--over needs one to three axes");
  ErrorField field;
  field.axes = axes;
  field.counts.assign(axes.size(), count);
  std::size_t nodes = 1;
  for (const std::size_t n : field.counts) nodes *= n;
  field.states = model::select_states(at, std::vector<std::size_t>(nodes, 0));
  std::size_t stride = 1;
  for (const std::size_t axis : axes) {
    const model::Axis& one = ranged(machine, axis);
    for (std::size_t i = 0; i < nodes; ++i)
      field.states.axis[axis][static_cast<Index>(i)] =
          *one.min +
          (*one.max - *one.min) * static_cast<double>(i / stride % count) / static_cast<double>(count - 1);
    stride *= count;
  }
  field.nominal = model::forward(model::nominal_machine(machine), field.states).position;
  field.deviation = model::forward(machine, field.states).position - field.nominal;
  return field;
}

Eigen::Matrix3Xd corrected_deviation(const model::Machine& machine, const ErrorField& field,
                                     const model::Machine& correction) {
  const std::vector<std::size_t> axes = same_axes(machine, correction);
  kinematics::CorrectionOptions options;
  options.with_rotary = kinematics::linear_axes(correction).empty();
  const kinematics::CorrectionResult result =
      kinematics::correct(correction, states_for(correction, axes, machine, field.states), options);
  model::States states = field.states;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!result.offset[i].isFinite().all())
      throw text::InputError({correction.file, correction.axes[i].line}, correction.axes[i].name,
                             "the offsets of the correction do not converge at a node of the map");
    states.axis[axes[i]] += result.offset[i];
  }
  return model::forward(machine, states).position - field.nominal;
}

Bench::Bench(const model::Machine& machine, const model::States& at)
    : machine_(machine),
      nominal_(model::nominal_machine(machine)),
      at_(at),
      axes_(kinematics::linear_axes(machine)),
      closed_(kinematics::closed_solution(nominal_, at)) {
  if (axes_.empty() || axes_.size() > 3)
    throw text::InputError(
        {machine.file, 0}, "",
        "no measurement is simulated, because a simulation requires one to three linear axes");
  for (const std::size_t axis : axes_) ranged(machine, axis);
}

Eigen::Vector3d Bench::point_at(const Eigen::VectorXd& fraction) const {
  Eigen::VectorXd q(fraction.size());
  for (Index k = 0; k < q.size(); ++k) {
    const model::Axis& axis = machine_.axes[axes_[static_cast<std::size_t>(k)]];
    q[k] = *axis.min + fraction[k] * (*axis.max - *axis.min);
  }
  return model::forward(nominal_, standing_at(q)).position.col(0);
}

model::States Bench::standing_at(const Eigen::MatrixXd& positions) const {
  model::States states =
      model::select_states(at_, std::vector<std::size_t>(static_cast<std::size_t>(positions.cols()), 0));
  for (Index k = 0; k < positions.rows(); ++k)
    states.axis[axes_[static_cast<std::size_t>(k)]] = positions.row(k).transpose().array();
  return states;
}

Eigen::MatrixXd Bench::positions_of(const Eigen::Matrix3Xd& points) const {
  if (closed_) return kinematics::solve_closed(*closed_, points);
  Eigen::MatrixXd middle(axes_.size(), points.cols());
  for (std::size_t k = 0; k < axes_.size(); ++k)
    middle.row(static_cast<Index>(k))
        .setConstant((*machine_.axes[axes_[k]].min + *machine_.axes[axes_[k]].max) / 2);
  model::Poses target;
  target.position = points;
  target.rotation.assign(static_cast<std::size_t>(points.cols()), Eigen::Matrix3d::Identity());
  kinematics::InverseOptions options;
  options.match = kinematics::Match::kPosition;
  options.axes = axes_;
  options.keep_ranges = false;
  options.only_reachable = axes_.size() < 3;
  const model::States solved = kinematics::solve(nominal_, target, standing_at(middle), options).states;
  Eigen::MatrixXd positions(axes_.size(), points.cols());
  for (std::size_t k = 0; k < axes_.size(); ++k)
    positions.row(static_cast<Index>(k)) = solved.axis[axes_[k]].matrix().transpose();
  return positions;
}

bool Bench::comes_to(const Eigen::MatrixXd& positions, const Eigen::Matrix3Xd& points) const {
  const Eigen::Matrix3Xd there = model::forward(nominal_, standing_at(positions)).position;
  return (there - points).colwise().norm().maxCoeff() <= kSlack_mm;
}

bool Bench::meets(const Eigen::Matrix3Xd& points) const { return comes_to(positions_of(points), points); }

bool Bench::reaches(const Eigen::Matrix3Xd& points) const {
  const Eigen::MatrixXd q = positions_of(points);
  if (!comes_to(q, points)) return false;
  for (Index k = 0; k < q.rows(); ++k) {
    const model::Axis& axis = machine_.axes[axes_[static_cast<std::size_t>(k)]];
    if (q.row(k).minCoeff() < *axis.min - kSlack_mm || q.row(k).maxCoeff() > *axis.max + kSlack_mm)
      return false;
  }
  return true;
}

Eigen::Matrix3Xd Bench::measure(const Eigen::Matrix3Xd& points) const {
  return model::forward(machine_, states_of(positions_of(points))).position;
}

model::States Bench::states_of(const Eigen::MatrixXd& positions) const {
  const Index count = positions.cols();
  model::States states = standing_at(positions);
  constexpr double kStill_mm = 1e-9;  // a smaller value is rounding of the inverse solution, not motion
  for (Index k = 0; k < positions.rows(); ++k) {
    const std::size_t axis = axes_[static_cast<std::size_t>(k)];
    double sense = 0, since = model::kLongWay;
    for (Index i = 1; i < count && sense == 0; ++i) {
      const double step = positions(k, i) - positions(k, i - 1);
      if (std::abs(step) > kStill_mm) sense = step > 0 ? 1 : -1;
    }
    for (Index i = 0; i < count; ++i) {
      const double step = i > 0 ? positions(k, i) - positions(k, i - 1) : 0;
      if (std::abs(step) > kStill_mm) {
        const double next = step > 0 ? 1 : -1;
        since = next == sense ? since + std::abs(step) : std::abs(step);
        sense = next;
      }
      states.direction[axis][i] = sense;
      states.since[axis][i] = std::min(since, model::kLongWay);
    }
  }
  return states;
}

}  // namespace vernier::map
