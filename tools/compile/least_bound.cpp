// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/least_bound.h"

#include <algorithm>
#include <cmath>

#include "tools/compile/bound.h"
#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

/// Number of intervals of the determinant. With four times as many, the bound of the robot of bound_check is
/// the same in four digits.
constexpr int kParts = 64;

}  // namespace

std::vector<double> gains_to(const LoweredProgram& p, std::uint32_t output) {
  std::vector<double> gain(p.registers.size(), 0);
  gain[output] = 1;
  for (std::size_t i = p.registers.size(); i-- > 0;) {
    if (i != output && p.registers[i].given) gain[i] = 0;
    for (const Register::Use& use : p.registers[i].uses) gain[use.from] += gain[i] * use.gain;
  }
  return gain;
}

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

}  // namespace vernier::compile
