// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/symbol_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/derive/numbers.h"
#include "tools/derive/tidy.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/station_table.h"

namespace vernier::derive {
namespace {

using GiNaC::ex;
constexpr int kCubicSteps = 16;  // evaluations between two stations for the largest value of a spline

/// Component errors of ISO 230-1 by the columns X Y Z rX rY rZ of a table.
constexpr std::array<const char*, 6> kIsoPrefix = {"EX", "EY", "EZ", "EA", "EB", "EC"};

ex operation(model::Op op, const ex& a, const ex& b) {
  switch (op) {
    case model::Op::kNegate:
      return -a;
    case model::Op::kAdd:
      return a + b;
    case model::Op::kSubtract:
      return a - b;
    case model::Op::kMultiply:
      return a * b;
    case model::Op::kDivide:
      return a / b;
    case model::Op::kPower:
      return GiNaC::pow(a, b);
    case model::Op::kSin:
      return sine(to_rad(a));
    case model::Op::kCos:
      return cosine(to_rad(a));
    case model::Op::kTan:
      return GiNaC::tan(to_rad(a));
    case model::Op::kAtan2:
      return to_deg(GiNaC::atan2(a, b));
    case model::Op::kSqrt:
      return GiNaC::sqrt(a);
    case model::Op::kExp:
      return GiNaC::exp(a);
    case model::Op::kLog:
      return GiNaC::log(a);
    default:
      throw std::logic_error("the machine file contains an operation that the derivation does not support");
  }
}

bool is_opaque(model::Op op) {
  return op == model::Op::kEqual || op == model::Op::kLess || op == model::Op::kGreater ||
         op == model::Op::kAbs || op == model::Op::kSign || op == model::Op::kMin || op == model::Op::kMax ||
         op == model::Op::kLag || op == model::Op::kRunIs;
}

}  // namespace

SymbolBook::SymbolBook(const model::Machine& machine) : machine_(machine) { find_turning_statics(); }

void SymbolBook::find_turning_statics() {
  for (const auto* branch : {&machine_.workpiece, &machine_.tool})
    for (const model::Transform& transform : *branch)
      for (std::size_t i = 0; i < transform.dof_count(); ++i) {
        const bool turns = transform.kind == model::TransformKind::kSixDof ? i >= 3 : i == 0 || i == 3;
        if (!turns) continue;
        model::walk(*transform.dof[i], [&](const model::Expr& node) {
          if (node.op == model::Op::kSymbol && node.symbol.kind == model::SymbolKind::kStatic)
            turning_.insert(node.symbol.index);
        });
      }
}

ex SymbolBook::value(const model::Expr& expr) {
  if (expr.op == model::Op::kNumber) return exact_number(expr.number);
  if (expr.op == model::Op::kSymbol) return symbol_value(expr);
  if (is_opaque(expr.op)) return opaque_value(expr);
  const ex first = value(*expr.args[0]);  // in order: errors are listed in the order of their first use
  return operation(expr.op, first, expr.args.size() > 1 ? value(*expr.args[1]) : ex(0));
}

ex SymbolBook::symbol_value(const model::Expr& expr) {
  const model::Symbol& key = expr.symbol;
  if (key.kind == model::SymbolKind::kTableValue && machine_.table_of(key.index / 6) == nullptr) return 0;
  const auto place = std::pair(static_cast<int>(key.kind), key.index);
  if (const auto found = known_.find(place); found != known_.end()) return found->second;
  ex result;
  if (key.kind == model::SymbolKind::kStatic) {
    result = static_value(key.index);
  } else if (key.kind == model::SymbolKind::kAxis) {
    result = axis_value(key.index);
  } else if (key.kind == model::SymbolKind::kTableValue) {
    const bool angle = key.index % 6 >= 3;
    const ex error = error_symbol(key, kIsoPrefix[key.index % 6] + machine_.axes[key.index / 6].name,
                                  expr.name, angle ? "rad" : "mm", angle ? maths::kDegPerRad : 1);
    result = angle ? to_deg(error) : error;
  } else {
    result = nominal_symbol(key, expr.name, model::symbol_unit(machine_, key), 1);
  }
  return known_.emplace(place, result).first->second;
}

ex SymbolBook::static_value(std::size_t index) {
  const model::Static& s = machine_.statics[index];
  const model::Symbol key{model::SymbolKind::kStatic, index};
  const double at = s.nominal.value_or(s.value);
  const bool error = s.nominal.has_value() || !s.hidden;
  ex at_nominal = exact_number(at);
  if (turning_.contains(index)) {
    if (at != 0)
      notes.push_back(fmt::format(
          "this static rotates a frame, so the equation contains its nominal angle as a number: {}", s.name));
  } else if (!error || at != 0) {
    at_nominal = nominal_symbol(key, s.name, s.unit, 1);
  }
  if (!error) return at_nominal;
  if (!s.nominal)
    notes.push_back(
        fmt::format("this static has no nominal, so the equation uses its value as the nominal: {}", s.name));
  const bool plain = at == 0;
  return at_nominal + error_symbol(key, plain ? s.name : "d_" + s.name, s.name, s.unit, 1);
}

ex SymbolBook::axis_value(std::size_t index) {
  const model::Axis& axis = machine_.axes[index];
  const model::Symbol key{model::SymbolKind::kAxis, index};
  ex position =
      nominal_symbol(key, axis.name, axis.rotary ? "rad" : "mm", axis.rotary ? maths::kDegPerRad : 1);
  if (axis.rotary) position = to_deg(position);
  if (axis.scale_factor == 0) return position;
  return position * (1 + error_symbol(key, "s_" + axis.name, "scalefactor of " + axis.name, "", 1));
}

ex SymbolBook::opaque_value(const model::Expr& expr) {
  const std::string text = "(" + model::to_text(expr) + ")";
  if (const auto found = known_opaque_.find(text); found != known_opaque_.end()) return found->second;
  std::vector<ex> args;
  for (const model::ExprPtr& arg : expr.args) args.push_back(value(*arg));
  const GiNaC::realsymbol name(text);
  ex result = name;
  // If an error acts inside, the derivative gets its own symbol. That is correct if its factor is
  // zero in the nominal chain. Otherwise rough_word() finds it.
  for (const ErrorParameter& p : parameters)
    if (std::any_of(args.begin(), args.end(), [&](const ex& a) { return a.has(p.symbol); })) {
      rough_.emplace_back(GiNaC::realsymbol("D_" + p.name + text), text);
      result += rough_.back().first * p.symbol;
    }
  opaque.push_back({name, std::make_shared<const model::Expr>(expr), std::move(args)});
  return known_opaque_.emplace(text, result).first->second;
}

std::string SymbolBook::rough_word(const ex& coefficient) const {
  for (const auto& [symbol, text] : rough_)
    if (coefficient.has(symbol)) return text;
  return {};
}

std::string SymbolBook::free_name(const std::string& wanted, const std::string& other) {
  const auto is_free = [&](const std::string& name) { return !names_.contains(name); };
  std::string name = is_free(wanted) ? wanted : other;
  while (!is_free(name)) name += "_";
  names_.insert(name);
  return name;
}

ex SymbolBook::nominal_symbol(const model::Symbol& key, const std::string& name, const std::string& unit,
                              double file_units) {
  const std::string unique = free_name(name, name + "_nominal");
  nominal.push_back({GiNaC::realsymbol(unique), unique, key, unit, file_units});
  return nominal.back().symbol;
}

ex SymbolBook::error_symbol(const model::Symbol& key, const std::string& name, const std::string& source,
                            const std::string& unit, double file_units) {
  ErrorParameter p;
  p.name = free_name(name, "d_" + source);
  p.symbol = GiNaC::realsymbol(p.name);
  p.source = source;
  p.key = key;
  p.unit = unit;
  p.file_units = file_units;
  parameters.push_back(p);
  return parameters.back().symbol;
}

std::string SymbolBook::inferred_unit(const ErrorParameter& p,
                                      const std::vector<ElementaryMotion>& motions) const {
  bool turns = false, shifts = false;
  for (const ElementaryMotion& motion : motions) {
    if (!motion.value.has(p.symbol)) continue;
    // If the static acts alone by a number (or a number times pi/180), its unit is that of the
    // motion.
    const ex slope = motion.value.diff(p.symbol);
    const ex plain = motion.rotation ? (slope * 180 / GiNaC::Pi).expand() : slope.expand();
    if (!GiNaC::is_a<GiNaC::numeric>(plain)) return "";
    (motion.rotation ? turns : shifts) = true;
  }
  if (turns == shifts) return "";
  return turns ? "deg" : "mm";
}

void SymbolBook::settle_units(std::vector<ElementaryMotion>& motions) {
  GiNaC::exmap to_radians;
  for (ErrorParameter& p : parameters) {
    if (p.key.kind != model::SymbolKind::kStatic) continue;
    if (p.unit.empty()) p.unit = inferred_unit(p, motions);
    if (p.unit != "deg") continue;
    p.unit = "rad";
    p.file_units = maths::kDegPerRad;
    to_radians[p.symbol] = to_deg(p.symbol);
  }
  for (NominalSymbol& n : nominal) {
    if (n.key.kind != model::SymbolKind::kStatic || n.unit != "deg") continue;
    n.unit = "rad";
    n.file_units = maths::kDegPerRad;
    to_radians[n.symbol] = to_deg(n.symbol);
  }
  if (to_radians.empty()) return;
  for (ElementaryMotion& motion : motions)
    motion.value = expand_inside(motion.value.subs(to_radians, GiNaC::subs_options::no_pattern));
  for (OpaqueSymbol& o : opaque)
    for (ex& arg : o.args) arg = arg.subs(to_radians, GiNaC::subs_options::no_pattern);
}

double SymbolBook::file_size(const ErrorParameter& p) const {
  if (p.key.kind == model::SymbolKind::kAxis) return std::abs(machine_.axes[p.key.index].scale_factor);
  if (p.key.kind == model::SymbolKind::kStatic) {
    const model::Static& s = machine_.statics[p.key.index];
    return std::abs(s.value - s.nominal.value_or(s.value)) / p.file_units;
  }
  const model::Table& table = *machine_.table_of(p.key.index / 6);
  const std::size_t column = p.key.index % 6;
  double largest = 0;
  for (std::size_t i = 0; i < table.stations.size(); ++i) {
    largest = std::max(largest, std::abs(table.stations[i].value[column]));
    if (table.interpolation != model::Interpolation::kCubic || i == 0) continue;
    const double from = table.stations[i - 1].loc, to = table.stations[i].loc;
    for (int k = 1; k < kCubicSteps; ++k)  // a spline may exceed its stations
      largest = std::max(largest,
                         std::abs(model::table_values(table, from + (to - from) * k / kCubicSteps)[column]));
  }
  return largest / p.file_units;
}

void SymbolBook::settle_sizes(const ErrorSizes& sizes) {
  for (ErrorParameter& p : parameters) {
    p.magnitude = file_size(p);
    p.from_file = p.magnitude > 0;
    if (p.from_file) continue;
    p.magnitude = p.unit == "mm" ? sizes.length_mm : p.unit == "rad" ? sizes.angle_rad : sizes.number;
  }
}

}  // namespace vernier::derive
