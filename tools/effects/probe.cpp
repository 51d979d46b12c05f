// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/probe.h"

namespace vernier::effects {

std::size_t add_probe(model::Machine& machine, const DofPlace& place) {
  const std::size_t index = machine.statics.size();
  model::Static probe;
  probe.name = "probe " + std::to_string(index);
  machine.statics.push_back(probe);
  model::Expr symbol;
  symbol.op = model::Op::kSymbol;
  symbol.name = probe.name;
  symbol.symbol = {model::SymbolKind::kStatic, index};
  auto& branch = place.workpiece ? machine.workpiece : machine.tool;
  model::ExprPtr& dof = branch[place.transform].dof[place.dof];
  dof = model::make_node(model::Op::kAdd, {dof, std::make_shared<const model::Expr>(symbol)});
  return index;
}

}  // namespace vernier::effects
