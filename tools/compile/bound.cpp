// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "tools/compile/symbolic/calculus.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/compile/symbolic/ranges.h"
#include "tools/compile/walk.h"
#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

using Registers = std::set<std::uint32_t>;

/// Returns the gain from each register's error to the register `output`: reverse accumulation of the gains.
/// Registers that are given have no error, because later registers refer to their actual value.
std::vector<double> gains_to(const LoweredProgram& p, std::uint32_t output) {
  std::vector<double> gain(p.registers.size(), 0);
  gain[output] = 1;
  for (std::size_t i = p.registers.size(); i-- > 0;) {
    if (i != output && p.registers[i].given) gain[i] = 0;
    for (const Register::Use& use : p.registers[i].uses) gain[use.from] += gain[i] * use.gain;
  }
  return gain;
}

/// Error of a register against the exact function of the registers `given`. Their own errors do not count.
double error_from(const LoweredProgram& p, std::uint32_t target, const Registers& given) {
  std::vector<double> gain(p.registers.size(), 0);
  gain[target] = 1;
  double error = 0;
  for (std::size_t i = target + 1; i-- > 0;) {
    if (gain[i] == 0 || given.contains(static_cast<std::uint32_t>(i))) continue;
    if (i != target && p.registers[i].given) continue;
    error += gain[i] * p.registers[i].own_error;
    for (const Register::Use& use : p.registers[i].uses) gain[use.from] += gain[i] * use.gain;
  }
  return error;
}

/// Number of intervals of the determinant. With four times as many, the bound of the robot of bound_check is
/// the same in four digits.
constexpr int kParts = 64;

/// Bound of the residual |J x - deviation| of the fixed-point least-squares solution, by matrix norms:
/// rounding in J' w, w, adj(J J'), det, J J' and J itself, each multiplied by the gain of the later steps.
/// Intervals would multiply the errors by the inverse's largest entries. The residual keeps the dependence
/// between the parts. The gains depend on the pose only through the determinant D of J J': with the trace t
/// of J J', |(J J')^-1| <= (t/2)^2 / D for three directions. The bound is therefore a function of an interval
/// of D, and the largest of several intervals is a bound for all poses.
class LeastSquaresBound {
 public:
  LeastSquaresBound(const Derivation& derivation, const LoweredProgram& program);

  /// Contributions at the poses whose determinant is in `determinant`. size_mm: |deviation| on the right
  /// side.
  std::vector<Contribution> terms(const Interval& determinant, double size_mm) const;
  /// Upper limit of |K' (K K')^-1|: motion of all axes, each multiplied by its lever, for a deviation of the
  /// length 1.
  double gain(const Interval& determinant) const;
  /// Intervals of the determinant, from the floor to its largest value, in a geometric series.
  std::vector<Interval> parts() const;

 private:
  std::pair<double, NodeId> bare(NodeId id) const;
  std::optional<std::uint32_t> place(NodeId id) const;
  void insert(Registers& set, NodeId id) const;
  Registers registers(const std::vector<std::vector<NodeId>>& matrix) const;
  double error_of(NodeId id, const Registers& given) const;
  double error_of(const std::vector<std::vector<NodeId>>& matrix, const Registers& given) const;
  void find_weights(const Registers& given);
  void find_deviation();

  const Graph& g_;
  const LeastSquares& least_;
  const std::vector<AxisDeviation>& outputs_;
  const LoweredProgram& p_;
  std::vector<Contribution> deviation_;  // errors of the deviation's own registers, mm in place of um
  double reciprocal_ = 0, determinant_ = 0, adjugate_ = 0, square_ = 0, jacobian_ = 0, solution_ = 0;
  double weights_ = 0;  // error of the weights beside that of the sums
  double sums_ = 0;     // error of adj(K K') times the deviation, which is multiplied by the reciprocal
};

