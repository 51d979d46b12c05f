#include "tools/compile/bound.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/compile/calculus.h"

namespace vernier {
namespace {

constexpr double kUmPerMm = 1000;

/// How strongly each register's error shows in the register `output`: reverse accumulation of the gains.
std::vector<double> gains_to(const LoweredProgram& p, std::uint32_t output) {
  std::vector<double> gain(p.registers.size(), 0);
  gain[output] = 1;
  for (std::size_t i = p.registers.size(); i-- > 0;)
    for (const Register::Use& use : p.registers[i].uses) gain[use.from] += gain[i] * use.gain;
  return gain;
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

OutputBound bound_of(const Machine& machine, const Derivation& d, const LoweredProgram& p, std::size_t i) {
  const Output& out = p.outputs[i];
  const Register& result = p.registers[out.source];
  OutputBound bound;
  bound.axis = machine.axes[out.axis].name;
  const bool rotary = machine.axes[out.axis].rotary;
  const double um_per_unit = kUmPerMm * (rotary ? d.outputs[i].lever : 1);
  bound.deviation_um = result.range.magnitude() * um_per_unit;
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
  blame("errors multiplied with each other", "rounding", result.error - first_order);
  const double factor = std::ldexp(out.multiplier, -static_cast<int>(out.shift)),
               counts_per_unit = rotary ? static_cast<double>(kTurnCounts) / 360 : 1e6,
               exact = std::ldexp(counts_per_unit, -result.fraction_bits);
  blame(rotary ? "output in 2^-32 turn" : "output in nm", "rounding",
        0.5 / counts_per_unit + result.range.magnitude() * std::abs(factor / exact - 1));
  for (const Neglected& n : d.neglected) {
    double along = 0;
    for (std::size_t c = 0; c < 3; ++c) along += d.outputs[i].row[c] * n.along_mm[c];
    blame(n.what, "linearisation", std::min(along, n.bound_mm * d.outputs[i].row_norm));
  }
  sort_terms(bound);
  return bound;
}

/// Error of a register against the exact function of the registers `given`; their own errors do not count.
double error_from(const LoweredProgram& p, std::uint32_t target, const std::set<std::uint32_t>& given) {
  std::vector<double> gain(p.registers.size(), 0);
  gain[target] = 1;
  double error = 0;
  for (std::size_t i = target + 1; i-- > 0;) {
    if (gain[i] == 0 || given.count(static_cast<std::uint32_t>(i)) != 0) continue;
    error += gain[i] * p.registers[i].own_error;
    for (const Register::Use& use : p.registers[i].uses) gain[use.from] += gain[i] * use.gain;
  }
  return error;
}

/// The residual J x - deviation that the fixed-point solution of the least squares leaves, by matrix norms:
/// rounding in J' w, w, adj(J J'), det, J J' and J itself, each seen through what follows it. Intervals would
/// multiply the errors by the inverse's worst entries at once; the residual knows that the pieces belong
/// together.
class LeastSquaresBound {
 public:
  LeastSquaresBound(const Derivation& d, const LoweredProgram& p)
      : g_(d.graph), least_(*d.least_squares), outputs_(d.outputs), p_(p) {}

  std::vector<Contribution> terms() const {
    const double most = least_.largest / least_.floor, size = least_.spread_mm;
    const std::set<std::uint32_t> jacobian = registers(least_.jacobian), square = registers(least_.square);
    std::set<std::uint32_t> pieces = registers(least_.adjugate);
    for (const NodeId id : least_.deviation) insert(pieces, id);
    insert(pieces, least_.reciprocal);
    std::vector<Contribution> terms;
    const auto add = [&](const char* name, const char* source, double mm) {
      if (mm > 0) terms.push_back({name, source, mm * kUmPerMm});
    };
    add_deviation(terms);
    if (const auto reciprocal = place(least_.reciprocal)) {
      const double largest = g_[least_.determinant].range.high;
      add("reciprocal of the determinant", "function", p_.registers[*reciprocal].own_error * largest * size);
    }
    add("determinant", "rounding", error_of(least_.determinant, square) / least_.floor * size);
    add("adjugate", "rounding", least_.trace * error_of(least_.adjugate, square) / least_.floor * size);
    add("J J'", "rounding", error_of(least_.square, jacobian) * most * size);
    add("J", "function", error_of(least_.jacobian, {}) * least_.gain * size);
    std::set<std::uint32_t> last = jacobian;
    double weights = 0;
    for (const NodeId id : least_.weights) {
      weights += std::pow(error_of(id, pieces), 2);
      insert(last, id);
    }
    add("weights", "rounding", least_.trace * std::sqrt(weights));
    double solution = 0;
    for (std::size_t k = 0; k < outputs_.size(); ++k)
      solution += std::pow(least_.lever[k] * error_of(outputs_[k].value, last), 2);
    add("solution", "rounding", std::sqrt(least_.trace * solution));
    return terms;
  }

 private:
  // A product takes the coefficient out of a scaled node: the register is the inner one's.
  std::pair<double, NodeId> bare(NodeId id) const {
    const Node& n = g_[id];
    if (p_.register_of.count(id) == 0 && n.kind == NodeKind::kSum && n.terms.size() == 1 && n.number == 0)
      return {std::abs(n.terms[0].coefficient), n.terms[0].node};
    return {1, id};
  }
  std::optional<std::uint32_t> place(NodeId id) const {
    const auto found = p_.register_of.find(bare(id).second);
    if (found == p_.register_of.end()) return std::nullopt;
    return found->second;
  }
  void insert(std::set<std::uint32_t>& set, NodeId id) const {
    if (const auto at = place(id)) set.insert(*at);
  }
  std::set<std::uint32_t> registers(const std::vector<std::vector<NodeId>>& matrix) const {
    std::set<std::uint32_t> set;
    for (const auto& row : matrix)
      for (const NodeId id : row) insert(set, id);
    return set;
  }
  double error_of(NodeId id, const std::set<std::uint32_t>& given) const {
    const auto at = place(id);
    return at ? bare(id).first * error_from(p_, *at, given) : 0;
  }
  /// Root of the sum of squares over a matrix.
  double error_of(const std::vector<std::vector<NodeId>>& matrix,
                  const std::set<std::uint32_t>& given) const {
    double sum = 0;
    for (const auto& row : matrix)
      for (const NodeId id : row) sum += std::pow(error_of(id, given), 2);
    return std::sqrt(sum);
  }
  /// What the deviation's own registers are wrong by, a term per register.
  void add_deviation(std::vector<Contribution>& terms) const {
    std::vector<double> square(p_.registers.size(), 0);
    for (const NodeId id : least_.deviation) {
      const auto at = place(id);
      if (!at) continue;
      const std::vector<double> gain = gains_to(p_, *at);
      for (std::size_t r = 0; r < gain.size(); ++r)
        square[r] += std::pow(bare(id).first * gain[r] * p_.registers[r].own_error, 2);
    }
    for (std::size_t r = 0; r < square.size(); ++r)
      if (square[r] > 0)
        terms.push_back(
            {p_.registers[r].name, name_of(p_.registers[r].source), std::sqrt(square[r]) * kUmPerMm});
  }

  const Graph& g_;
  const LeastSquares& least_;
  const std::vector<AxisDeviation>& outputs_;
  const LoweredProgram& p_;
};

std::vector<OutputBound> least_squares_bounds(const Machine& machine, const Derivation& d,
                                              const LoweredProgram& p) {
  std::vector<Contribution> shared = LeastSquaresBound(d, p).terms();
  for (const Neglected& n : d.neglected) shared.push_back({n.what, "linearisation", n.bound_mm * kUmPerMm});
  double counts = 0;
  for (const AxisDeviation& out : d.outputs)
    counts +=
        0.5 * out.lever * (machine.axes[out.axis].rotary ? 360 / static_cast<double>(kTurnCounts) : 1e-6);
  shared.push_back({"outputs in counts of the axes", "rounding", counts * kUmPerMm});
  std::vector<OutputBound> bounds;
  for (const AxisDeviation& out : d.outputs) {
    OutputBound bound;
    bound.axis = machine.axes[out.axis].name;
    bound.contributions = shared;
    for (const Contribution& c : shared) share_of(bound, c.source) += c.bound_um;
    bound.deviation_um = kUmPerMm * d.least_squares->spread_mm;
    sort_terms(bound);
    bounds.push_back(bound);
  }
  return bounds;
}

/// Largest correction of each output, axis units.
std::vector<double> largest_corrections(const Derivation& d) {
  std::vector<double> largest;
  for (const AxisDeviation& out : d.outputs) {
    const double range = d.graph[out.value].range.magnitude();
    largest.push_back(std::min(range, d.spread_mm * out.row_norm));
  }
  return largest;
}

/// deviation(q + c) - deviation(q) and what bends the nominal motion, mm at the tool point.
double second_order_mm(const Derivation& d) {
  const std::vector<double> c = largest_corrections(d);
  double slope[3] = {0, 0, 0}, turned = 0, bent = 0;
  const auto turning = [&](std::size_t axis) {
    const auto found = d.turning.find(axis);
    return found == d.turning.end() ? 0 : found->second;
  };
  for (std::size_t k = 0; k < d.outputs.size(); ++k) {
    const std::size_t axis = d.outputs[k].axis;
    std::optional<NodeId> channel;
    for (NodeId id = 0; id < d.graph.size(); ++id)
      if (d.graph[id].kind == NodeKind::kChannel && d.graph[id].channel == ChannelKind::kPosition &&
          d.graph[id].index[0] == axis)
        channel = id;
    if (!channel) continue;
    Slopes by_axis(d.graph, *channel, d.table_slopes);
    for (std::size_t i = 0; i < 3; ++i) slope[i] += by_axis.of(d.deviation[i]).magnitude() * c[k];
    turned += turning(axis) * c[k] * d.spread_mm;
    for (std::size_t j = 0; j < d.outputs.size(); ++j)
      for (const AxisColumn& column : d.columns)
        if (column.axis == d.outputs[j].axis) {
          double bend = 0;
          for (const NodeId id : column.direction) bend += std::pow(by_axis.of(id).magnitude(), 2);
          // The frame's own turn is seen from one side only, so it counts for both.
          bent += (0.5 * std::sqrt(bend) + turning(axis) * column.norm * (j == k ? 0.5 : 1)) * c[k] * c[j];
        }
  }
  return std::sqrt(slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2]) + turned + bent;
}

}  // namespace

std::vector<OutputBound> bounds_of(const Machine& machine, const Derivation& d, const LoweredProgram& p) {
  std::vector<OutputBound> bounds;
  if (d.least_squares) {
    bounds = least_squares_bounds(machine, d, p);
  } else {
    for (std::size_t i = 0; i < p.outputs.size(); ++i) bounds.push_back(bound_of(machine, d, p, i));
  }
  const double second_order = d.outputs.empty() ? 0 : second_order_mm(d);
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const bool along = !machine.axes[d.outputs[i].axis].rotary && !d.least_squares;
    const double um = kUmPerMm * second_order * (along ? d.outputs[i].row_norm : 1);
    // More than the deviation itself says nothing.
    if (um < std::max(bounds[i].deviation_um, 1e-3)) bounds[i].second_order_um = um;
  }
  return bounds;
}

}  // namespace vernier
