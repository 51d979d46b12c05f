// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/candidate.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/effects/input_class.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier {
namespace {

void replace_all(std::string& text, std::string_view what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

/// A name made of letters that names may have.
std::string plain(std::string_view text) {
  std::string name;
  for (const char c : text)
    name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
  return name;
}

/// `- -x` and `+-x` read badly and parse well; numbers in terms are put in parentheses where negative.
std::string number_in_term(double value) {
  const std::string text = number_text(value);
  return value < 0 ? "(" + text + ")" : text;
}

/// Unknowns carry this in front of their name until they have their final one, so that an axis or an input
/// that is called like one of them (L, k, p ...) stays what it is.
constexpr std::string_view kMark = "unknown__";

bool in_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// The text with every whole name replaced by what `change` makes of it; run labels and placeholders stay.
template <class Change>
std::string with_names(const std::string& text, const Change& change) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '"' || text[at] == '{') {
      const auto end = std::min(text.find(text[at] == '"' ? '"' : '}', at + 1), text.size() - 1);
      result.append(text, at, end - at + 1);
      at = end + 1;
    } else if (in_name(text[at])) {
      std::size_t end = at;
      while (end < text.size() && in_name(text[end])) ++end;
      result += change(text.substr(at, end - at));
      at = end;
    } else {
      result += text[at++];
    }
  }
  return result;
}

/// Works one choice out into terms and unknowns.
class Maker {
 public:
  Maker(const Machine& machine, const AxisPlaces& axes, const Choice& choice)
      : machine_(machine), axes_(axes), choice_(choice) {
    for (const Static& item : machine.statics) taken_.insert(item.name);
    for (const Axis& item : machine.axes) taken_.insert(item.name);
    for (const Input& item : machine.inputs) taken_.insert(item.name);
    for (const std::string& name : choice.inputs) taken_.insert(name);
  }

  Candidate make() {
    settle_reference();
    result_.choice = choice_;
    try {
      add_terms();
      name_unknowns();
    } catch (const ExpressionError& error) {
      std::string word = error.word;
      replace_all(word, kMark, "");
      throw InputError(choice_.effect->id + ": \"" + word + "\": " + error.what() + ", in its term");
    }
    result_.label = label();
    return std::move(result_);
  }

 private:
  [[noreturn]] void missing(const std::string& what) const {
    throw InputError(choice_.effect->id + ": " + what + " is missing");
  }

  /// The reference that a term subtracts is the one that the input is declared with: the term is 0 there.
  void settle_reference() {
    if (choice_.reference || choice_.inputs.empty() || choice_.effect == &custom_effect()) return;
    if (choice_.form->term.find("{ref}") == std::string::npos) return;
    choice_.reference = standard_reference(choice_.units.empty() ? "" : choice_.units[0]);
    if (const auto known = machine_.find_input(choice_.inputs[0]))
      choice_.reference = machine_.inputs[*known].reference;
  }

  void add_terms() {
    const std::string form = marked(choice_.effect == &custom_effect() ? choice_.term : choice_.form->term);
    switch (choice_.effect == &custom_effect() ? PlaceRule::kOwn : choice_.form->place) {
      case PlaceRule::kEachAxis:
        for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
          if (const auto& own = axes_.own(axis)) add_term(*own, form, axis, axes_.sense(axis) < 0);
        break;
      case PlaceRule::kPair:
        add_pair(form);
        break;
      case PlaceRule::kNormal:
        add_normal(form);
        break;
      default:
        if (!choice_.place) missing("branch, transform or dof");
        add_term(*choice_.place, form, choice_.axis);
    }
    if (result_.terms.empty()) missing("a degree of freedom to act at");
  }

  /// The term with every unknown marked as one.
  std::string marked(const std::string& term) const {
    return with_names(term, [&](const std::string& name) {
      return choice_.effect->find_unknown(name) == nullptr ? name : std::string(kMark) + name;
    });
  }

  void add_pair(const std::string& form) {
    const auto bar = form.find('|');
    if (bar == std::string::npos) missing("\"|\" in the term of a pair");
    if (!choice_.axis || !choice_.axis2) missing("axis or axis2");
    const auto &first = axes_.own(*choice_.axis), &second = axes_.own(*choice_.axis2);
    if (!first || !second) missing("the degree of freedom of an axis");
    add_term(*first, form.substr(0, bar), choice_.axis, axes_.sense(*choice_.axis) < 0);
    add_term(*second, form.substr(bar + 1), choice_.axis2, axes_.sense(*choice_.axis2) < 0);
  }

  void add_normal(const std::string& form) {
    static constexpr std::array<const char*, 3> kNormals = {"nx", "ny", "nz"};
    const std::vector<DofPlace> base = base_places(machine_);
    for (std::size_t i = 0; i < base.size(); ++i) {
      std::string text = form;
      replace_all(text, "{n}", kNormals[i]);
      // The workpiece branch enters inverted: what moves it forward moves the point back.
      add_term(base[i], text, std::nullopt, base[i].workpiece);
    }
  }

