// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/symbolic/calculus.h"

#include <cmath>
#include <queue>
#include <random>
#include <set>
#include <stdexcept>

#include "tools/compile/symbolic/functions.h"
#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

constexpr unsigned kSeed = 20260701;  // any

NodeId slope_node(Graph& g, Function f, NodeId a) {
  switch (f) {
    case Function::kSin:
      return g.scale(maths::kRadPerDeg, g.function(Function::kCos, a));
    case Function::kCos:
      return g.scale(-maths::kRadPerDeg, g.function(Function::kSin, a));
    case Function::kExp:
      return g.function(Function::kExp, a);
    case Function::kLog:
      return g.function(Function::kReciprocal, a);
    case Function::kSqrt:
      return g.scale(0.5, g.function(Function::kReciprocal, g.function(Function::kSqrt, a)));
    case Function::kReciprocal: {
      const NodeId r = g.function(Function::kReciprocal, a);
      return g.scale(-1, g.product(r, r));
    }
    case Function::kArcTangent:
      return g.scale(1 / maths::kRadPerDeg,
                     g.function(Function::kReciprocal, g.sum(1, {{1, g.product(a, a)}})));
  }
  throw std::logic_error("unknown function");
}

double combined(NodeKind kind, double a, double b) {
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
      throw std::domain_error("the value of a table or a lag cannot be computed from a single sample");
  }
}

/// Interval arithmetic over parts (boxes) of the declared ranges, for one node. A position has the range of
/// the box, any other channel its whole range.
class Enclosure {
 public:
  Enclosure(const Graph& graph, NodeId root, const TableRange& table_range)
      : graph_(graph), root_(root), table_range_(table_range), range_(root + 1) {
    std::set<NodeId> needed;
    collect(root, needed);
    needed_.assign(needed.begin(), needed.end());
    for (const NodeId id : needed_) {
      const Node& n = graph_[id];
      if (n.kind == NodeKind::kChannel && n.channel == ChannelKind::kPosition) positions_.push_back(id);
    }
  }

  const std::vector<NodeId>& positions() const { return positions_; }
  /// box: the range of each of positions().
  Interval over(const std::vector<Interval>& box) {
    std::size_t position = 0;
    for (const NodeId id : needed_) {
      const Node& n = graph_[id];
      const bool at = position < positions_.size() && positions_[position] == id;
      const Interval range = at ? box[position++] : of(n);
      // Both are valid: the whole range's own and the part's.
      range_[id] = {std::max(range.low, n.range.low), std::min(range.high, n.range.high)};
    }
    return range_[root_];
  }

 private:
  // The nodes that an operation uses have smaller numbers.
  void collect(NodeId id, std::set<NodeId>& needed) const {
    if (!needed.insert(id).second) return;
    for (const NodeId arg : graph_[id].args) collect(arg, needed);
    for (const Term& term : graph_[id].terms) collect(term.node, needed);
  }
  Interval of(const Node& n) const {
    if (n.kind == NodeKind::kSum) {
      Interval range{n.number, n.number};
      for (const Term& term : n.terms) range = range + term.coefficient * range_[term.node];
      return range;
    }
    if (n.kind == NodeKind::kProduct)
      return n.args[0] == n.args[1] ? square(range_[n.args[0]]) : range_[n.args[0]] * range_[n.args[1]];
    if (n.kind == NodeKind::kFunction) return range_of_function(n.function, range_[n.args[0]]);
    if (n.kind == NodeKind::kTable && table_range_) return table_range_(n, range_[n.args[0]]);
    if (n.args.size() == 2) return range_of_choice(n.kind, range_[n.args[0]], range_[n.args[1]]);
    return n.range;
  }

  const Graph& graph_;
  NodeId root_;
  const TableRange& table_range_;
  std::vector<NodeId> needed_, positions_;
  std::vector<Interval> range_;
};

}  // namespace

NodeId Derivative::of(NodeId id) {
  const auto found = known_.find(id);
  if (found != known_.end()) return found->second;
  const NodeId result = make(id);
  return known_[id] = result;
}

NodeId Derivative::make(NodeId id) {
  if (id == channel_) return g_.constant(1);
  if (!g_.depends_on(id, channel_)) return g_.constant(0);
  const Node node = g_[id];  // a copy: the graph grows below
  switch (node.kind) {
    case NodeKind::kSum: {
      std::vector<Term> terms;
      for (const Term& term : node.terms) terms.push_back({term.coefficient, of(term.node)});
      return g_.sum(0, terms);
    }
    case NodeKind::kProduct: {
      const NodeId a = node.args[0], b = node.args[1];
      return g_.add(g_.product(of(a), b), g_.product(a, of(b)));
    }
    case NodeKind::kFunction:
      return g_.product(slope_node(g_, node.function, node.args[0]), of(node.args[0]));
    case NodeKind::kSign:
    case NodeKind::kEqual:
    case NodeKind::kLess:
      return g_.constant(0);
    default:
      throw std::domain_error("the direction of motion changes in a step (by a comparison)");
  }
}

