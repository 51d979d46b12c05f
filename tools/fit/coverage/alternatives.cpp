// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/alternatives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"

namespace vernier::fit {
namespace {

using Alternative = model::FitRecord::Alternative;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Increase of chi square at which an explanation is worse: three standard deviations.
constexpr double kWorse = 9;
/// Value of the spectral window of the positions above which a periodic term has an alias: 1 on a
/// grid, 1/sqrt(N) for random positions.
constexpr double kAliased = 0.7;
/// Frequency steps per period over the whole range. Minimum distance from the model's own
/// frequency, in these units.
constexpr double kFrequencySteps = 8, kOtherWave = 0.75;
/// A length of tool that distinguishes a turn from a shift, mm.
constexpr double kOtherTool_mm = 100;

/// machine: const or not, as the returned transform.
template <class Machine>
auto* transform_at(Machine& machine, const Alternative& place) {
  auto& branch = place.workpiece ? machine.workpiece : machine.tool;
  const auto found = std::find_if(branch.begin(), branch.end(), [&](const model::Transform& one) {
    return one.n == place.transform && one.kind == model::TransformKind::kSixDof;
  });
  return found == branch.end() ? nullptr : &*found;
}

/// Returns the motion of the tool point by one unit (mm, deg) of a degree of freedom: 3 N.
VectorXd response(const model::Machine& machine, const Alternative& place, std::size_t dof,
                  const model::States& states) {
  constexpr double kProbe = 1e-3;  // mm or deg: linear, and far above rounding
  model::Machine moved = machine;
  model::Transform* const transform = transform_at(moved, place);
  transform->dof[dof] = model::make_node(model::Op::kAdd, {transform->dof[dof], model::make_number(kProbe)});
  const Eigen::Matrix3Xd off =
      (model::forward(moved, states).position - model::forward(machine, states).position) / kProbe;
  return off.reshaped();
}

/// Returns the part of a degree of freedom that its free statics cause: its value minus its value
/// with them at nominal.
VectorXd term(const model::Machine& machine, const Alternative& place, const model::States& states) {
  model::Machine nominal = machine;
  for (model::Static& item : nominal.statics)
    if (!item.hidden) item.value = item.nominal.value_or(item.value);
  const model::Expr& expr = *transform_at(machine, place)->dof[place.dof];
  return (model::evaluate(machine, expr, states) - model::evaluate(nominal, expr, states)).matrix();
}

VectorXd times_rows(VectorXd points, const VectorXd& factor) {
  for (Index i = 0; i < factor.size(); ++i) points.segment<3>(3 * i) *= factor[i];
  return points;
}

bool has_free_static(const model::Machine& machine, const model::Expr& expr) {
  return model::any_node(expr, [&](const model::Expr& node) {
    return node.op == model::Op::kSymbol && node.symbol.kind == model::SymbolKind::kStatic &&
           !machine.statics[node.symbol.index].hidden;
  });
}

bool waves_along(const model::Expr& expr, std::size_t axis) {
  return model::any_node(expr, [&](const model::Expr& node) {
    return (node.op == model::Op::kSin || node.op == model::Op::kCos) &&
           model::has_symbol(node, {model::SymbolKind::kAxis, axis});
  });
}

class Finder {
 public:
  explicit Finder(const ReadingsBesideSetUp& readings) : bare_(readings.bare()), readings_(readings) {}

  std::vector<Alternative> run() {
    if (readings_.empty()) return {};
    for (const bool workpiece : {false, true})
      for (const model::Transform& one : workpiece ? bare_.workpiece : bare_.tool)
        for (std::size_t d = 0; one.kind == model::TransformKind::kSixDof && d < 6; ++d)
          if (has_free_static(bare_, *one.dof[d])) look_at({workpiece, one.n, d, "", 0, {}}, *one.dof[d]);
    return std::move(found_);
  }

 private:
  void look_at(const Alternative& place, const model::Expr& expr) {
    const VectorXd own = term(bare_, place, readings_.states());
    if (own.size() == 0 || own.cwiseAbs().maxCoeff() <= 0) return;
    for (std::size_t axis = 0; axis < bare_.axes.size(); ++axis)
      if (waves_along(expr, axis)) look_for_wave(place, axis, own);
    if (place.dof >= 3 && !readings_.rotations()) look_for_shift(place, own);
  }

  /// Returns the frequency of the term along the axis, from its sign changes; 1/unit.
  double frequency(const Alternative& place, std::size_t axis, double low, double range) const {
    constexpr Index kPoints = 4096;  // over the range: periods down to 1/500 of it
    model::States line = model::select_states(readings_.states(), std::vector<std::size_t>(kPoints, 0));
    line.axis[axis] = Eigen::ArrayXd::LinSpaced(kPoints, low, low + range);
    VectorXd value = term(bare_, place, line);
    value.array() -= value.mean();
    int changes = 0;
    for (Index i = 1; i < kPoints; ++i) changes += value[i] * value[i - 1] < 0 ? 1 : 0;
    return changes / (2 * range);
  }

