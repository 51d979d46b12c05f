// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/products.h"

#include <algorithm>
#include <cmath>

#include "tools/format/columns.h"

namespace vernier::diagnose {
namespace {

/// A recorded quantity as a factor of a term.
struct ProductFactor {
  model::ExprPtr value;
  std::string input, unit;  // name and unit where it is an input
  bool is_sense = false;    // +1 or -1
};

/// An input minus its reference.
ProductFactor input_factor(const Evidence& evidence, std::size_t index) {
  const model::Input& input = evidence.machine().inputs[index];
  return {model::subtract_number(model::make_symbol(input.name), evidence.reference_of(index)), input.name,
          input.unit, false};
}

std::vector<ProductFactor> factors_of(const Evidence& evidence) {
  const model::Machine& machine = evidence.machine();
  const model::States& s = evidence.measurement().states;
  std::vector<ProductFactor> list;
  const auto take = [&](const model::ExprPtr& value, const model::Column& column) {
    if (evidence.varies(column)) list.push_back({value, {}, {}, false});
  };
  const auto take_named = [&](const std::string& name, const model::Column& column) {
    take(model::make_symbol(name), column);
  };
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const std::string& name = machine.axes[i].name;
    if (machine.axes[i].rotary) {
      take(model::make_node(model::Op::kSin, {model::make_symbol(name)}), evidence.position(i));
      take(model::make_node(model::Op::kCos, {model::make_symbol(name)}), evidence.position(i));
    } else {
      take_named(name, evidence.position(i));
    }
    if (evidence.varies(s.direction[i]))
      list.push_back(
          {model::make_symbol(format::axis_column(format::AxisQuantity::kSense, name)), {}, {}, true});
    take_named(format::axis_column(format::AxisQuantity::kSpeed, name), s.velocity[i]);
    take_named(format::axis_column(format::AxisQuantity::kAcceleration, name), s.acceleration[i]);
  }
  take_named(format::columns::kFeed, s.feed);
  take_named(format::columns::kCurvature, s.curvature);
  // Not the time and the number of visits: a polynomial of them holds for no other record.
  for (std::size_t i = 0; i < machine.inputs.size(); ++i)
    if (evidence.varies(s.input[i]) &&
        effects::class_of_input(machine.inputs[i]) != effects::InputClass::kSetpoint)
      list.push_back(input_factor(evidence, i));
  return list;
}

ScannedCandidate as_candidate(const model::Machine& machine, const effects::AxisPlaces& axes,
                              const Product& product) {
  effects::Choice choice;
  choice.effect = &effects::custom_effect();
  choice.form = &effects::custom_effect().forms[0];
  choice.place = product.place;
  choice.term = model::to_text(*product.term);
  choice.inputs = product.inputs;
  choice.units = product.units;
  ScannedCandidate item;
  item.candidate = effects::make_candidate(machine, axes, choice);
  return item;
}

constexpr std::size_t kMostFactors = 3;  // a search does not find a physical law of four quantities

std::size_t factors_in(const model::Expr& term) {
  std::size_t count = 0;
  model::walk(term, [&](const model::Expr& node) { count += node.op == model::Op::kMultiply ? 1 : 0; });
  return count;
}

/// An approach direction (+1 or -1) times itself is 1, so the product is a simpler term.
bool would_cancel(const model::Expr& term, const ProductFactor& factor) {
  if (!factor.is_sense) return false;
  const std::string name = model::to_text(*factor.value);
  bool found = false;
  model::walk(term, [&](const model::Expr& node) {
    found = found || (node.op == model::Op::kSymbol && model::to_text(node) == name);
  });
  return found;
}

Product with_factor(Product product, const ProductFactor& factor) {
  product.term = model::make_node(model::Op::kMultiply, {product.term, factor.value});
  if (!factor.input.empty() &&
      std::find(product.inputs.begin(), product.inputs.end(), factor.input) == product.inputs.end()) {
    product.inputs.push_back(factor.input);
    product.units.push_back(factor.unit);
  }
  return product;
}

}  // namespace

std::vector<ScannedCandidate> enumerate_products(const Evidence& evidence,
                                                 const std::vector<Product>& extend) {
  const std::vector<ProductFactor> factors = factors_of(evidence);
  const effects::AxisPlaces axes(evidence.machine());
  std::vector<ScannedCandidate> list;
  if (!extend.empty()) {
    for (const Product& product : extend)
      for (const ProductFactor& factor : factors)
        if (factors_in(*product.term) < kMostFactors && !would_cancel(*product.term, factor))
          list.push_back(as_candidate(evidence.machine(), axes, with_factor(product, factor)));
    return list;
  }
  for (const effects::DofPlace& place : distinct_places(evidence, false))
    for (std::size_t i = 0; i < factors.size(); ++i) {
      const Product one = with_factor({place, model::make_symbol("k"), {}, {}}, factors[i]);
      list.push_back(as_candidate(evidence.machine(), axes, one));
      for (std::size_t k = i; k < factors.size(); ++k)
        if (!would_cancel(*one.term, factors[k]))
          list.push_back(as_candidate(evidence.machine(), axes, with_factor(one, factors[k])));
    }
  return list;
}

}  // namespace vernier::diagnose