LeastSquaresBound::LeastSquaresBound(const Derivation& d, const LoweredProgram& p)
    : g_(d.graph), least_(*d.least_squares), outputs_(d.outputs), p_(p) {
  const Registers jacobian = registers(least_.jacobian), square = registers(least_.square);
  jacobian_ = error_of(least_.jacobian, {});
  square_ = error_of(least_.square, jacobian);
  adjugate_ = error_of(least_.adjugate, square);
  determinant_ = error_of(least_.determinant, square);
  if (const auto reciprocal = place(least_.reciprocal)) reciprocal_ = p_.registers[*reciprocal].own_error;
  find_deviation();
  Registers given = registers(least_.adjugate), last = jacobian;
  for (const NodeId id : least_.deviation) insert(given, id);
  insert(given, least_.reciprocal);
  find_weights(given);
  for (const NodeId id : least_.weights) insert(last, id);
  double solution = 0;
  for (std::size_t k = 0; k < outputs_.size(); ++k)
    solution += std::pow(least_.lever[k] * error_of(outputs_[k].value, last), 2);
  solution_ = std::sqrt(solution);
}

std::vector<Contribution> LeastSquaresBound::terms(const Interval& determinant, double size) const {
  const double floor = std::max(determinant.low, least_.floor);
  std::vector<Contribution> terms;
  const auto add = [&](const std::string& name, const std::string& source, double mm) {
    if (mm > 0) terms.push_back({name, source, mm * maths::kUmPerMm});
  };
  // The solution converts a right side of the nearest point back into a length.
  const double back = least_.nearest ? gain(determinant) : 1;
  for (const Contribution& c : deviation_) add(c.name, c.source, back * c.bound_um);
  add("reciprocal of the determinant", "function", reciprocal_ * determinant.high * size);
  add("determinant", "rounding", determinant_ / floor * size);
  add("adjugate", "rounding", least_.trace * adjugate_ / floor * size);
  add("J J'", "rounding", square_ * least_.largest / floor * size);
  // For the nearest point the columns are used twice: their rotation couples the components across them.
  add("J", "function", (least_.nearest ? 2 : 1) * jacobian_ * gain(determinant) * size);
  // J J' w, or J w if the weights are the motions.
  add("weights", "rounding",
      (least_.nearest ? std::sqrt(least_.trace) : least_.trace) * (weights_ + sums_ / floor));
  add("solution", "rounding", std::sqrt(least_.trace) * solution_);
  return terms;
}

double LeastSquaresBound::gain(const Interval& determinant) const {
  const double floor = std::max(determinant.low, least_.floor);
  // least_.gain is that of the determinant least_.floor.
  return least_.gain * std::sqrt(least_.floor / floor);
}

std::vector<Interval> LeastSquaresBound::parts() const {
  const double low = least_.floor, high = g_[least_.determinant].range.high;
  if (!(low > 0) || high <= low) return {{low, std::max(low, high)}};
  const double ratio = std::pow(high / low, 1.0 / kParts);
  std::vector<Interval> parts;
  for (double from = low; parts.size() < kParts; from *= ratio) parts.push_back({from, from * ratio});
  parts.back().high = std::max(parts.back().high, high);
  return parts;
}

// A product moves the coefficient out of a scaled node: the register is that of the inner node.
std::pair<double, NodeId> LeastSquaresBound::bare(NodeId id) const {
  const Node& n = g_[id];
  if (!p_.register_of.contains(id) && n.kind == NodeKind::kSum && n.terms.size() == 1 && n.number == 0)
    return {std::abs(n.terms[0].coefficient), n.terms[0].node};
  return {1, id};
}

std::optional<std::uint32_t> LeastSquaresBound::place(NodeId id) const {
  const auto found = p_.register_of.find(bare(id).second);
  if (found == p_.register_of.end()) return std::nullopt;
  return found->second;
}

void LeastSquaresBound::insert(Registers& set, NodeId id) const {
  if (const auto at = place(id)) set.insert(*at);
}