  void look_for_wave(Alternative place, std::size_t axis, const VectorXd& own) {
    const model::Column& q = readings_.states().axis[axis];
    const double low = q.minCoeff(), range = q.maxCoeff() - low;
    if (!(range > 0)) return;
    const double own_frequency = frequency(place, axis, low, range), step = 1 / (kFrequencySteps * range);
    constexpr Index kMostPositions = 2000;  // of the spectral window
    const Eigen::ArrayXd window = q(Eigen::seq(Index{0}, q.size() - 1, 1 + q.size() / kMostPositions)) - low;
    const VectorXd unit = response(bare_, place, place.dof, readings_.states());
    const VectorXd data = readings_.left() + readings_.of(times_rows(unit, own));
    const double limit = readings_.left().squaredNorm() + kWorse;
    std::vector<Wave> waves;
    for (double shift = step; shift < 2 * own_frequency; shift += step) {
      const Eigen::ArrayXd phase = 2 * std::numbers::pi * shift * window;
      if (std::hypot(phase.cos().mean(), phase.sin().mean()) < kAliased) continue;
      for (int k = -4; k <= 4; ++k) {
        const double frequency = std::abs(own_frequency - shift) + 0.5 * k * step;
        if (frequency < step || frequency > own_frequency - kOtherWave / range) continue;
        if (Wave wave = fitted_wave(unit, q, frequency, data); wave.rest < limit) waves.push_back(wave);
      }
    }
    if (waves.empty()) return;
    // If there are several, the longest period is used. It cannot be mistaken for a motion between
    // the targets.
    const double slowest = std::min_element(waves.begin(), waves.end(), [](const Wave& a, const Wave& b) {
                             return a.frequency < b.frequency;
                           })->frequency;
    std::erase_if(waves, [&](const Wave& one) { return one.frequency > slowest + 4 * step; });
    const Wave& best = *std::min_element(waves.begin(), waves.end(),
                                         [](const Wave& a, const Wave& b) { return a.rest < b.rest; });
    place.axis = bare_.axes[axis].name;
    place.period = 1 / best.frequency;
    place.size = {best.sine, best.cosine, 0};
    found_.push_back(place);
  }

  struct Wave {
    double frequency = 0, sine = 0, cosine = 0, rest = 0;  // rest: chi square
  };

  Wave fitted_wave(const VectorXd& unit, const model::Column& q, double frequency,
                   const VectorXd& data) const {
    const Eigen::ArrayXd turn = 2 * std::numbers::pi * frequency * q;
    MatrixXd waves(data.size(), 2);
    waves << readings_.of(times_rows(unit, turn.sin().matrix())),
        readings_.of(times_rows(unit, turn.cos().matrix()));
    const VectorXd size = maths::least_norm(waves, data);
    return {frequency, size[0], size[1], (data - waves * size).squaredNorm()};
  }

  void look_for_shift(Alternative place, const VectorXd& own) {
    const VectorXd turned =
        readings_.of(times_rows(response(bare_, place, place.dof, readings_.states()), own));
    if (turned.squaredNorm() < kWorse) return;  // not seen: the covariance shows that
    const VectorXd data = readings_.left() + turned;
    MatrixXd shifts(data.size(), 3);
    for (Index d = 0; d < 3; ++d)
      shifts.col(d) = readings_.of(
          times_rows(response(bare_, place, static_cast<std::size_t>(d), readings_.states()), own));
    const VectorXd size = maths::least_norm(shifts, data);
    if ((data - shifts * size).squaredNorm() >= readings_.left().squaredNorm() + kWorse) return;
    place.size = {size[0], size[1], size[2]};
    // If the effect is the same with every tool, there is nothing to distinguish.
    for (const std::array<double, 3>& tool :
         {std::array{kOtherTool_mm, 0.0, 0.0}, {0.0, 0.0, kOtherTool_mm}}) {
      const model::Machine other = model::with_tool(bare_, tool);
      if (alternative_column(other, place, readings_.states()).cwiseAbs().maxCoeff() <= kNothing_mm) continue;
      found_.push_back(place);
      return;
    }
  }

  const model::Machine& bare_;
  const ReadingsBesideSetUp& readings_;
  std::vector<Alternative> found_;
};

}  // namespace

std::vector<Alternative> find_alternatives(const ReadingsBesideSetUp& readings) {
  return Finder(readings).run();
}

VectorXd alternative_column(const model::Machine& machine, const Alternative& alternative,
                            const model::States& states) {
  if (transform_at(machine, alternative) == nullptr)
    return VectorXd::Zero(3 * static_cast<Index>(states.count));
  const VectorXd own = term(machine, alternative, states);
  const VectorXd as_modelled = times_rows(response(machine, alternative, alternative.dof, states), own);
  if (alternative.axis.empty()) {
    VectorXd shifted = VectorXd::Zero(as_modelled.size());
    for (std::size_t d = 0; d < 3; ++d)
      shifted += times_rows(response(machine, alternative, d, states), alternative.size[d] * own);
    return as_modelled - shifted;
  }
  const auto axis = machine.find_axis(alternative.axis);
  if (!axis) return VectorXd::Zero(as_modelled.size());
  const Eigen::ArrayXd turn = 2 * std::numbers::pi / alternative.period * states.axis[*axis];
  const VectorXd wave = (alternative.size[0] * turn.sin() + alternative.size[1] * turn.cos()).matrix();
  return as_modelled - times_rows(response(machine, alternative, alternative.dof, states), wave);
}

}  // namespace vernier::fit
