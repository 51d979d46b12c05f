// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/symbolic/graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/compile/symbolic/functions.h"
#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

// Coefficients that are nonzero only by rounding, for example of cos 90 deg.
constexpr double kRoundOff = 1e-15;

void check_domain(Function f, const Interval& x) {
  if ((f == Function::kLog || f == Function::kSqrt) && x.low <= 0)
    throw std::domain_error(
        fmt::format("{} of a value that can be zero or negative", std::string(name_of(f))));
  if (f == Function::kReciprocal && x.contains(0))
    throw std::domain_error("division by a value that can reach zero");
  if (f == Function::kExp && x.high > 200) throw std::domain_error("exp of a value that can exceed 200");
}

double value_of_choice(NodeKind kind, double a, double b) {
  switch (kind) {
    case NodeKind::kAbs:
      return std::abs(a);
    case NodeKind::kMin:
      return std::min(a, b);
    case NodeKind::kMax:
      return std::max(a, b);
    case NodeKind::kSign:
      return (a > 0) - (a < 0);
    case NodeKind::kEqual:
      return a == b;
    case NodeKind::kLess:
      return a < b;
    default:
      throw std::logic_error("not a choice");
  }
}

}  // namespace

Interval range_of_choice(NodeKind kind, const Interval& a, const Interval& b) {
  switch (kind) {
    case NodeKind::kAbs:
      return {a.contains(0) ? 0 : std::min(std::abs(a.low), std::abs(a.high)), a.magnitude()};
    case NodeKind::kMin:
      return {std::min(a.low, b.low), std::min(a.high, b.high)};
    case NodeKind::kMax:
      return {std::max(a.low, b.low), std::max(a.high, b.high)};
    case NodeKind::kSign:
      return {a.low > 0 ? 1.0 : (a.low == 0 ? 0.0 : -1.0), a.high < 0 ? -1.0 : (a.high == 0 ? 0.0 : 1.0)};
    default:
      return {0, 1};
  }
}

NodeId Graph::intern(Node node) {
  Key key{node.kind,
          node.number,
          static_cast<int>(node.channel),
          static_cast<int>(node.function),
          node.index[0],
          node.index[1],
          node.args,
          node.terms};
  const auto [place, fresh] = known_.emplace(std::move(key), static_cast<NodeId>(nodes_.size()));
  if (fresh) nodes_.push_back(std::move(node));
  return place->second;
}

std::optional<double> Graph::constant_value(NodeId id) const {
  if (nodes_[id].kind != NodeKind::kConstant) return std::nullopt;
  return nodes_[id].number;
}

NodeId Graph::constant(double value) {
  if (!std::isfinite(value)) throw std::domain_error("a constant that is not a finite number");
  Node node;
  node.number = value == 0 ? 0 : value;  // no negative zero
  node.range = {value, value};
  return intern(std::move(node));
}

NodeId Graph::channel(ChannelKind kind, std::uint32_t index, const Interval& range) {
  Node node;
  node.kind = NodeKind::kChannel;
  node.channel = kind;
  node.index[0] = index;
  node.range = range;
  return intern(std::move(node));
}

NodeId Graph::sum(double constant_part, const std::vector<Term>& terms) {
  std::map<NodeId, double> collected;
  std::map<NodeId, double> largest;  // to distinguish a cancelled coefficient from a small one
  const auto collect = [&](double k, NodeId id) {
    collected[id] += k;
    largest[id] = std::max(largest[id], std::abs(k));
  };
  for (const Term& term : terms) {
    const Node& node = nodes_[term.node];
    if (node.kind == NodeKind::kConstant) {
      constant_part += term.coefficient * node.number;
    } else if (node.kind == NodeKind::kSum && node.terms.size() + (node.number != 0 ? 1 : 0) < 2) {
      // A sum of several terms stays one node, so that its terms are not computed again at each
      // use. Lowering expands sums that are used once.
      constant_part += term.coefficient * node.number;
      for (const Term& inner : node.terms) collect(term.coefficient * inner.coefficient, inner.node);
    } else {
      collect(term.coefficient, term.node);
    }
  }
  Node node;
  node.kind = NodeKind::kSum;
  node.number = constant_part == 0 ? 0 : constant_part;
  node.range = {constant_part, constant_part};
  for (const auto& [id, k] : collected) {
    if (std::abs(k) <= kRoundOff * largest[id]) continue;
    node.terms.push_back({k, id});
    node.range = node.range + k * nodes_[id].range;
  }
  if (node.terms.empty()) return constant(constant_part);
  if (node.terms.size() == 1 && node.number == 0 && node.terms[0].coefficient == 1) return node.terms[0].node;
  return intern(std::move(node));
}

