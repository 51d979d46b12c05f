// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/states.h"

namespace vernier {
namespace {

Column pick(const Column& column, const std::vector<std::size_t>& which) {
  Column result(static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = column[static_cast<Eigen::Index>(which[i])];
  return result;
}

std::vector<Column> pick(const std::vector<Column>& columns, const std::vector<std::size_t>& which) {
  std::vector<Column> result;
  result.reserve(columns.size());
  for (const Column& column : columns) result.push_back(pick(column, which));
  return result;
}

}  // namespace

States make_states(std::size_t count, std::size_t axes, const std::vector<double>& input_references) {
  const auto n = static_cast<Eigen::Index>(count);
  const Column zero = Column::Zero(n);
  States states;
  states.count = count;
  states.axis.assign(axes, zero);
  states.velocity = states.acceleration = states.direction = states.axis;
  states.since.assign(axes, Column::Constant(n, kLongWay));
  states.feed = states.curvature = states.time = states.visit = zero;
  states.normal = {zero, zero, zero};
  for (const double reference : input_references) states.input.push_back(Column::Constant(n, reference));
  states.run.assign(count, 0);
  states.run_names = {""};
  return states;
}

States select_states(const States& states, const std::vector<std::size_t>& which) {
  States result;
  result.count = which.size();
  result.axis = pick(states.axis, which);
  result.velocity = pick(states.velocity, which);
  result.acceleration = pick(states.acceleration, which);
  result.direction = pick(states.direction, which);
  result.since = pick(states.since, which);
  result.feed = pick(states.feed, which);
  result.curvature = pick(states.curvature, which);
  for (std::size_t i = 0; i < 3; ++i) result.normal[i] = pick(states.normal[i], which);
  result.time = pick(states.time, which);
  result.visit = pick(states.visit, which);
  result.input = pick(states.input, which);
  for (const std::size_t i : which) result.run.push_back(states.run[i]);
  result.run_names = states.run_names;
  return result;
}

}  // namespace vernier
