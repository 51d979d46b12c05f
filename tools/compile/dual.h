// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <utility>

#include "tools/compile/types.h"

namespace vernier::compile {

/// A quantity of the chain in two parts: its value in the nominal chain, and the difference actual minus
/// nominal. With these two parts, a small difference of two large numbers is never computed.
struct Dual {
  NodeId nominal;
  NodeId delta;
};

/// Addition (correction) to the command of each axis, mm or deg. The actual chain is evaluated at the command
/// plus this addition; the nominal chain is evaluated at the command.
using Additions = std::map<std::size_t, NodeId>;

/// Converts expressions of the machine file into duals (nominal value and difference).
class Translator {
 public:
  Translator(const model::Machine& machine, Derivation& derivation, Additions added = {})
      : machine_(machine), d_(derivation), g_(derivation.graph), added_(std::move(added)) {}

  /// Throws InputError with the text `text` if the expression has no fixed-point form.
  Dual translate(const model::Expr& expr, const std::string& text, std::size_t line);
  Dual constant(double nominal, double delta) { return {g_.constant(nominal), g_.constant(delta)}; }
  NodeId actual(const Dual& a);
  NodeId channel(ChannelKind kind, std::size_t index);

 private:
  void note(const std::string& text);
  void note_step(const std::string& text);
  Dual visit(const model::Expr& expr);
  Dual symbol(const model::Expr& expr);
  Dual product(const Dual& a, const Dual& b);
  Dual lag(const Dual& u, const Dual& tau);
  NodeId apply_to(model::Op op, NodeId a, NodeId b);
  NodeId power(NodeId base, NodeId exponent);
  void refuse_beyond_numbers(NodeId id) const;
  NodeId whole_power(NodeId base, int n);
  NodeId angle_of(NodeId y, NodeId x);
  NodeId table_value(std::size_t index);

  const model::Machine& machine_;
  Derivation& d_;
  Graph& g_;
  Additions added_;
};

}  // namespace vernier::compile
