// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/candidate.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <sstream>

#include "tools/effects/gravity.h"
#include "tools/effects/input_class.h"
#include "tools/effects/spoken.h"
#include "tools/format/columns.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"
#include "tools/text/xml_text.h"

namespace vernier::effects {
namespace {

/// Returns the text without the characters that a name may not have.
std::string plain(std::string_view text) {
  std::string name;
  for (const char c : text)
    name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
  return name;
}

model::ExprPtr sum_of(const std::vector<model::ExprPtr>& parts) {
  model::ExprPtr sum = parts.at(0);
  for (std::size_t i = 1; i < parts.size(); ++i) sum = model::make_node(model::Op::kAdd, {sum, parts[i]});
  return sum;
}

bool is_product(const model::Expr& expr) {
  return expr.op == model::Op::kMultiply || expr.op == model::Op::kDivide;
}

/// A product with its first factor negated: "-k*X".
model::ExprPtr with_first_negated(const model::ExprPtr& expr) {
  if (!is_product(*expr)) return model::make_node(model::Op::kNegate, {expr});
  return model::make_node(expr->op, {with_first_negated(expr->args[0]), expr->args[1]});
}

model::ExprPtr negative(const model::ExprPtr& expr) {
  const model::Expr* first = expr.get();
  while (is_product(*first)) first = first->args[0].get();
  return first->op == model::Op::kNegate ? model::make_node(model::Op::kNegate, {expr})
                                         : with_first_negated(expr);
}

/// Computes terms and unknowns of one choice. Every placeholder and every unknown of the form's
/// tree is replaced by its value from the choice and the machine.
class Maker {
 public:
  Maker(const model::Machine& machine, const AxisPlaces& axes, const Choice& choice)
      : machine_(machine), axes_(axes), choice_(choice) {
    for (const model::Static& item : machine.statics) taken_.insert(item.name);
    for (const model::Axis& item : machine.axes) taken_.insert(item.name);
    for (const model::Input& item : machine.inputs) taken_.insert(item.name);
    for (const std::string& name : choice.inputs) taken_.insert(name);
  }

  Candidate make() {
    settle_reference();
    result_.choice = choice_;
    const std::vector<TermAt> terms = terms_to_fill();
    if (terms.empty()) missing("a degree of freedom at which the effect acts");
    name_unknowns(terms);
    for (const TermAt& term : terms) {
      const model::ExprPtr filled = fill(term);
      result_.terms.push_back({term.place, model::to_text(term.negated ? *negative(filled) : *filled)});
    }
    result_.label = label();
    result_.spoken = spoken_name(machine_, axes_, result_);
    return std::move(result_);
  }

 private:
  /// A form's tree and its location.
  struct TermAt {
    DofPlace place;
    model::ExprPtr tree;
    std::optional<std::size_t> axis;
    bool negated = false;  // terms that share a coefficient have the same sign along the machine's motion
    const char* normal = nullptr;  // {n}
  };

  [[noreturn]] void missing(const std::string& what) const {
    throw text::InputError(choice_.effect->id + ": " + what + " is missing");
  }

  bool is_custom() const { return choice_.effect == &custom_effect(); }

  /// The reference that a term subtracts is the declared reference of the input. The term is 0
  /// there.
  void settle_reference() {
    if (choice_.reference || choice_.inputs.empty() || !choice_.form->asks_for("ref")) return;
    choice_.reference = standard_reference(choice_.units.empty() ? "" : choice_.units[0]);
    if (const auto known = machine_.find_input(choice_.inputs[0]))
      choice_.reference = machine_.inputs[*known].reference;
  }

  std::vector<model::ExprPtr> trees() const {
    return is_custom() ? std::vector{found_tree(choice_.term)} : choice_.form->trees;
  }

  model::ExprPtr found_tree(const std::string& term) const {
    try {
      return model::parse_expression(term);
    } catch (const model::ExpressionError& error) {
      throw text::InputError(choice_.effect->id + ": \"" + error.word + "\": " + error.what() +
                             ", in its term");
    }
  }

  /// Reads the found terms of one transform: "X:k1*Z|Z:k2".
  std::vector<TermAt> found_terms() const {
    if (!choice_.place) missing("branch or transform");
    const model::Transform& at = transform_at(machine_, *choice_.place);
    std::vector<TermAt> terms;
    std::istringstream parts(choice_.term);
    for (std::string part; std::getline(parts, part, '|');) {
      const auto colon = part.find(':');
      if (colon == std::string::npos) missing("\"DOF:\" before a term");
      const std::string name = text::trimmed(part.substr(0, colon));
      std::optional<DofPlace> place;
      for (std::size_t d = 0; d < at.dof_count(); ++d)
        if (text::equal_no_case(at.dof_name(d), name))
          place = DofPlace{choice_.place->workpiece, choice_.place->transform, d};
      if (!place) missing(fmt::format("a degree of freedom of the transform named \"{}\"", name));
      terms.push_back({*place, found_tree(part.substr(colon + 1)), choice_.axis});
    }
    return terms;
  }