const Eigen::ArrayXd& Samples::of(NodeId node) {
  const auto found = known_.find(node);
  if (found != known_.end()) return found->second;
  Eigen::ArrayXd values = evaluate(node);
  return known_.emplace(node, std::move(values)).first->second;
}

Eigen::ArrayXd Samples::evaluate(NodeId id) {
  const Node& n = graph_[id];
  Eigen::ArrayXd values = Eigen::ArrayXd::Constant(count_, n.number);
  switch (n.kind) {
    case NodeKind::kConstant:
      break;
    case NodeKind::kChannel: {
      std::mt19937_64 random(kSeed + 1000 * static_cast<unsigned>(n.channel) + n.index[0]);
      std::uniform_real_distribution<double> within(n.range.low, n.range.high);
      for (double& v : values) v = within(random);
      break;
    }
    case NodeKind::kSum:
      for (const Term& term : n.terms) values += term.coefficient * of(term.node);
      break;
    case NodeKind::kProduct:
      values = of(n.args[0]) * of(n.args[1]);
      break;
    case NodeKind::kFunction:
      values = of(n.args[0]).unaryExpr([&](double x) { return value_of(n.function, x); });
      break;
    default:
      if (n.kind == NodeKind::kTable || n.kind == NodeKind::kLag)
        throw std::domain_error("the value of a table or a lag cannot be computed from a single sample");
      values = of(n.args[0]).binaryExpr(of(n.args.back()),
                                        [&](double a, double b) { return combined(n.kind, a, b); });
  }
  return values;
}

std::optional<double> sampled_constant(Samples& samples, NodeId node) {
  const Eigen::ArrayXd& values = samples.of(node);
  const double middle = values.mean(), spread = (values - middle).abs().maxCoeff();
  if (spread > 1e-11 * std::max(1.0, std::abs(middle))) return std::nullopt;
  const double nearest = std::round(middle);
  return std::abs(middle - nearest) < 1e-11 ? nearest : middle;
}

double lower_bound_of(const Graph& graph, NodeId node, std::size_t boxes, const TableRange& table_range) {
  Enclosure enclosure(graph, node, table_range);
  const std::vector<NodeId>& positions = enclosure.positions();
  using Box = std::vector<Interval>;
  Box whole;
  for (const NodeId p : positions) whole.push_back(graph[p].range);
  const auto low_of = [&](const Box& box) { return enclosure.over(box).low; };
  const auto later = [](const auto& a, const auto& b) { return a.first > b.first; };
  std::priority_queue<std::pair<double, Box>, std::vector<std::pair<double, Box>>, decltype(later)> queue(
      later);
  queue.emplace(low_of(whole), whole);
  for (std::size_t used = 1; used < boxes && !whole.empty(); used += 2) {
    const Box box = queue.top().second;
    queue.pop();
    const auto share = [&](std::size_t p) {
      return (box[p].high - box[p].low) / std::max(1e-300, whole[p].high - whole[p].low);
    };
    std::size_t widest = 0;
    for (std::size_t p = 1; p < box.size(); ++p)
      if (share(p) > share(widest)) widest = p;
    const Interval part = box[widest];
    const double middle = 0.5 * (part.low + part.high);
    for (const Interval& half : {Interval{part.low, middle}, Interval{middle, part.high}}) {
      Box next = box;
      next[widest] = half;
      queue.emplace(low_of(next), std::move(next));
    }
  }
  return queue.top().first;
}

Interval Slopes::of(NodeId id) {
  if (id == channel_) return {1, 1};
  const auto found = known_.find(id);
  if (found != known_.end()) return found->second;
  const Interval result = slope(graph_[id]);
  if (const auto table = table_slopes_.find(id); table != table_slopes_.end())
    return known_[id] = Interval{-table->second, table->second} * of(graph_[id].args[0]);
  return known_[id] = result;
}

Interval Slopes::slope(const Node& n) {
  switch (n.kind) {
    case NodeKind::kSum: {
      Interval total;
      for (const Term& term : n.terms) total = total + term.coefficient * of(term.node);
      return total;
    }
    case NodeKind::kProduct:
      return of(n.args[0]) * graph_[n.args[1]].range + graph_[n.args[0]].range * of(n.args[1]);
    case NodeKind::kFunction: {
      const double steepest = slope_bound(n.function, graph_[n.args[0]].range);
      return Interval{-steepest, steepest} * of(n.args[0]);
    }
    case NodeKind::kAbs: {
      const double size = of(n.args[0]).magnitude();
      return {-size, size};
    }
    case NodeKind::kMin:
    case NodeKind::kMax:
      return hull(of(n.args[0]), of(n.args[1]));
    case NodeKind::kLag:
      return hull(of(n.args[0]), {});
    default:
      return {};
  }
}

}  // namespace vernier::compile
