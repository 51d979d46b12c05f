// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/probe.h"

namespace vernier {

std::size_t add_probe(Machine& machine, const DofPlace& place) {
  const std::size_t index = machine.statics.size();
  Static probe;
  probe.name = "probe " + std::to_string(index);
  machine.statics.push_back(probe);
  Expr symbol;
  symbol.op = Op::kSymbol;
  symbol.name = probe.name;
  symbol.symbol = {SymbolKind::kStatic, index};
  auto& branch = place.workpiece ? machine.workpiece : machine.tool;
  ExprPtr& dof = branch[place.transform].dof[place.dof];
  dof = make_node(Op::kAdd, {dof, std::make_shared<const Expr>(symbol)});
  return index;
}

}  // namespace vernier
