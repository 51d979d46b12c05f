// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/unmeasured.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "tools/fit/alternatives.h"
#include "tools/fit/reach.h"
#include "tools/maths/orthonormal.h"
#include "tools/model/chain.h"
#include "tools/model/work_poses.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Standard deviations, squared, by which two explanations must differ on the readings to be distinguished.
constexpr double kSeen = 9;
/// A variable whose weighted standard deviation is above this share of its range has varied (an even spread
/// has 0.29).
constexpr double kVaried = 0.15;
/// An axis that moved by less than this share of its travel was not measured at all: rule `measured-range`.
constexpr double kMoved = 0.05;
/// What moves the tool by less is nobody's concern, mm.
constexpr double kNothing_mm = 5e-5;
/// Rows that are looked at, at most: every k-th.
constexpr std::size_t kMostRows = 2000;

/// The axis or the input of a name.
struct Variable {
  bool is_axis = true;
  std::size_t index = 0;
  const model::Column& of(const model::States& states) const {
    return is_axis ? states.axis[index] : states.input[index];
  }
  model::Column& of(model::States& states) const {
    return is_axis ? states.axis[index] : states.input[index];
  }
};

/// The machine without one coefficient: at nominal, a table's column and a scale factor at 0.
model::Machine without(const model::Machine& machine, const model::ParameterSet& parameters,
                       const Coefficient& coefficient) {
  model::Machine other = machine;
  VectorXd values = parameters.get(machine);
  const VectorXd nominal = parameters.get(model::nominal_machine(machine));
  for (const std::size_t i : coefficient.parameters)
    values[static_cast<Index>(i)] = nominal[static_cast<Index>(i)];
  parameters.set(other, values);
  return other;
}

/// What a coefficient does to the tool point at each state: 3 N, mm.
VectorXd effect(const model::Machine& machine, const model::Machine& other, const model::States& states) {
  const Eigen::Matrix3Xd off =
      model::forward(machine, states).position - model::forward(other, states).position;
  return off.reshaped();
}

/// Fit rows that read a length, every k-th, with the weight of its first one; and whether rotations were
/// read.
struct LengthRows {
  model::States states;
  VectorXd weight;              // a row, 1/mm
  std::vector<char> rotations;  // a row: its rotation was read too
  std::vector<std::size_t> setup;
  double share = 1;  // of all rows
};

LengthRows length_rows(const model::Measurement& m, double variance, double rms_mm) {
  std::vector<double> weight(m.rows(), 0);
  std::vector<char> rotations(m.rows(), 0);
  for (const model::Observation& o : m.observations) {
    if (model::is_rotation(o.kind)) {
      rotations[o.row] = 1;
    } else if (m.check[o.row] == 0 && weight[o.row] <= 0) {
      const double u = model::uncertainty_of(m, o);
      weight[o.row] = u > 0 ? 1 / (u * std::sqrt(variance)) : 1 / std::max(rms_mm, 1e-9);
    }
  }
  std::vector<std::size_t> all, keep;
  for (std::size_t row = 0; row < m.rows(); ++row)
    if (weight[row] > 0) all.push_back(row);
  const std::size_t every = std::max<std::size_t>(1, (all.size() + kMostRows - 1) / kMostRows);
  for (std::size_t i = 0; i < all.size(); i += every) keep.push_back(all[i]);
  LengthRows rows;
  rows.states = model::select_states(m.states, keep);
  rows.share = 1 / static_cast<double>(every);
  rows.weight.resize(static_cast<Index>(keep.size()));
  for (std::size_t i = 0; i < keep.size(); ++i) {
    rows.weight[static_cast<Index>(i)] = weight[keep[i]];
    rows.rotations.push_back(rotations[keep[i]]);
    rows.setup.push_back(m.states.of(m.states.setup, keep[i]));
  }
  return rows;
}

