// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/reversal.h"

#include <vector>

#include "tools/format/columns.h"

namespace vernier::effects {
namespace {

using model::Expr;
using model::Op;

/// A product of a sum: a number times factors that are no sum.
struct Product {
  double number = 1;
  std::vector<const Expr*> factors;
};

constexpr std::size_t kMostProducts = 256;  // a longer sum is one factor

std::vector<Product> products_of(const Expr& expression);

/// The products of a sum or a difference: those of the second operand times `sign`.
std::vector<Product> sum_of(const Expr& expression, double sign) {
  std::vector<Product> sum = products_of(*expression.args[0]);
  for (Product& one : products_of(*expression.args[1])) {
    one.number *= sign;
    sum.push_back(std::move(one));
  }
  return sum;
}

std::vector<Product> product_of(const Expr& expression) {
  const std::vector<Product> left = products_of(*expression.args[0]),
                             right = products_of(*expression.args[1]);
  if (left.size() * right.size() > kMostProducts) return {{1, {&expression}}};
  std::vector<Product> all;
  for (const Product& a : left)
    for (const Product& b : right) {
      Product both{a.number * b.number, a.factors};
      both.factors.insert(both.factors.end(), b.factors.begin(), b.factors.end());
      all.push_back(std::move(both));
    }
  return all;
}

std::vector<Product> products_of(const Expr& expression) {
  double value = 0;
  if (is_constant(expression, value)) return {{value, {}}};
  switch (expression.op) {
    case Op::kAdd:
      return sum_of(expression, 1);
    case Op::kSubtract:
      return sum_of(expression, -1);
    case Op::kMultiply:
      return product_of(expression);
    case Op::kNegate: {
      std::vector<Product> all = products_of(*expression.args[0]);
      for (Product& one : all) one.number = -one.number;
      return all;
    }
    case Op::kDivide:
      if (is_constant(*expression.args[1], value) && value != 0) {
        std::vector<Product> all = products_of(*expression.args[0]);
        for (Product& one : all) one.number /= value;
        return all;
      }
      break;
    default:
      break;
  }
  return {{1, {&expression}}};
}

bool is_direction(const Expr& factor) {
  if (factor.op != Op::kSymbol) return false;
  if (factor.symbol.kind != model::SymbolKind::kUnresolved)
    return factor.symbol.kind == model::SymbolKind::kDirection;
  const std::string prefix = format::entry_of(format::AxisQuantity::kSense).prefix;
  return factor.name.starts_with(prefix) && factor.name.size() > prefix.size();
}

}  // namespace

std::optional<DirectionCoefficient> direction_coefficient(const Expr& expression, const std::string& name) {
  std::optional<DirectionCoefficient> found;
  for (const Product& one : products_of(expression)) {
    if (one.factors.size() != 2) continue;
    const bool first = is_symbol(*one.factors[0], name);
    const Expr &parameter = *one.factors[first ? 0 : 1], &direction = *one.factors[first ? 1 : 0];
    if (!is_symbol(parameter, name) || !is_direction(direction)) continue;
    if (found && found->direction != direction.name) return std::nullopt;
    if (!found) found = DirectionCoefficient{0, direction.name};
    found->factor += one.number;
  }
  return found && found->factor != 0 ? found : std::nullopt;
}

}  // namespace vernier::effects
