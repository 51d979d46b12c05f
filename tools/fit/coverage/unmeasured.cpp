// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/unmeasured.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/fit/coverage/alternatives.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/work_poses.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Standard deviations, squared, by which two explanations must differ on the readings to be
/// distinguished.
constexpr double kDistinct = 9;
/// The same for a coefficient to be tested: five. A less visible coefficient is covered by its
/// covariance.
constexpr double kPlain = 25;
/// A variable whose weighted standard deviation is above this share of its range has varied (a
/// uniform distribution has 0.29).
constexpr double kVaried = 0.15;
/// Largest range that counts for a rotary axis, deg: a turn by a third of a circle changes every direction
/// across its axis, whatever travel the file declares (a robot's joint: 360 to 720 deg).
constexpr double kMostTurn_deg = 120;
/// An axis that moved by less than this share of its travel was not measured: rule
/// `measured-range`.
constexpr double kMoved = 0.05;
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

/// How a variable is held: at one value, or on a line along another variable.
struct Line {
  double at = 0;
  std::optional<Variable> follows;
  double slope = 0, about = 0;
};

model::States held_on(const Line& line, const Variable& variable, const model::States& states) {
  model::States held = states;
  if (line.follows)
    variable.of(held) = line.at + line.slope * (line.follows->of(states) - line.about);
  else
    variable.of(held).setConstant(line.at);
  return held;
}

/// Returns the machine without one coefficient: at nominal; a table's column and a scale factor at
/// 0.
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

/// Returns the influence of a coefficient on the tool point at each state: 3 N, mm.
VectorXd effect(const model::Machine& machine, const model::Machine& other, const model::States& states) {
  const Eigen::Matrix3Xd off =
      model::forward(machine, states).position - model::forward(other, states).position;
  return off.reshaped();
}