  /// True for k1, k2 … of found terms, which all follow the rule of k.
  bool is_numbered(const std::string& name) const {
    return choice_.effect->has_found_terms() && name.size() > 1 && name.front() == 'k' &&
           name.find_first_not_of("0123456789", 1) == std::string::npos;
  }

  std::vector<TermAt> terms_to_fill() const {
    const std::vector<model::ExprPtr> form = trees();
    std::vector<TermAt> terms;
    const auto at_own = [&](std::size_t axis, const model::ExprPtr& tree) {
      if (const auto& own = axes_.own(axis)) terms.push_back({*own, tree, axis, axes_.sense(axis) < 0});
    };
    switch (choice_.form->place) {
      case PlaceRule::kEachAxis:
        for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) at_own(axis, form[0]);
        break;
      case PlaceRule::kPair:
        if (form.size() != 2) missing("\"|\" in the term of a pair");
        if (!choice_.axis || !choice_.axis2) missing("axis or axis2");
        at_own(*choice_.axis, form[0]);
        at_own(*choice_.axis2, form[1]);
        if (terms.size() != 2) missing("the degree of freedom of an axis");
        break;
      case PlaceRule::kNormal: {
        const std::vector<DofPlace> base = base_places(machine_);
        // The workpiece branch is inverted in the chain: a forward motion of it moves the point
        // back.
        for (std::size_t i = 0; i < base.size(); ++i)
          terms.push_back(
              {base[i], form[0], std::nullopt, base[i].workpiece, format::columns::kNormal.at(i)});
        break;
      }
      case PlaceRule::kPoint:
        if (!choice_.place) missing("branch or transform");
        if (transform_at(machine_, *choice_.place).kind != model::TransformKind::kSixDof)
          missing("a transform `sixdof`, because the effect acts at three lengths,");
        for (std::size_t d = 0; d < 3; ++d)
          terms.push_back(
              {{choice_.place->workpiece, choice_.place->transform, d}, form.at(d), std::nullopt});
        break;
      case PlaceRule::kSeveral:
        return found_terms();
      case PlaceRule::kBend:
        if (!choice_.place || !choice_.toward) missing("transform or toward");
        if (transform_at(machine_, *choice_.place).kind != model::TransformKind::kSixDof)
          missing("a transform `sixdof`, because the effect is a rotation about two axes,");
        for (std::size_t d = 0; d < 3; ++d)
          if (d != *choice_.toward)
            terms.push_back(
                {{choice_.place->workpiece, choice_.place->transform, 3 + d}, form[0], choice_.axis});
        break;
      default:
        if (!choice_.place) missing("branch, transform or dof");
        terms.push_back({*choice_.place, form[0], choice_.axis});
    }
    return terms;
  }

  model::ExprPtr fill(const TermAt& term) const {
    return model::substitute(term.tree, [&](const std::string& name) -> model::ExprPtr {
      if (const auto unknown = final_name_.find(name); unknown != final_name_.end())
        return model::make_symbol(unknown->second);
      const std::vector<std::string> marks = marks_in(name);
      if (marks.empty()) {
        check_name(name);
        return nullptr;
      }
      if (name.front() == '{' && marks.size() == 1 && name.size() == marks[0].size() + 2)
        return value_of(marks[0], term);
      // dir{q}, v{q}, lag of an input: a name that contains another name.
      std::string whole = name;
      for (const std::string& mark : marks)
        whole.replace(whole.find('{'), mark.size() + 2, model::to_text(*value_of(mark, term)));
      check_name(whole);
      return model::make_symbol(whole);
    });
  }