  /// `negated`: terms that share a coefficient count in the same sense along the machine's motion.
  void add_term(const DofPlace& place, std::string text, std::optional<std::size_t> axis,
                bool negated = false) {
    const auto begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
    text = begin == std::string::npos ? std::string() : text.substr(begin, end - begin + 1);
    if (text.find("{q}") != std::string::npos) {
      if (!axis) missing("axis");
      replace_all(text, "{q}", machine_.axes[*axis].name);
    }
    fill_inputs(text);
    replace_all(text, "{mid}", number_in_term(0.5 * (choice_.from + choice_.to)));
    replace_all(text, "{span}", number_in_term(choice_.to - choice_.from));
    replace_all(text, "-{from}",
                choice_.from == 0  ? std::string()
                : choice_.from < 0 ? "+" + number_text(-choice_.from)
                                   : "-" + number_text(choice_.from));
    replace_all(text, "{from}", number_in_term(choice_.from));
    replace_all(text, "{to}", number_in_term(choice_.to));
    if (text.find("{sum}") != std::string::npos) {
      if (choice_.sum.empty()) missing("sum");
      replace_all(text, "{sum}", choice_.sum);
    }
    fill_hats(text, axis);
    fill_runs(text);
    if (negated) {
      const Op op = parse_expression(text)->op;
      const bool product = (op == Op::kMultiply || op == Op::kDivide) && text[0] != '-';
      text = product ? "-" + text : "-(" + text + ")";
    }
    result_.terms.push_back({place, text});
  }

  void fill_inputs(std::string& text) const {
    const auto fill = [&](const char* mark, std::size_t index) {
      if (text.find(mark) == std::string::npos) return;
      if (choice_.inputs.size() <= index) missing(index == 0 ? "input" : "input2");
      replace_all(text, mark, choice_.inputs[index]);
    };
    for (const char* mark : {"{T}", "{L}", "{F}"}) fill(mark, 0);
    fill("{S}", 1);
    if (text.find("{ref}") == std::string::npos) return;
    if (!choice_.reference) missing("input");
    const double reference = *choice_.reference;
    replace_all(text, "-{ref}",
                reference == 0  ? ""
                : reference < 0 ? "+" + number_text(-reference)
                                : "-" + number_text(reference));
    replace_all(text, "{ref}", number_in_term(reference));
  }

  void fill_hats(std::string& text, std::optional<std::size_t> axis) {
    const auto at = text.find("{hats ");
    if (at == std::string::npos) return;
    const auto end = text.find('}', at);
    const auto count = parse_number(text.substr(at + 6, end - at - 6));
    if (!count || *count < 2) missing("the number of hats");
    if (!axis) missing("axis");
    if (!(choice_.to > choice_.from)) missing("from or to (the range of the axis)");
    const auto nodes = static_cast<std::size_t>(*count);
    const double width = (choice_.to - choice_.from) / (*count - 1);
    std::string sum;
    for (std::size_t i = 0; i < nodes; ++i) {
      const double node = choice_.from + width * static_cast<double>(i);
      const std::string& q = machine_.axes[*axis].name;
      const std::string away = node == 0  ? "abs(" + q + ")"
                               : node < 0 ? fmt::format("abs({}+{})", q, number_text(-node))
                                          : fmt::format("abs({}-{})", q, number_text(node));
      sum += (i > 0 ? "+" : "") + fmt::format("{}h{}*max(0,1-{}/{})", kMark, i + 1, away, number_text(width));
    }
    text.replace(at, end - at + 1, sum);
  }

  void fill_runs(std::string& text) {
    if (text.find("{runs}") == std::string::npos) return;
    if (choice_.runs.empty()) missing("runs");
    std::string sum;
    for (std::size_t i = 0; i < choice_.runs.size(); ++i) {
      const std::string name = choice_.runs.size() == 1 ? "h" : fmt::format("h{}", i + 1);
      sum += (i > 0 ? "+" : "") + fmt::format("{}{}*run(\"{}\")", kMark, name, choice_.runs[i]);
    }
    replace_all(text, "{runs}", sum);
  }

  /// The unknowns of a text, in the order of the expression, without their mark.
  static std::vector<std::string> unknowns_in(const std::string& text) {
    std::vector<std::string> found;
    const ExprPtr expr = parse_expression(text);
    walk(*expr, [&](const Expr& node) {
      if (node.op != Op::kSymbol || node.name.rfind(kMark, 0) != 0) return;
      const std::string name = node.name.substr(kMark.size());
      if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
    });
    return found;
  }

  /// Every other name of a term is one of the machine's or an input that comes with it.
  void check_names(const std::string& text) const {
    const ExprPtr expr = parse_expression(text);
    walk(*expr, [&](const Expr& node) {
      if (node.op != Op::kSymbol || node.name.rfind(kMark, 0) == 0) return;
      const auto& inputs = choice_.inputs;
      if (resolve_name(machine_, node.name).kind == SymbolKind::kUnresolved &&
          std::find(inputs.begin(), inputs.end(), node.name) == inputs.end())
        throw InputError(choice_.effect->id + ": \"" + node.name +
                         "\": unknown name in its term (a logged column is named by input=NAME)");
    });
  }