Registers LeastSquaresBound::registers(const std::vector<std::vector<NodeId>>& matrix) const {
  Registers set;
  for (const auto& row : matrix)
    for (const NodeId id : row) insert(set, id);
  return set;
}

double LeastSquaresBound::error_of(NodeId id, const Registers& given) const {
  const auto at = place(id);
  return at ? bare(id).first * error_from(p_, *at, given) : 0;
}

/// Root of the sum of squares over a matrix.
double LeastSquaresBound::error_of(const std::vector<std::vector<NodeId>>& matrix,
                                   const Registers& given) const {
  double sum = 0;
  for (const auto& row : matrix)
    for (const NodeId id : row) sum += std::pow(error_of(id, given), 2);
  return std::sqrt(sum);
}

/// A weight is the reciprocal of the determinant times a sum. The error of the sum counts with the reciprocal
/// at the pose, which is far below the largest at most poses.
void LeastSquaresBound::find_weights(const Registers& given) {
  double weights = 0, sums = 0;
  for (const NodeId id : least_.weights) {
    const Node& n = g_[id];
    const bool product = n.kind == NodeKind::kProduct && n.args[0] != n.args[1];
    const auto other = product && n.args[0] == least_.reciprocal   ? place(n.args[1])
                       : product && n.args[1] == least_.reciprocal ? place(n.args[0])
                                                                   : std::nullopt;
    if (!other || !place(id)) {
      weights += std::pow(error_of(id, given), 2);
      continue;
    }
    const NodeId sum = n.args[0] == least_.reciprocal ? n.args[1] : n.args[0];
    Registers all = given;
    all.insert(*other);
    weights += std::pow(error_of(id, all), 2);
    sums += std::pow(bare(id).first * error_of(sum, given), 2);
  }
  weights_ = std::sqrt(weights);
  sums_ = std::sqrt(sums);
}

/// The errors of the deviation's own registers, one term per register.
void LeastSquaresBound::find_deviation() {
  std::vector<double> square(p_.registers.size(), 0);
  for (const NodeId id : least_.deviation) {
    const auto at = place(id);
    if (!at) continue;
    const std::vector<double> gain = gains_to(p_, *at);
    for (std::size_t r = 0; r < square.size(); ++r)
      square[r] += std::pow(bare(id).first * gain[r] * p_.registers[r].own_error, 2);
  }
  for (std::size_t r = 0; r < square.size(); ++r)
    if (square[r] > 0)
      deviation_.push_back({p_.registers[r].name, name_of(p_.registers[r].source), std::sqrt(square[r])});
}

/// Number of outputs before those that correct the direction.
std::size_t linear_outputs(const Derivation& d) {
  return d.outputs.size() - (d.orientation ? d.orientation->axes.size() : 0);
}

/// Number of boxes for the bound of one component of the sum of all omitted parts.
constexpr std::size_t kBoxesOfSum = 2048;

/// Bounds of the components of the sum of all omitted parts, mm. The parts have their largest values at
/// different poses, and partly cancel.
std::array<double, 3> omitted_together(const model::Machine& machine, const Derivation& d) {
  if (d.neglected.empty()) return {0, 0, 0};
  Graph g = d.graph;
  NodeVector sum;
  sum.fill(g.constant(0));
  double slack_mm = 0;
  for (const Neglected& n : d.neglected) {
    const NodeVector part = omitted_part(g, n);
    for (std::size_t c = 0; c < 3; ++c) sum[c] = g.add(sum[c], part[c]);
    slack_mm += n.slack_mm;
  }
  const TableRange range = [&](const Node& n, const Interval& position) {
    return table_range(*machine.table_of(n.index[0]), n.index[1], position, n.range);
  };
  std::array<double, 3> along{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double low = lower_bound_of(g, sum[c], kBoxesOfSum, range),
                 high = -lower_bound_of(g, g.scale(-1, sum[c]), kBoxesOfSum, range);
    along[c] = std::max(std::abs(low), std::abs(high)) + slack_mm;
  }
  return along;
}