NodeId Graph::product(NodeId a, NodeId b) {
  // Coefficients move out of products, so that k*x*y and x*y share the product, unless the
  // coefficient keeps the product small.
  constexpr double kHuge = 1e12;
  const NodeId whole_a = a, whole_b = b;
  double coefficient = 1;
  for (NodeId* id : {&a, &b}) {
    const Node& node = nodes_[*id];
    if (node.kind == NodeKind::kConstant) return scale(coefficient * node.number, id == &a ? b : a);
    if (node.kind == NodeKind::kSum && node.terms.size() == 1 && node.number == 0) {
      coefficient *= node.terms[0].coefficient;
      *id = node.terms[0].node;
    }
  }
  if ((nodes_[a].range * nodes_[b].range).magnitude() > kHuge) a = whole_a, b = whole_b, coefficient = 1;
  Node node;
  node.kind = NodeKind::kProduct;
  node.args = {std::min(a, b), std::max(a, b)};
  node.range = nodes_[a].range * nodes_[b].range;
  if (a == b) node.range = square(nodes_[a].range);
  return scale(coefficient, intern(std::move(node)));
}

NodeId Graph::table(std::uint32_t axis, std::uint32_t column, NodeId position, const Interval& range) {
  Node node;
  node.kind = NodeKind::kTable;
  node.index[0] = axis;
  node.index[1] = column;
  node.args = {position};
  node.range = range;
  return intern(std::move(node));
}

NodeId Graph::function(Function f, NodeId argument) {
  if (const auto value = constant_value(argument)) return constant(value_of(f, *value));
  check_domain(f, nodes_[argument].range);
  Node node;
  node.kind = NodeKind::kFunction;
  node.function = f;
  node.args = {argument};
  node.range = range_of_function(f, nodes_[argument].range);
  return intern(std::move(node));
}

NodeId Graph::choice(NodeKind kind, NodeId a, NodeId b) {
  const auto x = constant_value(a), y = constant_value(b);
  if (x && y) return constant(value_of_choice(kind, *x, *y));
  Node node;
  node.kind = kind;
  node.args = {a};
  if (kind != NodeKind::kAbs && kind != NodeKind::kSign) node.args.push_back(b);
  node.range = range_of_choice(kind, nodes_[a].range, nodes_[b].range);
  return node.range.low == node.range.high ? constant(node.range.low) : intern(std::move(node));
}

NodeId Graph::lag(NodeId input, double tau_s) {
  if (tau_s <= 0 || constant_value(input)) return input;
  Node node;
  node.kind = NodeKind::kLag;
  node.number = tau_s;
  node.args = {input};
  node.range = nodes_[input].range;
  return intern(std::move(node));
}

bool Graph::depends_on(NodeId id, NodeId other) const {
  // Operands precede their node, so one pass from `other` upwards is sufficient.
  if (id < other) return false;
  std::vector<char> reached(id + 1 - other, 0);
  reached[0] = 1;
  for (NodeId i = other + 1; i <= id; ++i) {
    const auto is_reached = [&](NodeId n) { return n >= other && reached[n - other] != 0; };
    const Node& node = nodes_[i];
    const bool through = std::any_of(node.args.begin(), node.args.end(), is_reached) ||
                         std::any_of(node.terms.begin(), node.terms.end(),
                                     [&](const Term& term) { return is_reached(term.node); });
    reached[i - other] = through ? 1 : 0;
  }
  return reached.back() != 0;
}

std::optional<double> Graph::constant_slope(NodeId id, NodeId channel) const {
  if (id == channel) return 1.0;
  const Node& node = nodes_[id];
  if (node.kind == NodeKind::kSum) {
    double slope = 0;
    for (const Term& term : node.terms) {
      const auto inner = constant_slope(term.node, channel);
      if (!inner) return std::nullopt;
      slope += term.coefficient * *inner;
    }
    return slope;
  }
  if (depends_on(id, channel)) return std::nullopt;
  return 0.0;
}

}  // namespace vernier::compile