class UnvariedFinder {
 public:
  UnvariedFinder(const model::Machine& fitted, const model::Measurement& m, double variance)
      : machine_(fitted), rows_(length_rows(m, variance, fitted.fitted ? fitted.fitted->rms_mm : 1)) {
    machine_.base_shifts.clear();
    parameters_ = model::ParameterSet(machine_, {});
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) add_axis(a);
    for (std::size_t i = 0; i < machine_.inputs.size(); ++i) add_input(i);
  }

  std::vector<model::FitRecord::Unvaried> run() {
    if (rows_.states.count == 0) return {};
    for (const Coefficient& coefficient : coefficients_of(parameters_)) look_at(coefficient);
    return std::move(found_);
  }

 private:
  struct Candidate {
    Variable variable;
    std::string name;
    double range = 0;
  };

  void add_axis(std::size_t a) {
    const model::Column& q = rows_.states.axis[a];
    if (q.size() == 0) return;
    const double measured = q.maxCoeff() - q.minCoeff();
    const auto work = model::work_range(machine_, a);
    const double range = work ? (*work)[1] - (*work)[0] : measured;
    if (measured > kMoved * range) candidates_.push_back({{true, a}, machine_.axes[a].name, range});
  }

  void add_input(std::size_t i) {
    const model::Input& input = machine_.inputs[i];
    const model::Column& value = rows_.states.input[i];
    if (value.size() == 0 || input.hidden_axis) return;
    double range = std::max(value.maxCoeff() - value.minCoeff(), std::abs(value.mean() - input.reference));
    if (input.min && input.max) range = std::max(range, *input.max - *input.min);
    if (range > 0) candidates_.push_back({{false, i}, input.name, range});
  }

  void look_at(const Coefficient& coefficient) {
    const model::Machine other = without(machine_, parameters_, coefficient);
    const VectorXd all = effect(machine_, other, rows_.states);
    const VectorXd weighed = weigh(all);
    if (weighed.squaredNorm() < kSeen * rows_.share || turns_where_read(other, all)) return;
    VectorXd mass(rows_.weight.size());
    for (Index i = 0; i < mass.size(); ++i) mass[i] = weighed.segment<3>(3 * i).squaredNorm();
    mass /= mass.sum();
    for (const Candidate& one : candidates_) {
      const model::Column& value = one.variable.of(rows_.states);
      const double mean = mass.dot(value.matrix());
      const double spread = std::sqrt(mass.dot((value - mean).square().matrix()));
      if (spread > kVaried * one.range) continue;
      model::States held = rows_.states;
      one.variable.of(held).setConstant(mean);
      if (!same_on_rows(weighed, weigh(effect(machine_, other, held)))) continue;
      if (moves_the_tool(one, other, mean, mass)) found_.push_back({coefficient.name, one.name, mean});
    }
  }

  VectorXd weigh(VectorXd points) const {
    for (Index i = 0; i < rows_.weight.size(); ++i) points.segment<3>(3 * i) *= rows_.weight[i];
    return points;
  }

  /// Does the coefficient turn the tool in rows where it acts and that read rotations?
  bool turns_where_read(const model::Machine& other, const VectorXd& all) const {
    if (std::find(rows_.rotations.begin(), rows_.rotations.end(), 1) == rows_.rotations.end()) return false;
    const model::Poses with = model::forward(machine_, rows_.states),
                       less = model::forward(other, rows_.states);
    constexpr double kTurned_rad = 1e-9;  // above rounding
    for (std::size_t i = 0; i < rows_.states.count; ++i)
      if (rows_.rotations[i] != 0 && all.segment<3>(3 * static_cast<Index>(i)).norm() > 0 &&
          (with.rotation[i] - less.rotation[i]).norm() > kTurned_rad)
        return true;
    return false;
  }

  /// Six columns of each set-up's rigid motion, orthonormal.
  const MatrixXd& set_ups() {
    if (set_ups_.size() > 0) return set_ups_;
    const MatrixXd rigid = rigid_motions(model::forward(machine_, rows_.states).position);
    std::map<std::size_t, Index> place;
    for (const std::size_t name : rows_.setup) place.emplace(name, static_cast<Index>(place.size()));
    MatrixXd columns = MatrixXd::Zero(rigid.rows(), 6 * static_cast<Index>(place.size()));
    for (std::size_t i = 0; i < rows_.setup.size(); ++i)
      columns.block<3, 6>(3 * static_cast<Index>(i), 6 * place[rows_.setup[i]]) =
          rows_.weight[static_cast<Index>(i)] * rigid.middleRows<3>(3 * static_cast<Index>(i));
    set_ups_ = maths::orthonormal(columns, 1e-9, nullptr);
    return set_ups_;
  }

  bool same_on_rows(const VectorXd& as_modelled, const VectorXd& held) {
    const MatrixXd& set_up = set_ups();
    const VectorXd a = as_modelled - set_up * (set_up.transpose() * as_modelled),
                   b = held - set_up * (set_up.transpose() * held);
    if (a.squaredNorm() < kSeen * rows_.share) return false;  // not seen at all: the covariance says so
    if (b.squaredNorm() <= 0) return false;
    const VectorXd rest = a - b * (b.dot(a) / b.squaredNorm());
    return rest.squaredNorm() < kSeen * rows_.share;
  }

  /// Over its working volume, with inputs where the effect was seen and at their references.
  bool moves_the_tool(const Candidate& one, const model::Machine& other, double at,
                      const VectorXd& mass) const {
    std::vector<std::array<double, 2>> ranges;
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) {
      const model::Column& q = rows_.states.axis[a];
      ranges.push_back(model::work_range(machine_, a).value_or(std::array{q.minCoeff(), q.maxCoeff()}));
    }
    model::States states = model::poses_over(machine_, ranges).states;
    for (const bool at_reference : {false, true}) {
      for (std::size_t i = 0; i < machine_.inputs.size(); ++i)
        states.input[i].setConstant(at_reference ? machine_.inputs[i].reference
                                                 : mass.dot(rows_.states.input[i].matrix()));
      model::States held = states;
      one.variable.of(held).setConstant(at);
      const VectorXd difference = effect(machine_, other, states) - effect(machine_, other, held);
      if (difference.cwiseAbs().maxCoeff() > kNothing_mm) return true;
    }
    return false;
  }

  model::Machine machine_;
  model::ParameterSet parameters_;
  LengthRows rows_;
  std::vector<Candidate> candidates_;
  MatrixXd set_ups_;
  std::vector<model::FitRecord::Unvaried> found_;
};

