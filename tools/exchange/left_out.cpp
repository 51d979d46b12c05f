// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/left_out.h"

#include <fmt/format.h>

#include <functional>
#include <random>
#include <utility>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"

namespace vernier::exchange {
namespace {

using Eigen::Index;
constexpr std::size_t kSamples = 60;  // poses at which two terms are compared
constexpr unsigned long kSeed = 1;

/// Where axes without a range and other quantities are tried.
constexpr double kReach_mm_or_deg = 100, kInput = 10, kSpeed = 200, kSince_mm = 5, kTime_s = 3600;

class Sampler {
 public:
  Sampler(const model::Machine& machine, std::size_t axis, const model::States& at)
      : machine_(machine),
        axis_(axis),
        base_(model::select_states(at, std::vector<std::size_t>(kSamples, 0))),
        random_(kSeed) {
    fill_axis(base_, axis_);
    for (Index i = 0; i < base_.direction[axis_].size(); ++i) base_.direction[axis_][i] = i % 2 == 0 ? 1 : -1;
  }

  /// The largest change of the axis' offset when `vary` has changed the states.
  double change_um(const std::function<void(model::States&)>& vary) {
    model::States varied = base_;
    vary(varied);
    return 1000 * (offset(varied) - offset(base_)).abs().maxCoeff();
  }

  void fill_axis(model::States& states, std::size_t axis) {
    const model::Axis& one = machine_.axes[axis];
    fill(states.axis[axis], one.min.value_or(-kReach_mm_or_deg), one.max.value_or(kReach_mm_or_deg));
  }
  void fill(model::Column& column, double low, double high) {
    std::uniform_real_distribution<double> value(low, high);
    for (Index i = 0; i < column.size(); ++i) column[i] = value(random_);
  }
  void signs(model::Column& column) {
    for (Index i = 0; i < column.size(); ++i) column[i] = random_() % 2 == 0 ? 1 : -1;
  }

 private:
  model::Column offset(const model::States& states) const {
    return kinematics::first_order_offset(machine_, states)[axis_];
  }

