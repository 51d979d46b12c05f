// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/machine_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <set>

#include "tools/effects/candidate.h"
#include "tools/effects/input_class.h"

namespace vernier {
namespace {

/// The quantities and functions of a term, written as the catalogue writes them: {q} dir{q} {T} wave exp.
using Tokens = std::set<std::string>;

const char* token_of(Op op) {
  switch (op) {
    case Op::kSin:
    case Op::kCos:
      return "wave";
    case Op::kPower:
      return "power";
    case Op::kNumber:
    case Op::kSymbol:
    case Op::kNegate:
    case Op::kAdd:
    case Op::kSubtract:
    case Op::kMultiply:
    case Op::kDivide:
      return nullptr;
    case Op::kRunIs:
      return "runs";
    default:
      return function_name(op);
  }
}

/// The driven quantity of a name: what stands before the first brace, and the placeholder's class.
std::optional<std::string> token_of_placeholder(const std::string& name) {
  const std::vector<std::string> marks = marks_in(name);
  if (marks.empty()) return is_reserved_word(name) ? std::optional(name) : std::nullopt;
  const std::string mark = marks[0].substr(0, marks[0].find(' '));
  if (mark == "ref" || mark == "mid" || mark == "from" || mark == "to" || mark == "span") return std::nullopt;
  if (mark == "hats" || mark == "runs") return mark;
  return name.substr(0, name.find('{')) + (mark == "S" ? "T" : mark == "sum" ? "q" : mark);
}

Tokens tokens_of_form(const EffectForm& form) {
  Tokens tokens;
  for (const ExprPtr& tree : form.trees)
    walk(*tree, [&](const Expr& node) {
      if (const char* function = token_of(node.op)) tokens.insert(function);
      if (node.op != Op::kSymbol) return;
      if (const auto token = token_of_placeholder(node.name)) tokens.insert(*token);
    });
  return tokens;
}

/// A term of the chain in which something stands whose name is looked for.
struct PlacedTerm {
  DofPlace place;
  Tokens tokens;
  std::optional<std::size_t> axis;  // the first that drives it
};

class Namer {
 public:
  Namer(const Machine& machine, const std::vector<Effect>& catalogue)
      : machine_(machine), catalogue_(catalogue), axes_(machine), base_(base_places(machine)) {
    for (const Effect& effect : catalogue)
      for (const EffectForm& form : effect.forms) forms_.push_back({&effect, &form, tokens_of_form(form)});
  }

  /// Id and label of what acts as `is` says.
  std::pair<std::string, std::string> name(const std::function<bool(const Expr&)>& is, bool hats,
                                           std::optional<std::size_t> axis) const {
    const std::optional<PlacedTerm> term = find_term(is, hats, axis);
    if (!term) return {custom_effect().id, "what no term uses"};
    const Effect* effect = effect_of(*term);
    const std::string id = effect != nullptr ? effect->id : custom_effect().id;
    return {id, label(id, *term)};
  }

  /// A reading times (1 + s) is k*q on the axis' own degree of freedom.
  std::pair<std::string, std::string> name_of_scale(std::size_t axis) const {
    if (!axes_.own(axis)) return {custom_effect().id, "scale factor of " + machine_.axes[axis].name};
    const PlacedTerm term{*axes_.own(axis), {"q"}, axis};
    const Effect* effect = effect_of(term);
    const std::string id = effect != nullptr ? effect->id : custom_effect().id;
    return {id, label(id, term)};
  }

 private:
  struct KnownForm {
    const Effect* effect;
    const EffectForm* form;
    Tokens tokens;
  };

  std::optional<PlacedTerm> find_term(const std::function<bool(const Expr&)>& is, bool hats,
                                      std::optional<std::size_t> axis) const {
    for (const DofPlace& place : all_places(machine_)) {
      const Expr& whole = *transform_at(machine_, place).dof[place.dof];
      if (!any_node(whole, is)) continue;
      PlacedTerm term{place, {}, axis};
      if (hats)
        term.tokens.insert("hats");
      else
        collect(whole, is, term);
      // max(0, 1 - abs(q - station) / width) is a hat.
      if (term.tokens.contains("max") && term.tokens.contains("abs")) {
        for (const char* of_hat : {"max", "abs", "q"}) term.tokens.erase(of_hat);
        term.tokens.insert("hats");
      }
      return term;
    }
    return std::nullopt;
  }

