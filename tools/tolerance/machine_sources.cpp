// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/machine_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <set>

#include "tools/effects/candidate.h"
#include "tools/effects/input_class.h"
#include "tools/format/columns.h"

namespace vernier::tolerance {
namespace {

/// The quantities and functions of a term, written as in the catalogue: {q} dir{q} {T} wave exp.
using Tokens = std::set<std::string>;

const char* token_of(model::Op op) {
  switch (op) {
    case model::Op::kSin:
    case model::Op::kCos:
      return "wave";
    case model::Op::kPower:
      return "power";
    case model::Op::kNumber:
    case model::Op::kSymbol:
    case model::Op::kNegate:
    case model::Op::kAdd:
    case model::Op::kSubtract:
    case model::Op::kMultiply:
    case model::Op::kDivide:
      return nullptr;
    case model::Op::kRunIs:
      return "runs";
    default:
      return model::function_name(op);
  }
}

/// The driven quantity of a name: the text before the first brace, and the placeholder's class.
std::optional<std::string> token_of_placeholder(const std::string& name) {
  const std::vector<std::string> marks = effects::marks_in(name);
  if (marks.empty()) return model::is_reserved_word(name) ? std::optional(name) : std::nullopt;
  const std::string mark = marks[0].substr(0, marks[0].find(' '));
  if (mark == "ref" || mark == "mid" || mark == "from" || mark == "to" || mark == "span") return std::nullopt;
  if (mark == "hats" || mark == "runs") return mark;
  return name.substr(0, name.find('{')) + (mark == "S" ? "T" : mark == "sum" ? "q" : mark);
}

Tokens tokens_of_form(const effects::EffectForm& form) {
  Tokens tokens;
  for (const model::ExprPtr& tree : form.trees)
    walk(*tree, [&](const model::Expr& node) {
      if (const char* function = token_of(node.op)) tokens.insert(function);
      if (node.op != model::Op::kSymbol) return;
      if (const auto token = token_of_placeholder(node.name)) tokens.insert(*token);
    });
  return tokens;
}

/// A term of the chain that contains the static whose name is searched.
struct PlacedTerm {
  effects::DofPlace place;
  Tokens tokens;
  std::optional<std::size_t> axis;  // the first that drives it
};

class Namer {
 public:
  Namer(const model::Machine& machine, const std::vector<effects::Effect>& catalogue)
      : machine_(machine), axes_(machine), base_(effects::base_places(machine)) {
    for (const effects::Effect& effect : catalogue)
      for (const effects::EffectForm& form : effect.forms)
        forms_.push_back({&effect, &form, tokens_of_form(form)});
  }

  /// Id and label of an effect with the action of `is`.
  std::pair<std::string, std::string> name(const std::function<bool(const model::Expr&)>& is, bool hats,
                                           std::optional<std::size_t> axis) const {
    const std::optional<PlacedTerm> term = find_term(is, hats, axis);
    if (!term) return {effects::custom_effect().id, "used by no term"};
    const effects::Effect* effect = effect_of(*term);
    const std::string id = effect != nullptr ? effect->id : effects::custom_effect().id;
    return {id, label(id, *term)};
  }

  /// A reading times (1 + s) is k*q on the axis' own degree of freedom.
  std::pair<std::string, std::string> name_of_scale(std::size_t axis) const {
    if (!axes_.own(axis)) return {effects::custom_effect().id, "scale factor of " + machine_.axes[axis].name};
    const PlacedTerm term{*axes_.own(axis), {"q"}, axis};
    const effects::Effect* effect = effect_of(term);
    const std::string id = effect != nullptr ? effect->id : effects::custom_effect().id;
    return {id, label(id, term)};
  }

 private:
  struct KnownForm {
    const effects::Effect* effect;
    const effects::EffectForm* form;
    Tokens tokens;
  };

  std::optional<PlacedTerm> find_term(const std::function<bool(const model::Expr&)>& is, bool hats,
                                      std::optional<std::size_t> axis) const {
    for (const effects::DofPlace& place : effects::all_places(machine_)) {
      const model::Expr& whole = *effects::transform_at(machine_, place).dof[place.dof];
      if (!any_node(whole, is)) continue;
      PlacedTerm term{place, {}, axis};
      if (hats)
        term.tokens.insert("hats");
      else
        collect(whole, is, term);
      // max(0, 1 - abs(q - station) / width) is a function of a piecewise linear basis.
      if (term.tokens.contains("max") && term.tokens.contains("abs")) {
        for (const char* of_hat : {"max", "abs", "q"}) term.tokens.erase(of_hat);
        term.tokens.insert("hats");
      }
      return term;
    }
    return std::nullopt;
  }