std::optional<Variable> variable_named(const model::Machine& machine, const std::string& name) {
  if (const auto axis = machine.find_axis(name)) return Variable{true, *axis};
  if (const auto input = machine.find_input(name)) return Variable{false, *input};
  return std::nullopt;
}

void append(MatrixXd& columns, const VectorXd& one) {
  columns.conservativeResize(one.size(), columns.cols() + 1);
  columns.rightCols<1>() = one;
}

}  // namespace

std::vector<Coefficient> coefficients_of(const model::ParameterSet& parameters) {
  std::vector<Coefficient> list;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const model::Parameter& p = parameters[i];
    if (p.kind == model::ParameterKind::kBaseShift) continue;
    std::string name = p.name;
    if (p.kind == model::ParameterKind::kStation)
      name = name.substr(0, name.find('[')) + name.substr(name.rfind(']') + 1);
    const auto same =
        std::find_if(list.begin(), list.end(), [&](const Coefficient& one) { return one.name == name; });
    if (same == list.end())
      list.push_back({name, {i}});
    else
      same->parameters.push_back(i);
  }
  return list;
}

std::vector<model::FitRecord::Unvaried> unvaried_dependences(const model::Machine& fitted,
                                                             const model::Measurement& rows,
                                                             double variance) {
  return UnvariedFinder(fitted, rows, variance).run();
}

MatrixXd unmeasured_columns(const model::Machine& bare, const model::ParameterSet& parameters,
                            const model::FitRecord& record, const model::States& states) {
  MatrixXd columns(3 * static_cast<Index>(states.count), 0);
  const std::vector<Coefficient> coefficients = coefficients_of(parameters);
  for (const model::FitRecord::Unvaried& one : record.unvaried) {
    const auto coefficient = std::find_if(coefficients.begin(), coefficients.end(),
                                          [&](const auto& item) { return item.name == one.coefficient; });
    const auto variable = variable_named(bare, one.variable);
    if (coefficient == coefficients.end() || !variable) continue;
    const model::Machine other = without(bare, parameters, *coefficient);
    model::States held = states;
    variable->of(held).setConstant(one.at);
    append(columns, effect(bare, other, states) - effect(bare, other, held));
  }
  for (const model::FitRecord::Alternative& one : record.alternatives)
    append(columns, alternative_column(bare, one, states));
  return columns;
}

}  // namespace vernier::fit