  /// Returns the expression that replaces a placeholder.
  model::ExprPtr value_of(const std::string& mark, const TermAt& term) const {
    if (mark == "q") return model::make_symbol(axis_of(term));
    if (mark == "T" || mark == "L" || mark == "F" || mark == "V") return model::make_symbol(input(0));
    if (mark == "S") return model::make_symbol(input(1));
    if (mark == "ref")
      return model::make_number(choice_.reference ? *choice_.reference : (missing("input"), 0));
    if (mark == "from") return model::make_number(choice_.from);
    if (mark == "to") return model::make_number(choice_.to);
    if (mark == "mid") return model::make_number(0.5 * (choice_.from + choice_.to));
    if (mark == "span") return model::make_number(choice_.to - choice_.from);
    if (mark == "n")
      return model::make_symbol(term.normal == nullptr ? (missing("place normal"), "") : term.normal);
    if (mark == "runs") return steps();
    if (mark == "sum") {
      if (choice_.sum.empty()) missing("sum");
      return model::parse_expression(choice_.sum);
    }
    if (const auto pull = gravity_of(mark, term.place)) return pull;
    return hats(axis_of(term));
  }

  /// Returns the gravity function at the location, as a function of the axes. Returns null for a
  /// placeholder that is not a gravity function.
  model::ExprPtr gravity_of(const std::string& mark, const DofPlace& place) const {
    if (mark != "moment" && mark != "along" && mark.rfind("across", 0) != 0) return nullptr;
    if (!gravity_) gravity_.emplace(machine_);
    const std::size_t own = local_axis(machine_, place);
    std::optional<Wave> wave;
    if ((mark == "along") == is_angle(machine_, place)) missing(mark == "along" ? "a length" : "an angle");
    if (mark == "along") {
      wave = gravity_->along(place);
    } else if (mark == "moment") {
      if (!choice_.mass) missing("mass");
      wave = gravity_->moment(place, *choice_.mass);
    } else {
      if (mark == "across" && !choice_.toward) missing("toward");
      const std::size_t next = mark == "across2" ? 2 : 1;
      wave = gravity_->across(place, mark == "across" ? *choice_.toward : (own + next) % 3);
    }
    if (!wave) missing("a chain of rotations from the base to this location, each proportional to one axis,");
    // A constant bend by gravity cannot be distinguished from the shape of the part.
    if (wave->is_constant() && choice_.form->place != PlaceRule::kBend)
      missing(
          "a location at which an axis changes the effect of gravity (here the effect of gravity is the same "
          "at every pose),");
    return wave->expression(machine_);
  }

  const std::string& axis_of(const TermAt& term) const {
    if (!term.axis) missing("axis");
    return machine_.axes[*term.axis].name;
  }

  const std::string& input(std::size_t index) const {
    if (choice_.inputs.size() <= index) missing(index == 0 ? "input" : "input2");
    return choice_.inputs[index];
  }

  /// Returns h1·hat1 + h2·hat2 …: a piecewise linear basis over the range.
  model::ExprPtr hats(const std::string& axis) const {
    const std::size_t count = choice_.form->hats;
    if (!(choice_.to > choice_.from)) missing("from or to (the range of the axis)");
    const double width = (choice_.to - choice_.from) / static_cast<double>(count - 1);
    std::vector<model::ExprPtr> parts;
    for (std::size_t i = 0; i < count; ++i) {
      const double node = choice_.from + width * static_cast<double>(i);
      const model::ExprPtr away =
          model::make_node(model::Op::kAbs, {model::subtract_number(model::make_symbol(axis), node)});
      const model::ExprPtr falling = model::make_node(
          model::Op::kSubtract,
          {model::make_number(1), model::make_node(model::Op::kDivide, {away, model::make_number(width)})});
      parts.push_back(model::make_node(
          model::Op::kMultiply, {model::make_symbol(final_name_.at(fmt::format("h{}", i + 1))),
                                 model::make_node(model::Op::kMax, {model::make_number(0), falling})}));
    }
    return sum_of(parts);
  }

  /// Returns h1·run("a") + h2·run("b") …
  model::ExprPtr steps() const {
    std::vector<model::ExprPtr> parts;
    const std::vector<std::string> names = names_of_steps();
    for (std::size_t i = 0; i < names.size(); ++i)
      parts.push_back(model::make_node(model::Op::kMultiply, {model::make_symbol(final_name_.at(names[i])),
                                                              model::make_run(choice_.runs[i])}));
    return sum_of(parts);
  }

  std::vector<std::string> names_of_steps() const {
    if (choice_.runs.empty()) missing("runs");
    if (choice_.runs.size() == 1) return {"h"};
    std::vector<std::string> names;
    for (std::size_t i = 0; i < choice_.runs.size(); ++i) names.push_back(fmt::format("h{}", i + 1));
    return names;
  }