double error_along(const AxisDeviation& out, const Neglected& n) {
  double along = 0;
  for (std::size_t c = 0; c < 3; ++c) along += out.row[c] * n.along_mm[c];
  return std::min(along, n.bound_mm * out.row_norm);
}

double& share_of(OutputBound& bound, const std::string& source) {
  if (source == "table") return bound.table_um;
  if (source == "function") return bound.function_um;
  if (source == "input") return bound.input_um;
  if (source == "lag") return bound.lag_um;
  if (source == "linearisation") return bound.linearisation_um;
  return bound.rounding_um;
}

void sort_terms(OutputBound& bound) {
  for (const Contribution& c : bound.contributions) bound.total_um += c.bound_um;
  std::stable_sort(bound.contributions.begin(), bound.contributions.end(),
                   [](const auto& a, const auto& b) { return a.bound_um > b.bound_um; });
}

/// Contributions of the omitted parts. Their sum is at most `together`; the bound of each is reduced by the
/// same factor.
void add_neglected(std::vector<Contribution>& terms, const std::vector<std::pair<std::string, double>>& parts,
                   double together) {
  double apart = 0;
  for (const auto& [what, size] : parts) apart += size;
  const double factor = apart > together ? together / apart : 1;
  for (const auto& [what, size] : parts)
    if (size > 0) terms.push_back({what, "linearisation", factor * size});
}

OutputBound bound_of(const model::Machine& machine, const Derivation& d, const LoweredProgram& p,
                     const std::array<double, 3>& omitted_mm, std::size_t i) {
  const Output& out = p.outputs[i];
  const Register& result = p.registers[out.source];
  OutputBound bound;
  bound.axis = machine.axes[out.axis].name;
  const bool rotary = machine.axes[out.axis].rotary;
  const double um_per_unit = maths::kUmPerMm * (rotary ? d.outputs[i].lever : 1);
  bound.deviation_um = (d.before.empty() ? result.range.magnitude() : d.before[0].range[i]) * um_per_unit;
  const auto blame = [&](const std::string& name, const std::string& source, double units) {
    if (units <= 0) return;
    bound.contributions.push_back({name, source, units * um_per_unit});
    share_of(bound, source) += units * um_per_unit;
  };
  const std::vector<double> gain = gains_to(p, out.source);
  double first_order = 0;
  for (std::size_t r = 0; r < p.registers.size(); ++r) {
    blame(p.registers[r].name, name_of(p.registers[r].source), gain[r] * p.registers[r].own_error);
    first_order += gain[r] * p.registers[r].own_error;
  }
  blame("products of errors", "rounding", result.error - first_order);
  const double factor = std::ldexp(out.multiplier, -static_cast<int>(out.shift)),
               counts_per_unit = rotary ? static_cast<double>(kTurnCounts) / 360 : 1e6,
               exact = std::ldexp(counts_per_unit, -result.fraction_bits);
  blame(rotary ? "output in 2^-32 turn" : "output in nm", "rounding",
        0.5 / counts_per_unit + result.range.magnitude() * std::abs(factor / exact - 1));
  for (std::size_t k = linear_outputs(d); k < d.outputs.size(); ++k)
    blame("counts of " + machine.axes[d.outputs[k].axis].name, "rounding",
          0.5 * d.outputs[k].lever * 360 / static_cast<double>(kTurnCounts) * d.outputs[i].row_norm);
  std::vector<std::pair<std::string, double>> parts;
  for (const Neglected& n : d.neglected)
    parts.emplace_back(n.what, error_along(d.outputs[i], n) * um_per_unit);
  double together = 0;
  for (std::size_t c = 0; c < 3; ++c) together += d.outputs[i].row[c] * omitted_mm[c] * um_per_unit;
  std::vector<Contribution> neglected;
  add_neglected(neglected, parts, together);
  for (const Contribution& c : neglected) blame(c.name, c.source, c.bound_um / um_per_unit);
  sort_terms(bound);
  return bound;
}

