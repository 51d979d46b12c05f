// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "tools/compile/symbolic/graph.h"

namespace vernier::compile {

/// Computes the derivative d node / d channel as a node of the graph. Throws std::domain_error if the node
/// contains a step or a table.
class Derivative {
 public:
  Derivative(Graph& graph, NodeId channel) : g_(graph), channel_(channel) {}
  NodeId of(NodeId id);

 private:
  NodeId make(NodeId id);

  Graph& g_;
  NodeId channel_;
  std::map<NodeId, NodeId> known_;
};

/// Values of nodes at random positions in the ranges of their channels. The random numbers have a fixed seed,
/// so that each call gives the same values. A table or a lag has no sampled value. For a node that depends on
/// a table or a lag, Samples throws std::domain_error.
class Samples {
 public:
  Samples(const Graph& graph, Eigen::Index count) : graph_(graph), count_(count) {}
  const Eigen::ArrayXd& of(NodeId node);
  /// Sets the values of a channel, which replace random values. Call set() before the channel is used.
  void set(NodeId channel, Eigen::ArrayXd values) { known_[channel] = std::move(values); }

 private:
  Eigen::ArrayXd evaluate(NodeId id);

  const Graph& graph_;
  Eigen::Index count_;
  std::map<NodeId, Eigen::ArrayXd> known_;
};

/// Returns the value of a node that is equal at every sample (for example sin^2 + cos^2); otherwise nullopt.
std::optional<double> sampled_constant(Samples& samples, NodeId node);

/// Returns the range of a node of the kind kTable for a range of its position.
using TableRange = std::function<Interval(const Node& table, const Interval& position)>;

/// Returns a lower bound of a node over the declared ranges, by bisection of the positions on which the node
/// depends. The bisection evaluates at most `boxes` parts (boxes) of the ranges. The lower bound is never
/// above the true minimum. Without `table_range`, a table has its whole range in every box.
double lower_bound_of(const Graph& graph, NodeId node, std::size_t boxes, const TableRange& table_range = {});

/// Upper bounds of |d node / d channel| over the declared ranges. For a table, the slope of its steepest
/// segment counts. For a choice (min, max), the steeper side counts. The bounds of the derivatives exclude
/// the steps of comparisons (==, <). `table_slopes`: largest slope of each table column, by graph node.
class Slopes {
 public:
  Slopes(const Graph& graph, NodeId channel, const std::map<NodeId, double>& table_slopes)
      : graph_(graph), channel_(channel), table_slopes_(table_slopes) {}
  /// Declares that a node counts as constant from this call on: its slope with respect to the channel is 0.
  void hold(NodeId node) { known_[node] = {}; }
  Interval of(NodeId id);

 private:
  Interval slope(const Node& node);

  const Graph& graph_;
  NodeId channel_;
  const std::map<NodeId, double>& table_slopes_;
  std::map<NodeId, Interval> known_;
};

}  // namespace vernier::compile