  /// The quantities of the summands in which it stands.
  void collect(const Expr& expr, const std::function<bool(const Expr&)>& is, PlacedTerm& term) const {
    if (expr.op == Op::kAdd || expr.op == Op::kSubtract || expr.op == Op::kNegate) {
      for (const ExprPtr& part : expr.args)
        if (any_node(*part, is)) collect(*part, is, term);
      return;
    }
    walk(expr, [&](const Expr& node) { take(node, term); });
  }

  void take(const Expr& node, PlacedTerm& term) const {
    if (const char* function = token_of(node.op)) term.tokens.insert(function);
    if (node.op != Op::kSymbol) return;
    const Symbol& symbol = node.symbol;
    const auto driven = [&](const char* token) {
      term.tokens.insert(token);
      if (!term.axis) term.axis = symbol.index;
    };
    switch (symbol.kind) {
      case SymbolKind::kAxis:
        return driven("q");
      case SymbolKind::kDirection:
        return driven("dirq");
      case SymbolKind::kVelocity:
        return driven("vq");
      case SymbolKind::kAcceleration:
        return driven("aq");
      case SymbolKind::kSince:
        return driven("sinceq");
      case SymbolKind::kTableValue:
        if (!term.axis) term.axis = symbol.index / 6;
        term.tokens.insert("hats");
        return;
      case SymbolKind::kInput:
        term.tokens.insert(token_of_input(symbol.index));
        return;
      case SymbolKind::kNormal:
        term.tokens.insert("n");
        return;
      case SymbolKind::kFeed:
        term.tokens.insert("feed");
        return;
      case SymbolKind::kCurvature:
        term.tokens.insert("curv");
        return;
      case SymbolKind::kTime:
        term.tokens.insert("t");
        return;
      case SymbolKind::kVisit:
        term.tokens.insert("visit");
        return;
      case SymbolKind::kStatic:
      case SymbolKind::kUnresolved:
        return;
    }
  }

  std::string token_of_input(std::size_t input) const {
    switch (class_of_input(machine_.inputs[input])) {
      case InputClass::kTemperature:
        return "T";
      case InputClass::kLoad:
        return "L";
      case InputClass::kFeature:
        return "F";
      default:
        return "V";
    }
  }

  bool fits(PlaceRule rule, const PlacedTerm& term) const {
    const bool angle = is_angle(machine_, term.place);
    const auto axis = term.axis ? term.axis : axes_.axis_of(term.place);
    const bool own = axis && axes_.is_own(*axis, term.place);
    const bool same = axis && axes_.own(*axis) && axes_.own(*axis)->workpiece == term.place.workpiece &&
                      axes_.own(*axis)->transform == term.place.transform;
    switch (rule) {
      case PlaceRule::kOwn:
      case PlaceRule::kEachAxis:
      case PlaceRule::kPair:
        return own;
      case PlaceRule::kCross:
        return same && !own && !angle;
      case PlaceRule::kTurn:
        return same && !own && angle;
      case PlaceRule::kLength:
        return !angle;
      case PlaceRule::kAngle:
        return angle;
      case PlaceRule::kBase:
      case PlaceRule::kBaseTurn:
        return angle == (rule == PlaceRule::kBaseTurn) &&
               std::find(base_.begin(), base_.end(), term.place) != base_.end();
      case PlaceRule::kSag:
        return true;
      case PlaceRule::kJoint:
        return own && machine_.axes[*axis].rotary;
      case PlaceRule::kNormal:
        return !angle;
    }
    return false;
  }

  /// Where no form acts at such a place: one that does the same somewhere else, of the same kind of freedom.
  bool is_like(PlaceRule rule, const PlacedTerm& term) const {
    return is_angle(machine_, term.place) == (rule == PlaceRule::kTurn || rule == PlaceRule::kAngle) &&
           rule != PlaceRule::kOwn;
  }

  const Effect* effect_of(const PlacedTerm& term) const {
    for (const KnownForm& known : forms_)
      if (known.tokens == term.tokens && fits(known.form->place, term)) return known.effect;
    for (const KnownForm& known : forms_)
      if (known.tokens == term.tokens && is_like(known.form->place, term)) return known.effect;
    return nullptr;
  }