OutputBound bound_of_direction(const model::Machine& machine, const Derivation& d, std::size_t i) {
  OutputBound bound;
  bound.axis = machine.axes[d.outputs[i].axis].name;
  bound.deviation_deg = d.graph[d.outputs[i].value].range.magnitude();
  return bound;
}

/// Largest correction of each linear output, axis units.
std::vector<double> largest_corrections(const Derivation& d) {
  std::vector<double> largest;
  for (std::size_t k = 0; k < linear_outputs(d); ++k) {
    const double range =
        d.before.empty() ? d.graph[d.outputs[k].value].range.magnitude() : d.before[0].range[k];
    largest.push_back(std::min(range, d.spread_mm * d.outputs[k].row_norm));
  }
  return largest;
}

std::optional<NodeId> position_of(const Graph& graph, std::size_t axis) {
  std::optional<NodeId> channel;
  for (NodeId id = 0; id < graph.size(); ++id)
    if (graph[id].kind == NodeKind::kChannel && graph[id].channel == ChannelKind::kPosition &&
        graph[id].index[0] == axis)
      channel = id;
  return channel;
}

/// Returns bounds of the change of a vector's components with an axis. Corrections of direction
/// are constant.
std::array<double, 3> slopes_of(const Derivation& d, const NodeVector& v, std::size_t axis) {
  const auto channel = position_of(d.graph, axis);
  if (!channel) return {0, 0, 0};
  Slopes by_axis(d.graph, *channel, d.table_slopes);
  if (d.orientation) {
    for (const NodeId id : d.orientation->values) by_axis.hold(id);
    for (const Evaluation& e : d.before)
      for (const NodeId id : e.orientation) by_axis.hold(id);
  }
  return {by_axis.of(v[0]).magnitude(), by_axis.of(v[1]).magnitude(), by_axis.of(v[2]).magnitude()};
}