  bool is_free(const std::string& name) const {
    return !taken_.contains(name) && !is_reserved_word(name) &&
           resolve_name(machine_, name).kind == SymbolKind::kUnresolved;
  }

  void name_unknowns() {
    std::vector<std::string> order;
    for (const CandidateTerm& term : result_.terms) check_names(term.text);
    for (const CandidateTerm& term : result_.terms)
      for (const std::string& name : unknowns_in(term.text))
        if (std::find(order.begin(), order.end(), name) == order.end()) order.push_back(name);
    if (order.empty()) missing("an unknown in the term");
    const std::string stem = name_stem();
    std::map<std::string, std::string> renamed;
    for (const std::string& rule : order) {
      const std::string first = order.size() == 1 ? stem : stem + "_" + rule;
      std::string name = first;
      for (int suffix = 2; !is_free(name); ++suffix) name = first + "_" + std::to_string(suffix);
      taken_.insert(name);
      renamed[std::string(kMark) + rule] = name;
      result_.unknowns.push_back(unknown(rule, name));
    }
    for (CandidateTerm& term : result_.terms)
      term.text = with_names(term.text, [&](const std::string& name) {
        const auto found = renamed.find(name);
        return found == renamed.end() ? name : found->second;
      });
  }

  CandidateUnknown unknown(const std::string& rule_name, const std::string& name) const {
    const UnknownRule* rule = choice_.effect->find_unknown(rule_name);
    if (rule == nullptr) rule = choice_.effect->find_unknown("h");
    CandidateUnknown item{name, {}, rule_name, UnknownKind::kLinear, 0, 0};
    if (rule != nullptr) {
      item.kind = rule->kind;
      item.limit = rule->limit;
      item.unit = unit(rule->unit);
    }
    const auto start = choice_.start.find(rule_name);
    if (start != choice_.start.end()) item.start = start->second;
    if (item.kind != UnknownKind::kLinear && item.start == 0)
      throw InputError(choice_.effect->id + ": start." + rule_name + " is missing");
    return item;
  }

  std::string unit(std::string text) const {
    replace_all(text, "{dof}", is_angle(machine_, result_.terms[0].place) ? "deg" : "mm");
    if (choice_.axis) replace_all(text, "{q}", machine_.axes[*choice_.axis].rotary ? "deg" : "mm");
    if (!choice_.units.empty())
      for (const char* mark : {"{T}", "{L}", "{F}"})
        replace_all(text, mark, choice_.units[0].empty() ? "1" : choice_.units[0]);
    if (text == "mm/mm" || text == "deg/deg" || text == "{}") return {};
    return text;
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
    return is_name(stem) ? stem : "effect_" + stem;  // an id may begin with a digit
  }

  std::string label() const {
    std::string text = choice_.effect->id;
    if (choice_.axis) text += " of " + machine_.axes[*choice_.axis].name;
    if (choice_.axis2) text += " and " + machine_.axes[*choice_.axis2].name;
    for (std::size_t i = 0; i < choice_.inputs.size(); ++i)
      text += (i ? " - " : " with ") + choice_.inputs[i];
    if (choice_.place && result_.terms.size() == 1)
      text +=
          fmt::format(" in {} of {}transform {}", dof_name(machine_, *choice_.place),
                      choice_.place->workpiece ? "workpiece " : "", transform_at(machine_, *choice_.place).n);
    return text;
  }

  const Machine& machine_;
  const AxisPlaces& axes_;
  Choice choice_;
  Candidate result_;
  std::set<std::string> taken_;
};

}  // namespace

const Effect& custom_effect() {
  static const Effect effect = [] {
    Effect e;
    e.id = "custom";
    e.title = "A term found by search, no named physics";
    e.formula = "product of at most three factors in one degree of freedom";
    e.signature = "The residual follows this expression; no effect of the catalogue does.";
    e.exposed_by = "Vary one factor of the expression while the others stay.";
    e.forms.push_back({"term", PlaceRule::kOwn, "k"});
    e.unknowns.push_back({"k", "", UnknownKind::kLinear, 0, 0, 0, 0});
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

std::vector<std::size_t> add_unknowns(Machine& machine, const Candidate& candidate,
                                      const std::vector<double>& scanned) {
  std::vector<std::size_t> linear;
  std::size_t next = 0;
  for (const CandidateUnknown& unknown : candidate.unknowns) {
    Static item;
    item.name = unknown.name;
    if (unknown.kind == UnknownKind::kLinear)
      linear.push_back(machine.statics.size());
    else if (!scanned.empty())
      item.value = scanned.at(next++);
    machine.statics.push_back(item);
  }
  return linear;
}

Candidate make_candidate(const Machine& machine, const AxisPlaces& axes, const Choice& choice) {
  return Maker(machine, axes, choice).make();
}

Candidate make_candidate(const Machine& machine, const Choice& choice) {
  return make_candidate(machine, AxisPlaces(machine), choice);
}

}  // namespace vernier