  std::string label(const std::string& id, const PlacedTerm& term) const {
    const std::string place = dof_name(machine_, term.place);
    if (term.axis) return fmt::format("{} of {} in {}", id, machine_.axes[*term.axis].name, place);
    const Transform& transform = transform_at(machine_, term.place);
    const auto carriage = axes_.axis_of(term.place);
    return fmt::format("{} in {} of {}", id, place,
                       carriage ? "the carriage of " + machine_.axes[*carriage].name
                                : fmt::format("transform {}", transform.n)) +
           (term.place.workpiece && !carriage ? " (workpiece)" : "");
  }

  const Machine& machine_;
  const std::vector<Effect>& catalogue_;
  AxisPlaces axes_;
  std::vector<DofPlace> base_;
  std::vector<KnownForm> forms_;
};

class SourceList {
 public:
  SourceList(const Machine& machine, const std::vector<Effect>& catalogue)
      : machine_(machine), nominal_(nominal_machine(machine)), namer_(machine, catalogue) {}

  void take_static(std::size_t index, std::optional<std::size_t> parameter) {
    MachineSource& source = of(namer_.name(
        [&](const Expr& node) {
          return node.op == Op::kSymbol && node.symbol == Symbol{SymbolKind::kStatic, index};
        },
        false, std::nullopt));
    add(source.statics, index);
    if (parameter) source.parameters.push_back(*parameter);
  }

  void take_column(std::size_t table, std::size_t column, std::optional<std::size_t> parameter) {
    const std::size_t axis = machine_.tables[table].axis;
    MachineSource& source = of(namer_.name(
        [&](const Expr& node) {
          return node.op == Op::kSymbol && node.symbol == Symbol{SymbolKind::kTableValue, axis * 6 + column};
        },
        true, axis));
    add(source.columns, std::pair(table, column));
    if (parameter) source.parameters.push_back(*parameter);
  }

  void take_scale(std::size_t axis, std::optional<std::size_t> parameter) {
    MachineSource& source = of(namer_.name_of_scale(axis));
    add(source.scales, axis);
    if (parameter) source.parameters.push_back(*parameter);
  }

  /// What no parameter stands for, and is away from nominal all the same.
  void take_fixed() {
    for (std::size_t i = 0; i < machine_.statics.size(); ++i)
      if (machine_.statics[i].value != nominal_.statics[i].value) take_static(i, std::nullopt);
    for (std::size_t t = 0; t < machine_.tables.size(); ++t)
      for (std::size_t c = 0; c < 6; ++c)
        if (std::any_of(machine_.tables[t].stations.begin(), machine_.tables[t].stations.end(),
                        [&](const Station& station) { return station.value[c] != 0; }))
          take_column(t, c, std::nullopt);
    for (std::size_t a = 0; a < machine_.axes.size(); ++a)
      if (machine_.axes[a].scale_factor != 0) take_scale(a, std::nullopt);
  }

  std::vector<MachineSource> list;

 private:
  template <class Item>
  static void add(std::vector<Item>& items, const Item& item) {
    if (std::find(items.begin(), items.end(), item) == items.end()) items.push_back(item);
  }

  MachineSource& of(const std::pair<std::string, std::string>& id_and_label) {
    for (MachineSource& source : list)
      if (source.name == id_and_label.second) return source;
    list.push_back({id_and_label.second, id_and_label.first, {}, {}, {}, {}});
    return list.back();
  }

  const Machine& machine_;
  Machine nominal_;
  Namer namer_;
};

}  // namespace

std::vector<MachineSource> machine_sources(const Machine& machine, const ParameterSet& parameters,
                                           const std::vector<Effect>& catalogue) {
  SourceList sources(machine, catalogue);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Parameter& one = parameters[p];
    if (one.kind == ParameterKind::kStatic) sources.take_static(one.item, p);
    if (one.kind == ParameterKind::kStation) sources.take_column(one.item, one.column, p);
    if (one.kind == ParameterKind::kScaleFactor) sources.take_scale(one.item, p);
  }
  sources.take_fixed();
  return sources.list;
}

Machine without_source(const Machine& machine, const MachineSource& source) {
  const Machine nominal = nominal_machine(machine);
  Machine without = machine;
  for (const std::size_t i : source.statics) without.statics[i].value = nominal.statics[i].value;
  for (const auto& [table, column] : source.columns)
    for (Station& station : without.tables[table].stations) station.value[column] = 0;
  for (const std::size_t axis : source.scales) without.axes[axis].scale_factor = 0;
  return without;
}

}  // namespace vernier