double norm_of(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

double turning_of(const Derivation& d, std::size_t axis) {
  const auto found = d.turning.find(axis);
  return found == d.turning.end() ? 0 : found->second;
}

/// How the motion of axis j bends with axis k: mm for one unit of both. `first`: from the command on, which
/// halves the error of a straight line. `later`: between two positions near the command.
struct Bend {
  double first = 0, later = 0;
};

Bend bend_of(const Derivation& d, std::size_t j, std::size_t k) {
  const std::size_t axis = d.outputs[k].axis;
  const double turning = turning_of(d, axis);
  Bend result;
  for (const AxisColumn& column : d.columns)
    if (column.axis == d.outputs[j].axis) {
      const double bend = norm_of(slopes_of(d, column.direction, axis));
      // The frame's own rotation acts on one side only, so it counts for both.
      result.first += 0.5 * bend + turning * column.norm * (j == k ? 0.5 : 1);
      result.later += bend + 2 * turning * column.norm;
    }
  return result;
}

/// Returns the remaining error of a step of Newton's iteration at the tool point, mm. Moving by
/// `step`, within `reach` of the command, changes deviation(q) and bends the nominal motion. A
/// first step begins at the command (step = reach), which halves the error of a straight line.
double left_by_step(const Derivation& d, const std::vector<double>& reach, const std::vector<double>& step,
                    bool first) {
  std::array<double, 3> slope{};
  double turned = 0, bent = 0;
  for (std::size_t k = 0; k < step.size(); ++k) {
    const std::size_t axis = d.outputs[k].axis;
    const std::array<double, 3> own = slopes_of(d, d.deviation, axis);
    for (std::size_t i = 0; i < 3; ++i) slope[i] += own[i] * step[k];
    turned += turning_of(d, axis) * step[k] * d.spread_mm;
    for (std::size_t j = 0; j < step.size(); ++j) {
      const Bend bend = bend_of(d, j, k);
      bent += (first ? bend.first : bend.later) * reach[k] * step[j];
    }
  }
  return norm_of(slope) + turned + bent;
}

double sum_um(const std::vector<Contribution>& terms) {
  double sum = 0;
  for (const Contribution& c : terms) sum += c.bound_um;
  return sum;
}

/// Newton's steps of a least-squares correction. The motions are those of all axes, each multiplied by its
/// lever, as one vector, mm. A sum over the axes is at most a root of a sum of squares (Cauchy, Schwarz).
class LeastSteps {
 public:
  explicit LeastSteps(const Derivation& d) {
    double slope = 0, turned = 0, first = 0, later = 0;
    const std::vector<double>& lever = d.least_squares->lever;
    for (std::size_t k = 0; k < d.outputs.size(); ++k) {
      const std::size_t axis = d.outputs[k].axis;
      slope += std::pow(norm_of(slopes_of(d, d.deviation, axis)) / lever[k], 2);
      turned += std::pow(turning_of(d, axis) * d.spread_mm / lever[k], 2);
      for (std::size_t j = 0; j < d.outputs.size(); ++j) {
        const Bend bend = bend_of(d, j, k);
        first += std::pow(bend.first / (lever[j] * lever[k]), 2);
        later += std::pow(bend.later / (lever[j] * lever[k]), 2);
      }
    }
    slope_ = std::sqrt(slope) + std::sqrt(turned);
    first_ = std::sqrt(first);
    later_ = std::sqrt(later);
  }
  /// As left_by_step.
  double left(double reach_mm, double step_mm, bool first) const {
    return slope_ * step_mm + (first ? first_ : later_) * reach_mm * step_mm;
  }

 private:
  double slope_ = 0, first_ = 0, later_ = 0;
};

/// Upper limit of the deviation that the last evaluation corrects, mm, at the poses of a part of the
/// determinant's range. Far from singular poses the correction is short, so that little remains of it.
double last_size(const Derivation& d, const LeastSquaresBound& least, const LeastSteps& steps,
                 const Interval& part) {
  // The component across the axes is the same in every evaluation.
  if (d.before.empty() || d.least_squares->nearest) return d.spread_mm;
  double error = sum_um(least.terms(part, d.spread_mm)) / maths::kUmPerMm;
  for (const Neglected& n : d.before.back().neglected) error += n.bound_mm;
  const double reach = least.gain(part) * d.spread_mm;
  double left = steps.left(reach, reach, true);
  for (std::size_t i = 1; i < d.before.size(); ++i)
    left = steps.left(reach, least.gain(part) * (left + error), false);
  return std::min(d.spread_mm, left + error);
}

/// The contributions of the least squares, at the poses where their sum is largest.
std::vector<Contribution> worst_terms(const Derivation& d, const LeastSquaresBound& least) {
  const LeastSteps steps(d);
  std::vector<Contribution> worst;
  for (const Interval& part : least.parts()) {
    std::vector<Contribution> terms = least.terms(part, last_size(d, least, steps, part));
    if (worst.empty() || sum_um(terms) > sum_um(worst)) worst = std::move(terms);
  }
  return worst;
}

std::vector<OutputBound> least_squares_bounds(const model::Machine& machine, const Derivation& d,
                                              const LeastSquaresBound& least,
                                              const std::array<double, 3>& omitted_mm) {
  std::vector<Contribution> shared = worst_terms(d, least);
  std::vector<std::pair<std::string, double>> parts;
  for (const Neglected& n : d.neglected) parts.emplace_back(n.what, n.bound_mm * maths::kUmPerMm);
  add_neglected(shared, parts, norm_of(omitted_mm) * maths::kUmPerMm);
  double counts = 0;
  for (const AxisDeviation& out : d.outputs)
    counts +=
        0.5 * out.lever * (machine.axes[out.axis].rotary ? 360 / static_cast<double>(kTurnCounts) : 1e-6);
  shared.push_back({"outputs in counts of the axes", "rounding", counts * maths::kUmPerMm});
  std::vector<OutputBound> bounds;
  for (const AxisDeviation& out : d.outputs) {
    OutputBound bound;
    bound.axis = machine.axes[out.axis].name;
    bound.contributions = shared;
    for (const Contribution& c : shared) share_of(bound, c.source) += c.bound_um;
    bound.deviation_um = maths::kUmPerMm * d.least_squares->spread_mm;
    sort_terms(bound);
    bounds.push_back(bound);
  }
  return bounds;
}

/// Returns the error of an evaluation before the last along output k, axis units: its program and
/// its neglected terms.
double error_of_evaluation(const Derivation& d, const LoweredProgram& p, const Evaluation& e, std::size_t k) {
  double error = 0;
  for (const Neglected& n : e.neglected) error += error_along(d.outputs[k], n);
  const auto place = p.register_of.find(e.values[k]);
  return place == p.register_of.end() ? error : error + p.registers[place->second].error;
}

/// Returns the remaining tilt after a step, rad. `reach` and `step` are of all outputs, in the
/// units of their axes. A unit vector's second derivative by two angles is at most 1.
double tilt_left_by_step(const Derivation& d, const std::vector<double>& reach,
                         const std::vector<double>& step, bool first) {
  const Orientation& o = *d.orientation;
  double left = 0, turned = 0, reached = 0;
  for (std::size_t k = 0; k < d.outputs.size(); ++k) {
    left += norm_of(slopes_of(d, o.deviation, d.outputs[k].axis)) * step[k];
    if (k < linear_outputs(d)) continue;
    const double lever = o.lever[k - linear_outputs(d)];
    turned += lever * step[k];
    reached += lever * reach[k];
  }
  return left + o.spread * turned + (first ? 0.5 : 1) * reached * turned;
}

/// Returns the error of the program in the direction's deviation and in the motion of the axes for
/// it, rad.
double tilt_error(const Derivation& d, const LoweredProgram& p) {
  const Orientation& o = *d.orientation;
  double sum = 0, error = 0;
  for (const Neglected& n : o.neglected) error += n.bound_mm;
  Registers pieces;
  for (const NodeId id : d.last_direction) {
    const auto place = p.register_of.find(id);
    if (place == p.register_of.end()) continue;
    sum += std::pow(error_from(p, place->second, {}), 2);
    pieces.insert(place->second);
  }
  error += std::sqrt(sum);
  for (std::size_t k = 0; k < o.axes.size(); ++k) {
    const auto place = p.register_of.find(o.values[k]);
    if (place == p.register_of.end()) continue;
    const double counts = 0.5 * 360 / static_cast<double>(kTurnCounts);
    error += o.lever[k] * (error_from(p, place->second, pieces) + counts);
  }
  return error;
}

/// Largest corrections of the outputs, including those of the direction.
std::vector<double> all_corrections(const Derivation& d) {
  std::vector<double> reach = largest_corrections(d);
  const Orientation& o = *d.orientation;
  for (std::size_t k = 0; k < o.axes.size(); ++k)
    reach.push_back(std::min(o.limit_deg[k], o.gain * o.spread / o.lever[k]));
  return reach;
}

/// Remaining error of Newton's steps: mm at the tool point, rad of its direction.
struct Remainder {
  double point_mm = 0, tilt = 0;
};

/// The same after each evaluation. Every step's size follows from the previous remainder.
/// least_mm: remaining error of the fixed-point least squares.
std::vector<Remainder> remainders_of(const Derivation& d, const LoweredProgram& p, double least_mm) {
  const std::size_t linear = linear_outputs(d);
  const std::vector<double> reach = d.orientation ? all_corrections(d) : largest_corrections(d);
  const std::vector<double> point(reach.begin(), reach.begin() + static_cast<std::ptrdiff_t>(linear));
  std::vector<Remainder> left(1);
  left[0].point_mm = left_by_step(d, point, point, true);
  if (d.orientation) left[0].tilt = tilt_left_by_step(d, reach, reach, true);
  for (const Evaluation& e : d.before) {
    std::vector<double> step, turns;
    double swung_mm = 0;  // by the direction's new correction
    if (d.orientation) {
      const Orientation& o = *d.orientation;
      double tilt = left.back().tilt + tilt_error(d, p);
      for (const Neglected& n : e.neglected_direction) tilt += n.bound_mm;
      for (std::size_t k = 0; k < o.axes.size(); ++k) {
        turns.push_back(std::min(2 * o.limit_deg[k], o.gain * tilt / o.lever[k]));
        swung_mm += d.outputs[linear + k].lever * turns.back();
      }
    }
    for (std::size_t k = 0; k < linear; ++k) {
      const double own = d.least_squares ? least_mm * d.outputs[k].row_norm : error_of_evaluation(d, p, e, k);
      step.push_back((left.back().point_mm + swung_mm) * d.outputs[k].row_norm + own);
    }
    Remainder next;
    next.point_mm = left_by_step(d, point, step, false);
    step.insert(step.end(), turns.begin(), turns.end());
    if (d.orientation) next.tilt = tilt_left_by_step(d, reach, step, false);
    left.push_back(next);
  }
  return left;
}

}  // namespace