  /// Returns the unknowns of the form's terms by their names in the form, in the order of the
  /// expression.
  std::vector<std::string> unknowns_in(const std::vector<TermAt>& terms) const {
    std::vector<std::string> found;
    const auto take = [&](const std::string& name) {
      if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
    };
    for (const TermAt& term : terms)
      model::walk(*term.tree, [&](const model::Expr& node) {
        if (node.op != model::Op::kSymbol) return;
        if (choice_.effect->find_unknown(node.name) != nullptr || is_numbered(node.name)) take(node.name);
        if (node.name == "{runs}")
          for (const std::string& name : names_of_steps()) take(name);
        if (node.name.rfind("{hats", 0) == 0)
          for (std::size_t i = 0; i < choice_.form->hats; ++i) take(fmt::format("h{}", i + 1));
      });
    return found;
  }

  /// Every other name of a term is a name of the machine or an input that is added with it.
  void check_name(const std::string& name) const {
    const auto& inputs = choice_.inputs;
    if (model::resolve_name(machine_, name).kind == model::SymbolKind::kUnresolved &&
        std::find(inputs.begin(), inputs.end(), name) == inputs.end())
      throw text::InputError(
          fmt::format("{}: \"{}\": unknown name in its term (a logged column is named by input=NAME)",
                      choice_.effect->id, name));
  }

  bool is_free(const std::string& name) const {
    return !taken_.contains(name) && !model::is_reserved_word(name) &&
           model::resolve_name(machine_, name).kind == model::SymbolKind::kUnresolved;
  }

  void name_unknowns(const std::vector<TermAt>& terms) {
    const std::vector<std::string> order = unknowns_in(terms);
    if (order.empty()) missing("an unknown in the term");
    const std::string stem = name_stem();
    for (const std::string& rule : order) {
      const std::string first = order.size() == 1                          ? stem
                                : choice_.form->place == PlaceRule::kPoint ? name_at(first_place(terms, rule))
                                                                           : stem + "_" + rule;
      std::string name = first;
      for (int suffix = 2; !is_free(name); ++suffix) name = first + "_" + std::to_string(suffix);
      taken_.insert(name);
      final_name_[rule] = name;
      result_.unknowns.push_back(unknown(rule, name, first_place(terms, rule)));
    }
  }

  /// Returns the degree of freedom of the first term that contains an unknown.
  static DofPlace first_place(const std::vector<TermAt>& terms, const std::string& unknown) {
    const auto is = [&](const model::Expr& node) { return model::is_symbol(node, unknown); };
    const auto found = std::find_if(terms.begin(), terms.end(),
                                    [&](const TermAt& t) { return model::any_node(*t.tree, is); });
    return found == terms.end() ? terms.front().place : found->place;  // a basis has no symbol of its own
  }

  CandidateUnknown unknown(const std::string& rule_name, const std::string& name, const DofPlace& at) const {
    const UnknownRule* rule = choice_.effect->find_unknown(rule_name);
    if (rule == nullptr) rule = choice_.effect->find_unknown(is_numbered(rule_name) ? "k" : "h");
    CandidateUnknown item;
    item.name = name;
    item.rule = rule_name;
    if (rule != nullptr) {
      item.kind = rule->kind;
      item.limit = rule->limit;
      item.plausible = rule->plausible;
      item.scale = rule->scale;
      item.unit = unit(rule->unit, at);
    }
    const auto start = choice_.start.find(rule_name);
    if (start != choice_.start.end()) item.start = start->second;
    if (item.kind != UnknownKind::kLinear && item.start == 0)
      throw text::InputError(choice_.effect->id + ": start." + rule_name +
                             " is missing: " + why_a_start(item));
    return item;
  }

  /// Returns why a manual addition needs a start value: a fit cannot find a period without a start
  /// value.
  static std::string why_a_start(const CandidateUnknown& item) {
    const std::string unit = item.unit.empty() ? "" : " in " + item.unit;
    const std::string say = "; add start." + item.rule + "=VALUE";
    switch (item.kind) {
      case UnknownKind::kPeriod:
        return fmt::format(
            "the period{} (pitch of the screw, period of the scale, a turn of a gear){}, or let `vernier "
            "diagnose` find it",
            unit, say);
      case UnknownKind::kTime:
        return "a time constant" + unit + say + " as a first guess";
      case UnknownKind::kTravel:
        return "a decay length" + unit + say + " as a first guess";
      default:
        return "a value" + unit + " to start from" + say;
    }
  }