  /// The quantities of the summands that contain it.
  void collect(const model::Expr& expr, const std::function<bool(const model::Expr&)>& is,
               PlacedTerm& term) const {
    if (expr.op == model::Op::kAdd || expr.op == model::Op::kSubtract || expr.op == model::Op::kNegate) {
      for (const model::ExprPtr& part : expr.args)
        if (any_node(*part, is)) collect(*part, is, term);
      return;
    }
    walk(expr, [&](const model::Expr& node) { take(node, term); });
  }

  void take(const model::Expr& node, PlacedTerm& term) const {
    if (const char* function = token_of(node.op)) term.tokens.insert(function);
    if (node.op != model::Op::kSymbol) return;
    const model::Symbol& symbol = node.symbol;
    const auto driven = [&](const char* token) {
      term.tokens.insert(token);
      if (!term.axis) term.axis = symbol.index;
    };
    switch (symbol.kind) {
      case model::SymbolKind::kAxis:
        return driven("q");
      case model::SymbolKind::kDirection:
        return driven("dirq");
      case model::SymbolKind::kVelocity:
        return driven("vq");
      case model::SymbolKind::kAcceleration:
        return driven("aq");
      case model::SymbolKind::kSince:
        return driven("sinceq");
      case model::SymbolKind::kTableValue:
        if (!term.axis) term.axis = symbol.index / 6;
        term.tokens.insert("hats");
        return;
      case model::SymbolKind::kInput:
        term.tokens.insert(token_of_input(symbol.index));
        return;
      case model::SymbolKind::kNormal:
        term.tokens.insert("n");
        return;
      case model::SymbolKind::kFeed:
        term.tokens.insert(format::columns::kFeed);
        return;
      case model::SymbolKind::kCurvature:
        term.tokens.insert(format::columns::kCurvature);
        return;
      case model::SymbolKind::kTime:
        term.tokens.insert(format::columns::kTime);
        return;
      case model::SymbolKind::kVisit:
        term.tokens.insert(format::columns::kVisit);
        return;
      case model::SymbolKind::kStatic:
      case model::SymbolKind::kUnresolved:
        return;
    }
  }

  std::string token_of_input(std::size_t input) const {
    switch (effects::class_of_input(machine_.inputs[input])) {
      case effects::InputClass::kTemperature:
        return "T";
      case effects::InputClass::kLoad:
        return "L";
      case effects::InputClass::kFeature:
        return "F";
      default:
        return "V";
    }
  }

  bool fits(effects::PlaceRule rule, const PlacedTerm& term) const {
    const bool angle = effects::is_angle(machine_, term.place);
    const auto axis = term.axis ? term.axis : axes_.axis_of(term.place);
    const bool own = axis && axes_.is_own(*axis, term.place);
    const bool same = axis && axes_.own(*axis) && axes_.own(*axis)->workpiece == term.place.workpiece &&
                      axes_.own(*axis)->transform == term.place.transform;
    switch (rule) {
      case effects::PlaceRule::kOwn:
      case effects::PlaceRule::kEachAxis:
      case effects::PlaceRule::kPair:
        return own;
      case effects::PlaceRule::kCross:
        return same && !own && !angle;
      case effects::PlaceRule::kTurn:
        return same && !own && angle;
      case effects::PlaceRule::kLength:
        return !angle;
      case effects::PlaceRule::kAngle:
        return angle;
      case effects::PlaceRule::kBase:
      case effects::PlaceRule::kBaseTurn:
        return angle == (rule == effects::PlaceRule::kBaseTurn) &&
               std::find(base_.begin(), base_.end(), term.place) != base_.end();
      case effects::PlaceRule::kSag:
      case effects::PlaceRule::kLink:
        return true;
      case effects::PlaceRule::kBend:
        return angle;
      case effects::PlaceRule::kJoint:
        return own && machine_.axes[*axis].rotary;
      case effects::PlaceRule::kPoint:
      case effects::PlaceRule::kSeveral:
      case effects::PlaceRule::kNormal:
        return !angle;
    }
    return false;
  }

