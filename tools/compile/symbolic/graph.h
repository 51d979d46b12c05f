// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "comp/compensator.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/compile/symbolic/interval.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Index of a node in the graph of the error equation.
using NodeId = std::uint32_t;

/// Operation of a node on real numbers, in the units of the machine file (mm, deg, s, mm/min ...).
enum class NodeKind : std::uint8_t {
  kConstant,  // value: number
  kChannel,   // channel: kind and index[0]
  kSum,       // number + sum of coefficient * node
  kProduct,   // args[0] * args[1]
  kTable,     // column index[1] of the table of axis index[0], at args[0] (the raw position)
  kFunction,  // smooth function of args[0]
  kAbs,
  kMin,
  kMax,
  kSign,
  kEqual,
  kLess,
  kLag,  // first-order lag of args[0] with the time constant `number` (s)
};

struct Term {
  double coefficient;
  NodeId node;
  auto operator<=>(const Term&) const = default;
};

struct Node {
  NodeKind kind = NodeKind::kConstant;
  double number = 0;
  ChannelKind channel = ChannelKind::kPosition;
  Function function = Function::kSin;
  std::uint32_t index[2] = {0, 0};
  std::vector<NodeId> args;
  std::vector<Term> terms;  // terms of a kSum: at least one; sorted by node
  Interval range;
};

/// The error equation as a graph of real-valued operations. Equal operations are one node of the graph
/// (hash-consing). The graph simplifies new nodes: operations on constants are computed, zeros are removed,
/// nested sums are joined, and like terms are collected. Nodes are never removed. A node that no output uses
/// needs no computing time.
class Graph {
 public:
  NodeId constant(double value);
  /// `range`: the possible readings of the channel, in the unit of the machine file.
  NodeId channel(ChannelKind kind, std::uint32_t index, const Interval& range);
  NodeId sum(double constant_part, const std::vector<Term>& terms);
  NodeId product(NodeId a, NodeId b);
  NodeId table(std::uint32_t axis, std::uint32_t column, NodeId position, const Interval& range);
  /// Throws std::domain_error if the function is undefined for a value in the range of the argument.
  NodeId function(Function f, NodeId argument);
  /// `kind`: kAbs, kSign (both do not use b), kMin, kMax, kEqual or kLess.
  NodeId choice(NodeKind kind, NodeId a, NodeId b);
  NodeId lag(NodeId input, double tau_s);

  NodeId add(NodeId a, NodeId b) { return sum(0, {{1, a}, {1, b}}); }
  NodeId subtract(NodeId a, NodeId b) { return sum(0, {{1, a}, {-1, b}}); }
  NodeId scale(double k, NodeId a) { return sum(0, {{k, a}}); }

  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return nodes_.size(); }
  bool is_zero(NodeId id) const { return nodes_[id].kind == NodeKind::kConstant && nodes_[id].number == 0; }
  std::optional<double> constant_value(NodeId id) const;

  /// Returns d node / d channel if this slope is constant; nullopt if the slope varies or is unknown.
  std::optional<double> constant_slope(NodeId id, NodeId channel) const;

  bool depends_on(NodeId id, NodeId other) const;

 private:
  NodeId intern(Node node);

  std::vector<Node> nodes_;
  using Key = std::tuple<NodeKind, double, int, int, std::uint32_t, std::uint32_t, std::vector<NodeId>,
                         std::vector<Term>>;
  std::map<Key, NodeId> known_;
};

/// Returns the range of the result of a choice (kAbs, kSign, kMin, kMax, kEqual, kLess).
Interval range_of_choice(NodeKind kind, const Interval& a, const Interval& b);

}  // namespace vernier::compile
