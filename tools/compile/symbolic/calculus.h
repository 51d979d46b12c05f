// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

#include "tools/compile/symbolic/graph.h"

namespace vernier::compile {

/// Computes d node / d channel as a node. Throws std::domain_error if the node has a step or a table.
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

/// Values of nodes at random positions of their channels' ranges. The random numbers are seeded: each call
/// gives the same values. A table or a lag has no sampled value. A node that depends on a table or a lag
/// throws std::domain_error.
class Samples {
 public:
  Samples(const Graph& graph, Eigen::Index count) : graph_(graph), count_(count) {}
  const Eigen::ArrayXd& of(NodeId node);
  /// Sets the values of a channel instead of random values. Call set() before the channel is used.
  void set(NodeId channel, Eigen::ArrayXd values) { known_[channel] = std::move(values); }

 private:
  Eigen::ArrayXd evaluate(NodeId id);

  const Graph& graph_;
  Eigen::Index count_;
  std::map<NodeId, Eigen::ArrayXd> known_;
};

/// Returns the value of a node that is equal at every sample (a trigonometric identity), otherwise nullopt.
std::optional<double> sampled_constant(Samples& samples, NodeId node);

/// Intervals over a part of the declared ranges. The channels in `box` have the range of the box, the other
/// channels their whole range.
class Enclosure {
 public:
  Enclosure(const Graph& graph, const std::map<NodeId, Interval>& box) : graph_(graph), box_(box) {}
  Interval of(NodeId id);

 private:
  const Graph& graph_;
  const std::map<NodeId, Interval>& box_;
  std::map<NodeId, Interval> known_;
};

/// Returns a lower bound of a node over the declared ranges, by bisection of the positions on which the node
/// depends. lower_bound_of evaluates at most `boxes` parts. The result is never above the true minimum.
double lower_bound_of(const Graph& graph, NodeId node, std::size_t boxes);

/// Upper bounds of |d node / d channel| over the declared ranges. Tables count with their steepest piece,
/// choices with the steeper side; steps of comparisons are excluded. tables: largest slope of each column,
/// per graph node.
class Slopes {
 public:
  Slopes(const Graph& graph, NodeId channel, const std::map<NodeId, double>& table_slopes)
      : graph_(graph), channel_(channel), table_slopes_(table_slopes) {}
  /// From this call on the node counts as constant: its slope by the channel is 0.
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
