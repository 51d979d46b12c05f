// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/numeric.h"

#include <Eigen/Geometry>

#include "tools/derive/symbol_ranges.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"

namespace vernier::derive {
namespace {

/// The machine's own name of a nominal symbol, as an expression.
model::ExprPtr expression_of(const model::Machine& machine, const model::Symbol& key) {
  model::Expr expr;
  expr.op = model::Op::kSymbol;
  expr.name = model::symbol_name(machine, key);
  expr.symbol = key;
  return std::make_shared<const model::Expr>(std::move(expr));
}

}  // namespace

Eigen::MatrixXd sensitivity_at(const ErrorEquation& equation, const model::States& states, std::size_t row) {
  const model::Machine nominal = model::nominal_machine(equation.machine);
  const auto at = static_cast<Eigen::Index>(row);
  Ranges point;  // every symbol at one value
  const auto put = [&](const GiNaC::symbol& symbol, const model::Expr& expr, double file_units) {
    const double value = model::evaluate(nominal, expr, states)[at] / file_units;
    point[symbol] = {value, value};
  };
  for (const NominalSymbol& n : equation.nominal) put(n.symbol, *expression_of(nominal, n.key), n.file_units);
  for (const OpaqueSymbol& o : equation.opaque) put(o.symbol, *o.expr, 1);
  for (const Abbreviation& a : equation.abbreviations) point[a.symbol] = range_of(a.value, point);
  Eigen::MatrixXd result(6, static_cast<Eigen::Index>(equation.parameters.size()));
  for (Eigen::Index p = 0; p < result.cols(); ++p)
    for (Eigen::Index i = 0; i < 6; ++i) {
      const compile::Interval value =
          range_of(equation.sensitivity[static_cast<std::size_t>(p)][static_cast<std::size_t>(i)], point);
      result(i, p) = (value.low + value.high) / 2;
    }
  return result;
}

model::Machine with_errors(const ErrorEquation& equation, const Eigen::VectorXd& errors) {
  model::Machine machine = model::nominal_machine(equation.machine);
  for (std::size_t p = 0; p < equation.parameters.size(); ++p) {
    const ErrorParameter& parameter = equation.parameters[p];
    const double value = errors[static_cast<Eigen::Index>(p)] * parameter.file_units;
    const std::size_t index = parameter.key.index;
    if (parameter.key.kind == model::SymbolKind::kStatic) {
      machine.statics[index].value += value;
    } else if (parameter.key.kind == model::SymbolKind::kAxis) {
      machine.axes[index].scale_factor = value;
    } else {
      for (model::Table& table : machine.tables)
        if (table.axis == index / 6)
          for (model::Station& station : table.stations) station.value[index % 6] = value;
    }
  }
  return machine;
}

}  // namespace vernier::derive