const char* name_of(ErrorSource source) {
  switch (source) {
    case ErrorSource::kRounding:
      return "rounding";
    case ErrorSource::kTable:
      return "table";
    case ErrorSource::kFunction:
      return "function";
    case ErrorSource::kChannel:
      return "input";
    case ErrorSource::kLag:
      return "lag";
  }
  return "";
}

std::vector<OutputBound> bounds_of(const model::Machine& machine, const Derivation& d,
                                   const LoweredProgram& p) {
  if (d.outputs.empty()) return {};
  std::optional<LeastSquaresBound> least;
  if (d.least_squares) least.emplace(d, p);
  double least_mm = 0;
  if (least && !d.before.empty()) {
    const std::vector<Interval> parts = least->parts();
    least_mm = sum_um(least->terms({parts.front().low, parts.back().high}, d.spread_mm)) / maths::kUmPerMm;
    for (const Neglected& n : d.before.back().neglected) least_mm += n.bound_mm;
  }
  const std::vector<Remainder> remainders = remainders_of(d, p, least_mm);
  const std::array<double, 3> omitted_mm = omitted_together(machine, d);
  std::vector<OutputBound> bounds;
  if (least) {
    bounds = least_squares_bounds(machine, d, *least, omitted_mm);
  } else {
    for (std::size_t i = 0; i < p.outputs.size(); ++i)
      bounds.push_back(i < linear_outputs(d) ? bound_of(machine, d, p, omitted_mm, i)
                                             : bound_of_direction(machine, d, i));
  }
  const double left_mm = remainders.back().point_mm;
  for (std::size_t i = 0; i < linear_outputs(d); ++i) {
    const bool along = !machine.axes[d.outputs[i].axis].rotary && !d.least_squares;
    const double um = maths::kUmPerMm * left_mm * (along ? d.outputs[i].row_norm : 1);
    // For least squares near singular poses, a bound above the deviation itself has no use.
    if (d.least_squares && um >= std::max(bounds[i].deviation_um, 1e-3)) continue;
    bounds[i].second_order_um = um;
    bounds[i].total_um += um;
  }
  return bounds;
}

std::optional<TiltBound> tilt_bound_of(const Derivation& d, const LoweredProgram& p) {
  if (!d.orientation) return std::nullopt;
  const Orientation& o = *d.orientation;
  TiltBound bound;
  bound.deviation_deg = o.spread / maths::kRadPerDeg;
  const double error = tilt_error(d, p);
  bound.fixed_point_deg = error / maths::kRadPerDeg;
  bound.second_order_deg = remainders_of(d, p, 0).back().tilt / maths::kRadPerDeg;
  return bound;
}

}  // namespace vernier::compile