class UnvariedFinder {
 public:
  explicit UnvariedFinder(const ReadingsBesideSetUp& readings)
      : machine_(readings.bare()), parameters_(machine_, {}), readings_(readings) {
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) add_axis(a);
    for (std::size_t i = 0; i < machine_.inputs.size(); ++i) add_input(i);
  }

  std::vector<model::FitRecord::Unvaried> run() {
    if (readings_.empty() || candidates_.empty()) return {};
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
    const model::Column& q = readings_.states().axis[a];
    if (q.size() == 0) return;
    const double measured = q.maxCoeff() - q.minCoeff();
    const auto work = model::work_range(machine_, a);
    const double range = work ? (*work)[1] - (*work)[0] : measured;
    const double counted = machine_.axes[a].rotary ? std::min(range, kMostTurn_deg) : range;
    if (measured > kMoved * range) candidates_.push_back({{true, a}, machine_.axes[a].name, counted});
  }

  void add_input(std::size_t i) {
    const model::Input& input = machine_.inputs[i];
    const model::Column& value = readings_.states().input[i];
    if (value.size() == 0 || input.hidden_axis) return;
    double range = std::max(value.maxCoeff() - value.minCoeff(), std::abs(value.mean() - input.reference));
    if (input.min && input.max) range = std::max(range, *input.max - *input.min);
    if (range > 0) candidates_.push_back({{false, i}, input.name, range});
  }

  void look_at(const Coefficient& coefficient) {
    const model::Machine other = without(machine_, parameters_, coefficient);
    const VectorXd all = effect(machine_, other, readings_.states());
    if (all.cwiseAbs().maxCoeff() <= kNothing_mm) return;
    const VectorXd own = readings_.of(all);
    if (own.squaredNorm() < kPlain || turns_where_read(other)) return;
    VectorXd mass(all.size() / 3);
    for (Index i = 0; i < mass.size(); ++i)
      mass[i] = readings_.check()[static_cast<std::size_t>(i)] == 0 ? all.segment<3>(3 * i).squaredNorm() : 0;
    if (!(mass.sum() > 0)) return;
    mass /= mass.sum();
    const double as_modelled = readings_.left().squaredNorm();
    for (const Candidate& one : candidates_) {
      if (is_table_of(coefficient, one)) continue;
      for (const Held& held : ways_to_hold(one, mass)) {
        const VectorXd alone =
            readings_.of(effect(machine_, other, held_on(held.line, one.variable, readings_.states())));
        if (alone.squaredNorm() < kDistinct) continue;
        const VectorXd data = readings_.left() + own;
        const VectorXd rest = data - alone * (alone.dot(data) / alone.squaredNorm());
        if (rest.squaredNorm() >= as_modelled + kDistinct) continue;
        if (moves_the_tool(one, other, held.line, mass))
          found_.push_back(
              {coefficient.name, one.name, held.line.at, held.follows, held.line.slope, held.line.about});
      }
    }
  }

  struct Held {
    Line line;
    std::string follows;  // name
  };

  /// mass: weight of each state, sum 1. A variable that did not vary is held at its mean.
  /// Otherwise it is held on the line along each other variable from which it hardly departed.
  std::vector<Held> ways_to_hold(const Candidate& one, const VectorXd& mass) const {
    const model::Column& value = one.variable.of(readings_.states());
    const double mean = mass.dot(value.matrix());
    const VectorXd off = (value - mean).matrix();
    const double variance = mass.dot(off.cwiseAbs2()), still = kVaried * one.range;
    if (variance <= still * still) return {{{mean, {}, 0, 0}, ""}};
    std::vector<Held> ways;
    for (const Candidate& other : candidates_) {
      if (&other == &one) continue;
      const model::Column& leading = other.variable.of(readings_.states());
      const double about = mass.dot(leading.matrix());
      const VectorXd lead = (leading - about).matrix();
      const double lead_variance = mass.dot(lead.cwiseAbs2());
      if (lead_variance <= std::pow(kVaried * other.range, 2)) continue;
      const double slope = mass.dot(off.cwiseProduct(lead)) / lead_variance;
      if (variance - slope * slope * lead_variance <= still * still)
        ways.push_back({{mean, other.variable, slope, about}, other.name});
    }
    return ways;
  }

  /// Is the variable the own axis of this station table? A table depends on it by definition.
  bool is_table_of(const Coefficient& coefficient, const Candidate& one) const {
    const model::Parameter& p = parameters_[coefficient.parameters.front()];
    return p.kind == model::ParameterKind::kStation && one.variable.is_axis &&
           machine_.tables[p.item].axis == one.variable.index;
  }

  /// Does the coefficient rotate the tool, and do the rows read rotations?
  bool turns_where_read(const model::Machine& other) const {
    if (!readings_.rotations()) return false;
    const model::Poses with = model::forward(machine_, readings_.states()),
                       less = model::forward(other, readings_.states());
    constexpr double kTurned_rad = 1e-9;  // above rounding
    for (std::size_t i = 0; i < readings_.states().count; ++i)
      if ((with.rotation[i] - less.rotation[i]).norm() > kTurned_rad) return true;
    return false;
  }

  /// Over its working volume, with inputs at their values when the effect was seen and at their
  /// references.
  bool moves_the_tool(const Candidate& one, const model::Machine& other, const Line& line,
                      const VectorXd& mass) const {
    std::vector<std::array<double, 2>> ranges;
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) {
      const model::Column& q = readings_.states().axis[a];
      ranges.push_back(model::work_range(machine_, a).value_or(std::array{q.minCoeff(), q.maxCoeff()}));
    }
    model::States states = model::poses_over(machine_, ranges).states;
    for (const bool at_reference : {false, true}) {
      for (std::size_t i = 0; i < machine_.inputs.size(); ++i)
        states.input[i].setConstant(at_reference ? machine_.inputs[i].reference
                                                 : mass.dot(readings_.states().input[i].matrix()));
      const VectorXd difference =
          effect(machine_, other, states) - effect(machine_, other, held_on(line, one.variable, states));
      if (difference.cwiseAbs().maxCoeff() > kNothing_mm) return true;
    }
    return false;
  }

  const model::Machine& machine_;
  model::ParameterSet parameters_;
  const ReadingsBesideSetUp& readings_;
  std::vector<Candidate> candidates_;
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
    if (model::is_set_up(p.kind)) continue;
    const std::string name = model::without_station(p.name);
    const auto same =
        std::find_if(list.begin(), list.end(), [&](const Coefficient& one) { return one.name == name; });
    if (same == list.end())
      list.push_back({name, {i}});
    else
      same->parameters.push_back(i);
  }
  return list;
}

std::vector<model::FitRecord::Unvaried> unvaried_dependences(const ReadingsBesideSetUp& readings) {
  return UnvariedFinder(readings).run();
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
    Line line{one.at, {}, one.slope, one.about};
    if (!one.follows.empty()) {
      line.follows = variable_named(bare, one.follows);
      if (!line.follows) continue;
    }
    const model::Machine other = without(bare, parameters, *coefficient);
    append(columns, effect(bare, other, states) - effect(bare, other, held_on(line, *variable, states)));
  }
  for (const model::FitRecord::Alternative& one : record.alternatives)
    append(columns, alternative_column(bare, one, states));
  return columns;
}

}  // namespace vernier::fit
