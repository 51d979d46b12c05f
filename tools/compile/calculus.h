// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

#include "tools/compile/graph.h"

namespace vernier::compile {

/// d node / d channel as a node. Throws std::domain_error where the node has a step or a table there. tool.
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

/// Values of nodes at random places of their channels' ranges (seeded: the same every time). A table or a lag
/// has no value here: asking for a node that reads one throws std::domain_error. tool.
class Samples {
 public:
  Samples(const Graph& graph, Eigen::Index count) : graph_(graph), count_(count) {}
  const Eigen::ArrayXd& of(NodeId node);
  /// Values of a channel other than random ones, before it is asked for.
  void set(NodeId channel, Eigen::ArrayXd values) { known_[channel] = std::move(values); }

 private:
  Eigen::ArrayXd evaluate(NodeId id);

  const Graph& graph_;
  Eigen::Index count_;
  std::map<NodeId, Eigen::ArrayXd> known_;
};

/// The value of a node that is one number at every sample (a trigonometric identity), nothing otherwise.
std::optional<double> sampled_constant(Samples& samples, NodeId node);

/// Intervals over a part of the declared ranges: the channels of `box` have their part, others the whole.
class Enclosure {
 public:
  Enclosure(const Graph& graph, const std::map<NodeId, Interval>& box) : graph_(graph), box_(box) {}
  Interval of(NodeId id);

 private:
  const Graph& graph_;
  const std::map<NodeId, Interval>& box_;
  std::map<NodeId, Interval> known_;
};

/// A lower bound of a node over the declared ranges, by bisection of the positions that it depends on; at
/// most `boxes` parts are looked at. Never above the true minimum. tool.
double lower_bound_of(const Graph& graph, NodeId node, std::size_t boxes);

/// |d node / d channel| at most, over the declared ranges: tables by their steepest piece, choices by either
/// side, steps of comparisons left out. tables: largest slope of each column, per graph node. tool.
class Slopes {
 public:
  Slopes(const Graph& graph, NodeId channel, const std::map<NodeId, double>& table_slopes)
      : graph_(graph), channel_(channel), table_slopes_(table_slopes) {}
  /// This node counts as given: it does not change with the channel.
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