  /// If no form acts at such a location: a form with the same action at another location, of the same kind of
  /// freedom.
  bool is_like(effects::PlaceRule rule, const PlacedTerm& term) const {
    return effects::is_angle(machine_, term.place) ==
               (rule == effects::PlaceRule::kTurn || rule == effects::PlaceRule::kAngle) &&
           rule != effects::PlaceRule::kOwn;
  }

  const effects::Effect* effect_of(const PlacedTerm& term) const {
    for (const KnownForm& known : forms_)
      if (known.tokens == term.tokens && fits(known.form->place, term)) return known.effect;
    for (const KnownForm& known : forms_)
      if (known.tokens == term.tokens && is_like(known.form->place, term)) return known.effect;
    return nullptr;
  }

  std::string label(const std::string& id, const PlacedTerm& term) const {
    const std::string place = effects::dof_name(machine_, term.place);
    if (term.axis) return fmt::format("{} of {} in {}", id, machine_.axes[*term.axis].name, place);
    const model::Transform& transform = effects::transform_at(machine_, term.place);
    const auto carriage = axes_.axis_of(term.place);
    return fmt::format("{} in {} of {}", id, place,
                       carriage ? "the carriage of " + machine_.axes[*carriage].name
                                : fmt::format("transform {}", transform.n)) +
           (term.place.workpiece && !carriage ? " (workpiece)" : "");
  }

  const model::Machine& machine_;
  effects::AxisPlaces axes_;
  std::vector<effects::DofPlace> base_;
  std::vector<KnownForm> forms_;
};

class SourceList {
 public:
  SourceList(const model::Machine& machine, const std::vector<effects::Effect>& catalogue)
      : machine_(machine), nominal_(model::nominal_machine(machine)), namer_(machine, catalogue) {}

  void take_static(std::size_t index, std::optional<std::size_t> parameter) {
    MachineSource& source = of(namer_.name(
        [&](const model::Expr& node) {
          return node.op == model::Op::kSymbol &&
                 node.symbol == model::Symbol{model::SymbolKind::kStatic, index};
        },
        false, std::nullopt));
    add(source.statics, index);
    if (parameter) source.parameters.push_back(*parameter);
  }

  void take_column(std::size_t table, std::size_t column, std::optional<std::size_t> parameter) {
    const std::size_t axis = machine_.tables[table].axis;
    MachineSource& source = of(namer_.name(
        [&](const model::Expr& node) {
          return node.op == model::Op::kSymbol &&
                 node.symbol == model::Symbol{model::SymbolKind::kTableValue, axis * 6 + column};
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

  /// Errors away from nominal that no parameter represents.
  void take_fixed() {
    for (std::size_t i = 0; i < machine_.statics.size(); ++i)
      if (machine_.statics[i].value != nominal_.statics[i].value) take_static(i, std::nullopt);
    for (std::size_t t = 0; t < machine_.tables.size(); ++t)
      for (std::size_t c = 0; c < 6; ++c)
        if (std::any_of(machine_.tables[t].stations.begin(), machine_.tables[t].stations.end(),
                        [&](const model::Station& station) { return station.value[c] != 0; }))
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

  const model::Machine& machine_;
  model::Machine nominal_;
  Namer namer_;
};

}  // namespace

std::vector<MachineSource> machine_sources(const model::Machine& machine,
                                           const model::ParameterSet& parameters,
                                           const std::vector<effects::Effect>& catalogue) {
  SourceList sources(machine, catalogue);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const model::Parameter& one = parameters[p];
    if (one.kind == model::ParameterKind::kStatic) sources.take_static(one.item, p);
    if (one.kind == model::ParameterKind::kStation) sources.take_column(one.item, one.column, p);
    if (one.kind == model::ParameterKind::kScaleFactor) sources.take_scale(one.item, p);
  }
  sources.take_fixed();
  return sources.list;
}

model::Machine without_source(const model::Machine& machine, const MachineSource& source) {
  const model::Machine nominal = model::nominal_machine(machine);
  model::Machine without = machine;
  for (const std::size_t i : source.statics) without.statics[i].value = nominal.statics[i].value;
  for (const auto& [table, column] : source.columns)
    for (model::Station& station : without.tables[table].stations) station.value[column] = 0;
  for (const std::size_t axis : source.scales) without.axes[axis].scale_factor = 0;
  return without;
}

}  // namespace vernier::tolerance
