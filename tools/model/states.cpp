// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/states.h"

#include <algorithm>

#include "tools/model/machine.h"

namespace vernier::model {
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

States make_states(std::size_t count, const Machine& machine) {
  std::vector<double> references;
  for (const Input& input : machine.inputs) references.push_back(input.reference);
  return make_states(count, machine.axes.size(), references);
}

void make_one_run(States& states, const std::string& name) {
  states.run.assign(states.count, 0);
  states.run_names = {name};
  for (const auto labels : kStateLabels) states.*labels = {};
}

void begin_run(States& states, std::size_t moment, const std::string& name) {
  states.run[moment] = states.run_names.size();
  states.run_names.push_back(name);
  for (const auto labels : kStateLabels) {
    Labels& one = states.*labels;
    if (one.of.empty()) continue;
    one.of[moment] = one.names.size();
    one.names.push_back(name);
  }
}

void append_labels(States& all, const States& next, bool apart) {
  const auto append = [&](std::vector<std::size_t>& of, std::vector<std::string>& names,
                          const std::vector<std::size_t>& next_of,
                          const std::vector<std::string>& next_names) {
    std::vector<std::size_t> at;
    const auto known = static_cast<std::ptrdiff_t>(apart ? 0 : names.size());
    for (const std::string& name : next_names) {
      const auto found = std::find(names.begin(), names.begin() + known, name);
      at.push_back(found == names.begin() + known ? names.size()
                                                  : static_cast<std::size_t>(found - names.begin()));
      if (at.back() == names.size()) names.push_back(name);
    }
    for (const std::size_t one : next_of) of.push_back(at[one]);
  };
  for (const auto labels : kStateLabels) {
    Labels& one = all.*labels;
    const Labels& other = next.*labels;
    if (one.of.empty() && other.of.empty()) continue;
    // If only one of two files has labels, the runs of the other file are its labels.
    if (one.of.empty()) one = {all.run, all.run_names};
    if (other.of.empty())
      append(one.of, one.names, next.run, next.run_names);
    else
      append(one.of, one.names, other.of, other.names);
  }
  append(all.run, all.run_names, next.run, next.run_names);
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
  for (const auto labels : kStateLabels) {
    (result.*labels).names = (states.*labels).names;
    if ((states.*labels).of.empty()) continue;
    for (const std::size_t i : which) (result.*labels).of.push_back((states.*labels).of[i]);
  }
  return result;
}

}  // namespace vernier::model