  const model::Machine& machine_;
  std::size_t axis_;
  model::States base_;
  std::mt19937_64 random_;
};

}  // namespace

std::vector<LeftOut> beyond_own_axis(const model::Machine& machine, std::size_t axis,
                                     const model::States& at) {
  Sampler sampler(machine, axis, at);
  std::vector<LeftOut> result;
  const auto look = [&](const std::string& what, const std::function<void(model::States&)>& vary,
                        bool other_axis = false, bool of_input = false) {
    const double um = sampler.change_um(vary);
    if (um > kNothing_um)
      result.push_back(
          {"the error of " + machine.axes[axis].name + " depends on " + what, um, other_axis, of_input});
  };
  for (std::size_t other = 0; other < machine.axes.size(); ++other) {
    if (other == axis) continue;
    const std::string& name = machine.axes[other].name;
    look(
        "the position of " + name, [&](model::States& s) { sampler.fill_axis(s, other); }, true);
    look(
        "the direction of motion of " + name, [&](model::States& s) { sampler.signs(s.direction[other]); },
        true);
  }
  for (std::size_t k = 0; k < machine.inputs.size(); ++k) {
    const model::Input& input = machine.inputs[k];
    look(
        "input " + input.name,
        [&](model::States& s) {
          sampler.fill(s.input[k], input.min.value_or(input.reference - kInput),
                       input.max.value_or(input.reference + kInput));
        },
        false, true);
  }
  look("speed, acceleration, feed or path curvature", [&](model::States& s) {
    for (model::Column& v : s.velocity) sampler.fill(v, -kSpeed, kSpeed);
    for (model::Column& a : s.acceleration) sampler.fill(a, -kSpeed, kSpeed);
    sampler.fill(s.feed, 0, 60 * kSpeed);
    sampler.fill(s.curvature, 0, 0.1);
  });
  look("the travel since the last reversal", [&](model::States& s) {
    for (model::Column& since : s.since) sampler.fill(since, 0, kSince_mm);
  });
  look("time", [&](model::States& s) { s.time = model::Column::LinSpaced(s.time.size(), 0, kTime_s); });
  return result;
}

std::vector<LeftOut> beyond_straight_axes(const model::Machine& machine, const model::States& at,
                                          bool heights, const std::vector<double>& lost_motion) {
  constexpr Index kPositions = 401;  // more than four a period of the usual screws
  std::vector<LeftOut> result;
  const auto add = [&](std::string what, double um) {
    if (um > kNothing_um) result.push_back({std::move(what), um});
  };
  const auto positions_of = [&](std::size_t moved) {
    model::States states = model::select_states(at, std::vector<std::size_t>(kPositions, 0));
    const model::Axis& one = machine.axes[moved];
    states.axis[moved] = model::Column::LinSpaced(kPositions, one.min.value_or(-kReach_mm_or_deg),
                                                  one.max.value_or(kReach_mm_or_deg));
    for (model::Column& direction : states.direction) direction.setConstant(1);
    return states;
  };
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const std::string& name = machine.axes[axis].name;
    for (std::size_t moved = 0; moved < machine.axes.size(); ++moved) {
      model::States states = positions_of(moved);
      const model::Column forth = kinematics::first_order_offset(machine, states)[axis];
      if (moved == axis) {
        states.direction[axis].setConstant(-1);
        const model::Column back = kinematics::first_order_offset(machine, states)[axis];
        const double held = lost_motion.empty() ? 0 : lost_motion[axis];
        add((held > 0 ? "change along the axis of the reversal error of " : "reversal error (backlash) of ") +
                name,
            maths::kUmPerMm * (forth - back - held).abs().maxCoeff());
      }
      if (heights && name == "Z" && moved != axis) continue;
      Eigen::MatrixXd line(kPositions, 2);
      line.col(0).setOnes();
      line.col(1) = states.axis[moved].matrix();
      const Eigen::VectorXd rest =
          forth.matrix() - line * maths::least_norm(line, Eigen::VectorXd(forth.matrix()));
      const double um = maths::kUmPerMm * rest.cwiseAbs().maxCoeff();
      if (moved == axis)
        add("positioning error of " + name + " that is no scale (lead error, cyclic error)", um);
      else
        add("error along " + name + " over the travel of " + machine.axes[moved].name +
                " that is no squareness (straightness)",
            um);
    }
  }
  return result;
}

std::vector<LeftOut> beyond_tables(const model::Machine& machine, const model::States& at) {
  model::Machine rest = machine;
  for (model::Table& table : rest.tables)
    for (model::Station& station : table.stations) station.value.fill(0);
  std::mt19937_64 random(kSeed);
  model::States states = model::select_states(at, std::vector<std::size_t>(kSamples, 0));
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const model::Axis& axis = machine.axes[a];
    std::uniform_real_distribution<double> value(axis.min.value_or(-kReach_mm_or_deg),
                                                 axis.max.value_or(kReach_mm_or_deg));
    for (Index i = 0; i < states.axis[a].size(); ++i) {
      states.axis[a][i] = value(random);
      states.direction[a][i] = random() % 2 == 0 ? 1 : -1;
    }
  }
  const double um = 1000 * model::deviation(rest, states).colwise().norm().maxCoeff();
  if (!(um > kNothing_um)) return {};
  return {{"errors outside the tables (position errors, scale factors, reversal, other terms)", um}};
}

void refuse(const model::Machine& machine, const std::string& format, const std::vector<LeftOut>& left_out,
            bool allowed) {
  if (left_out.empty() || allowed) return;
  throw text::InputError({machine.file, 0}, "", left_out_in_words(format, left_out));
}

std::string left_out_in_words(const std::string& format, const std::vector<LeftOut>& left_out) {
  std::string text;
  for (const LeftOut& one : left_out) text += fmt::format("\n  {}: up to {:.4g} um", one.what, one.um);
  return fmt::format(
      "{} cannot express all errors of this machine; with --leave-out the command writes the other errors:{}",
      format, text);
}

}  // namespace vernier::exchange