  std::string unit(std::string text, const DofPlace& at) const {
    text::replace_all(text, "{dof}", is_angle(machine_, at) ? "deg" : "mm");
    if (choice_.axis) text::replace_all(text, "{q}", machine_.axes[*choice_.axis].rotary ? "deg" : "mm");
    if (!choice_.units.empty())
      for (const char* mark : {"{T}", "{L}", "{F}", "{V}"})
        text::replace_all(text, mark, choice_.units[0].empty() ? "1" : choice_.units[0]);
    if (text == "mm/mm" || text == "deg/deg" || text == "{}") return {};
    return text;
  }

  /// Returns the name of the coefficient of a point at one of its lengths.
  std::string name_at(const DofPlace& place) const {
    return fmt::format("{}_{}{}", plain(choice_.effect->id), dof_name(machine_, place),
                       transform_at(machine_, place).n);
  }

  std::string name_stem() const {
    std::string stem = plain(choice_.effect->id);
    if (choice_.axis) stem += "_" + machine_.axes[*choice_.axis].name;
    for (const std::string& input : choice_.inputs) stem += "_" + input;
    if (choice_.place) {
      if (!choice_.axis || !axes_.is_own(*choice_.axis, *choice_.place))
        stem += fmt::format("_{}{}", dof_name(machine_, *choice_.place),
                            transform_at(machine_, *choice_.place).n);
    }
    return text::is_name(stem) ? stem : "effect_" + stem;  // an id may begin with a digit
  }

  std::string label() const {
    std::string text = choice_.effect->id;
    if (choice_.axis) text += " of " + machine_.axes[*choice_.axis].name;
    if (choice_.axis2) text += " and " + machine_.axes[*choice_.axis2].name;
    for (std::size_t i = 0; i < choice_.inputs.size(); ++i)
      text += (i == 0 ? " with " : choice_.effect->has_found_terms() ? " and " : " - ") + choice_.inputs[i];
    if (choice_.form->place == PlaceRule::kPoint)
      text += fmt::format(" of the point at {}transform {}", choice_.place->workpiece ? "workpiece " : "",
                          transform_at(machine_, *choice_.place).n);
    if (choice_.place && result_.terms.size() == 1)
      text +=
          fmt::format(" in {} of {}transform {}", dof_name(machine_, *choice_.place),
                      choice_.place->workpiece ? "workpiece " : "", transform_at(machine_, *choice_.place).n);
    return text;
  }

  const model::Machine& machine_;
  const AxisPlaces& axes_;
  Choice choice_;
  Candidate result_;
  std::set<std::string> taken_;
  std::map<std::string, std::string> final_name_;  // of an unknown, by its name in the form
  mutable std::optional<GravityChain> gravity_;    // computed at its first use
};

}  // namespace

std::optional<std::size_t> axis_of(const AxisPlaces& axes, const Choice& choice) {
  if (choice.axis || !choice.place) return choice.axis;
  return axes.axis_of(*choice.place);
}

const Effect& custom_effect() {
  static const Effect effect = [] {
    Effect e;
    e.id = "custom";
    e.title = "A term that was found by search, without a named physical cause";
    e.formula = "product of at most three factors in one degree of freedom";
    e.signature = "The residual is described by this expression, but by no effect of the catalogue.";
    e.exposed_by =
        "Measure with different values of one factor of the expression and constant values of the other "
        "factors.";
    EffectForm& form = e.forms.emplace_back();
    form.label = "term";
    form.term = "k";
    read_term(form);
    e.unknowns.emplace_back().name = "k";
    return e;
  }();
  return effect;
}

Choice choice_at(const Candidate& candidate, const std::vector<double>& scanned) {
  Choice choice = candidate.choice;
  auto value = scanned.begin();
  for (const CandidateUnknown& unknown : scanned_unknowns(candidate)) choice.start[unknown.rule] = *value++;
  return choice;
}

std::vector<std::size_t> add_unknowns(model::Machine& machine, const Candidate& candidate,
                                      const std::vector<double>& scanned) {
  std::vector<std::size_t> linear;
  std::size_t next = 0;
  for (const CandidateUnknown& unknown : candidate.unknowns) {
    model::Static item;
    item.name = unknown.name;
    if (unknown.kind == UnknownKind::kLinear)
      linear.push_back(machine.statics.size());
    else if (!scanned.empty())
      item.value = scanned.at(next++);
    machine.statics.push_back(item);
  }
  return linear;
}

Candidate make_candidate(const model::Machine& machine, const AxisPlaces& axes, const Choice& choice) {
  return Maker(machine, axes, choice).make();
}

Candidate make_candidate(const model::Machine& machine, const Choice& choice) {
  return make_candidate(machine, AxisPlaces(machine), choice);
}

}  // namespace vernier::effects
