#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "tools/diagnose/candidate.h"
#include "tools/model/error.h"
#include "tools/model/numbers.h"
#include "tools/model/xml_text.h"

namespace vernier {
namespace {

// ---- add strings ----

/// A value as it stands in an add string: the characters that the string itself uses are written %XX.
std::string quote(const std::string& value) {
  std::string text;
  for (const char c : value) {
    if (c == ',' || c == '%' || c == '=' || c == '|' || c == ':' || c == '"' || c == ' ' || c == '\'')
      text += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      text += c;
  }
  return text;
}

std::string unquote(const std::string& text) {
  std::string value;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%' || i + 2 >= text.size()) {
      value += text[i];
      continue;
    }
    const auto digit = [](char c) { return c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10; };
    value += static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2]));
    i += 2;
  }
  return value;
}

bool asks_for(const EffectForm& form, const char* mark) { return form.term.find(mark) != std::string::npos; }

bool has_range(const EffectForm& form) {
  return asks_for(form, "{hats") || asks_for(form, "{mid}") || asks_for(form, "{from}") ||
         asks_for(form, "{to}") || asks_for(form, "{span}");
}

/// input, input2, input3 ...
std::string numbered(const std::string& key, std::size_t i) {
  return i == 0 ? key : key + std::to_string(i + 1);
}

std::string joined(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& item : list) text += (text.empty() ? "" : "|") + quote(item);
  return text;
}

/// Reads one add string against a machine.
class AddReader {
 public:
  AddReader(const std::string& text, const Machine& machine, const std::vector<Effect>& effects)
      : text_(text), machine_(machine), effects_(effects) {}

  Choice read() {
    split();
    find_effect();
    read_axes();
    read_inputs();
    read_place();
    choose_form();
    fill_place();
    read_numbers();
    if (!used_all()) fail(unused(), "not a key of an effect to add");
    return choice_;
  }

 private:
  [[noreturn]] void fail(const std::string& word, const std::string& what) const {
    throw InputError("\"" + text_ + "\": \"" + word + "\": " + what);
  }

  void split() {
    const auto colon = text_.find(':');
    id_ = text_.substr(0, colon);
    std::string rest = colon == std::string::npos ? std::string() : text_.substr(colon + 1);
    while (!rest.empty()) {
      if (rest.rfind("term=", 0) == 0) {  // an expression may hold commas: it is the last one
        values_["term"] = rest.substr(5);
        break;
      }
      const auto comma = rest.find(',');
      const std::string item = rest.substr(0, comma);
      const auto equals = item.find('=');
      if (equals == std::string::npos || equals == 0) fail(item, "expected KEY=VALUE");
      if (!values_.emplace(item.substr(0, equals), unquote(item.substr(equals + 1))).second)
        fail(item.substr(0, equals), "this key stands twice");
      rest = comma == std::string::npos ? std::string() : rest.substr(comma + 1);
    }
  }

  std::optional<std::string> take(const std::string& key) {
    const auto found = values_.find(key);
    if (found == values_.end()) return std::nullopt;
    taken_.push_back(key);
    return found->second;
  }
  bool used_all() const { return taken_.size() == values_.size(); }
  std::string unused() const {
    for (const auto& [key, value] : values_)
      if (std::find(taken_.begin(), taken_.end(), key) == taken_.end()) return key;
    return {};
  }

  void find_effect() {
    if (id_ == custom_effect().id) {
      choice_.effect = &custom_effect();
      const auto term = take("term");
      if (!term) fail(id_, "needs term=EXPRESSION with the unknown k");
      choice_.term = *term;
      return;
    }
    for (const Effect& effect : effects_)
      if (effect.id == id_) choice_.effect = &effect;
    if (choice_.effect == nullptr) fail(id_, "unknown effect (`vernier effects` lists them)");
  }

  void read_axes() {
    for (auto [key, target] : {std::pair{"axis", &choice_.axis}, std::pair{"axis2", &choice_.axis2}})
      if (const auto name = take(key)) {
        *target = machine_.find_axis(*name);
        if (!*target) fail(*name, "the machine has no such axis");
      }
  }

  void read_inputs() {
    for (const char* key : {"input", "input2", "input3"})
      if (const auto name = take(key)) {
        if (!is_name(*name)) fail(*name, "not a name");
        choice_.inputs.push_back(*name);
        const auto known = machine_.find_input(*name);
        if (!known && resolve_name(machine_, *name).kind != SymbolKind::kUnresolved)
          fail(*name, "this name is taken by something that is no input");
        choice_.units.push_back(known ? machine_.inputs[*known].unit : "");
      }
    const auto unit = take("unit");
    for (std::size_t i = 0; i < choice_.units.size(); ++i) {
      const auto own = i == 0 ? unit : take("unit" + std::to_string(i + 1));
      if (choice_.units[i].empty()) choice_.units[i] = own.value_or(unit.value_or(""));
    }
  }

  /// The transform that branch and transform name; nothing where the string says nothing of it.
  std::optional<DofPlace> named_transform() {
    const auto branch = take("branch"), number = take("transform");
    if (branch && *branch != "tool" && *branch != "workpiece") fail(*branch, "expected tool or workpiece");
    if (!number) return std::nullopt;
    for (const bool workpiece : {false, true}) {
      if (branch && (*branch == "workpiece") != workpiece) continue;
      const auto& list = workpiece ? machine_.workpiece : machine_.tool;
      for (std::size_t i = 0; i < list.size(); ++i)
        if (std::to_string(list[i].n) == *number) return DofPlace{workpiece, i, 0};
    }
    fail(*number, "the machine has no such transform");
  }

  void read_place() {
    transform_ = named_transform();
    dof_ = take("dof");
    if (!transform_ && dof_ && choice_.axis) transform_ = own_place(machine_, *choice_.axis);
    if (!transform_ && dof_) {
      const std::vector<DofPlace> base = base_places(machine_);
      if (!base.empty()) transform_ = base[0];
    }
    if (!transform_) return;
    if (dof_) {
      const Transform& at = transform_at(machine_, *transform_);
      for (std::size_t d = 0; d < at.dof_count(); ++d)
        if (equal_no_case(at.dof_name(d), *dof_))
          choice_.place = DofPlace{transform_->workpiece, transform_->transform, d};
      if (!choice_.place) fail(*dof_, "not a degree of freedom of this transform");
    }
    const auto driver = choice_.axis ? std::nullopt : axis_of(machine_, *transform_);
    default_axis_ = driver;
  }

  /// Does a form go with what has been said?
  bool fits(const EffectForm& form) const {
    const std::size_t inputs = asks_for(form, "{S}")                                                     ? 2
                               : asks_for(form, "{T}") || asks_for(form, "{L}") || asks_for(form, "{F}") ? 1
                                                                                                         : 0;
    if (inputs != choice_.inputs.size()) return false;
    const std::optional<std::size_t> axis = choice_.axis ? choice_.axis : default_axis_;
    if (form.place == PlaceRule::kPair) return choice_.axis2.has_value();
    if (!choice_.place) return true;
    const bool angle = is_angle(machine_, *choice_.place);
    const bool at_own = axis && is_own_place(machine_, *axis, *choice_.place);
    switch (form.place) {
      case PlaceRule::kOwn:
      case PlaceRule::kJoint:
        return at_own;
      case PlaceRule::kCross:
        return !angle && !at_own;
      case PlaceRule::kTurn:
      case PlaceRule::kAngle:
      case PlaceRule::kBaseTurn:
        return angle;
      case PlaceRule::kLength:
      case PlaceRule::kBase:
        return !angle;
      default:
        return true;
    }
  }

  void choose_form() {
    const auto label = take("form");
    if (choice_.effect == &custom_effect()) {
      choice_.form = &custom_effect().forms[0];
      return;
    }
    for (const EffectForm& form : choice_.effect->forms) {
      if (label ? form.label != *label : !fits(form)) continue;
      choice_.form = &form;
      return;
    }
    if (label) fail(*label, "this effect has no such form");
    fail(id_, "no form of this effect goes with these inputs and this degree of freedom");
  }

  void fill_place() {
    const bool needs_axis = asks_for(*choice_.form, "{q}") || asks_for(*choice_.form, "{hats");
    if (needs_axis && !choice_.axis) choice_.axis = default_axis_;
    if (choice_.form->place == PlaceRule::kEachAxis || choice_.form->place == PlaceRule::kPair ||
        choice_.form->place == PlaceRule::kNormal) {
      choice_.place.reset();
      return;
    }
    if (choice_.place) return;
    const bool own = choice_.form->place == PlaceRule::kOwn || choice_.form->place == PlaceRule::kJoint;
    if (own && choice_.axis) choice_.place = own_place(machine_, *choice_.axis);
    if (!choice_.place) fail(id_, "needs branch, transform and dof: where does it act?");
  }

  double number(const std::string& key, const std::string& text) const {
    const auto value = parse_number(text);
    if (!value) fail(key + "=" + text, "expected a number");
    return *value;
  }

  void read_numbers() {
    if (const auto text = take("reference")) choice_.reference = number("reference", *text);
    if (const auto text = take("sum")) choice_.sum = *text;
    if (choice_.sum.empty() && choice_.axis) choice_.sum = machine_.axes[*choice_.axis].name;
    if (choice_.axis) {
      const Axis& axis = machine_.axes[*choice_.axis];
      choice_.from = axis.min.value_or(0);
      choice_.to = axis.max.value_or(0);
    }
    if (const auto text = take("from")) choice_.from = number("from", *text);
    if (const auto text = take("to")) choice_.to = number("to", *text);
    if (const auto runs = take("runs")) {
      std::string label;
      for (const char c : *runs + "|") {
        if (c == '|') {
          choice_.runs.push_back(label);
          label.clear();
        } else {
          label += c;
        }
      }
    }
    for (const auto& [key, value] : values_) {
      if (key.rfind("start.", 0) != 0) continue;
      choice_.start[key.substr(6)] = number(key, value);
      taken_.push_back(key);
    }
  }

  const std::string& text_;
  const Machine& machine_;
  const std::vector<Effect>& effects_;
  std::string id_;
  std::map<std::string, std::string> values_;
  std::vector<std::string> taken_;
  std::optional<DofPlace> transform_;
  std::optional<std::string> dof_;
  std::optional<std::size_t> default_axis_;
  Choice choice_;
};

// ---- the machine file ----

/// Collects the insertions that put a candidate into a machine file.
class Adder {
 public:
  Adder(const std::string& text, const Machine& machine, const Candidate& candidate)
      : text_(text), machine_(machine), candidate_(candidate) {}

  std::string add() {
    document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    find(document_);
    if (variables_.empty()) throw InputError(machine_.file + ": no <variables> to add to");
    insert_statics();
    insert_inputs();
    for (const CandidateTerm& term : candidate_.terms) edit_term(term);
    return apply_edits(text_, std::move(edits_));
  }

 private:
  void find(const pugi::xml_node& parent) {
    for (const pugi::xml_node node : parent.children()) {
      if (equal_no_case(node.name(), "variables") && variables_.empty()) variables_ = node;
      if (equal_no_case(node.name(), "static") && static_.empty()) static_ = node;
      if (equal_no_case(node.name(), "inputs") && inputs_.empty()) inputs_ = node;
      if (equal_no_case(node.name(), "transforms")) chains_.push_back(node);
      if (equal_no_case(node.name(), "variables") || node.parent() == document_) find(node);
    }
  }

  static std::size_t offset(const pugi::xml_node& node) {
    return static_cast<std::size_t>(node.offset_debug());
  }

  /// Puts `lines` at the end of an element's content; `name` for one that is closed at once.
  void append(const pugi::xml_node& node, const std::string& lines) {
    const std::size_t end_of_start = text_.find('>', end_of_attributes(text_, offset(node)));
    if (text_[end_of_start - 1] == '/') {
      edits_.push_back({end_of_start - 1, 2, ">\n" + lines + "</" + std::string(node.name()) + ">"});
      return;
    }
    std::size_t from = end_of_start;
    for (const pugi::xml_node child : node.children())
      if (child.offset_debug() >= 0) from = std::max(from, offset(child));
    std::size_t close = text_.find("</" + std::string(node.name()), from);
    const std::size_t line = text_.rfind('\n', close);
    // In front of the line of the closing tag, where that stands alone.
    if (line != std::string::npos && text_.find_first_not_of(" \t\r", line + 1) == close) close = line + 1;
    edits_.push_back({close, 0, lines});
  }

  void insert_statics() {
    std::string lines;
    for (const CandidateUnknown& unknown : candidate_.unknowns)
      // A time constant or a period has no meaning at 0: its nominal is the start (the term is 0 all the
      // same, for its coefficient is).
      lines += fmt::format("      <{} value=\"{}\" nominal=\"{}\" unit=\"{}\" note=\"{}\"/>\n", unknown.name,
                           number_text(unknown.start),
                           unknown.kind == UnknownKind::kLinear ? "0" : number_text(unknown.start),
                           escape_attribute(unknown.unit), escape_attribute(candidate_.label));
    if (static_.empty())
      append(variables_, "    <static>\n" + lines + "    </static>\n");
    else
      append(static_, lines);
  }

  void insert_inputs() {
    std::string lines;
    for (std::size_t i = 0; i < names_of_new_inputs().size(); ++i) {
      const auto [name, unit] = names_of_new_inputs()[i];
      const double reference = candidate_.choice.reference.value_or(unit == "degC" ? 20 : 0);
      lines += fmt::format("      <{} unit=\"{}\" reference=\"{}\"/>\n", name, escape_attribute(unit),
                           number_text(reference));
    }
    if (lines.empty()) return;
    if (inputs_.empty())
      append(variables_, "    <inputs>\n" + lines + "    </inputs>\n");
    else
      append(inputs_, lines);
  }

  std::vector<std::pair<std::string, std::string>> names_of_new_inputs() const {
    std::vector<std::pair<std::string, std::string>> list;
    for (std::size_t i = 0; i < candidate_.choice.inputs.size(); ++i) {
      const std::string& name = candidate_.choice.inputs[i];
      if (machine_.find_input(name)) continue;
      list.emplace_back(name, i < candidate_.choice.units.size() ? candidate_.choice.units[i] : "");
    }
    return list;
  }

  pugi::xml_node node_of(const DofPlace& place) const {
    const Transform& wanted = transform_at(machine_, place);
    for (const pugi::xml_node chain : chains_) {
      bool workpiece = false;
      for (const pugi::xml_attribute item : chain.attributes())
        if (equal_no_case(item.name(), "branch")) workpiece = equal_no_case(item.value(), "workpiece");
      if (workpiece != place.workpiece) continue;
      for (const pugi::xml_node node : chain.children())
        for (const pugi::xml_attribute item : node.attributes())
          if (equal_no_case(item.name(), "n") && std::to_string(wanted.n) == item.value()) return node;
    }
    throw InputError(fmt::format("{}: transform {} was not found again", machine_.file, wanted.n));
  }

  void edit_term(const CandidateTerm& term) {
    const pugi::xml_node node = node_of(term.place);
    const std::string name = dof_name(machine_, term.place);
    const std::string value = escape_attribute(term.text);
    for (const AttributeSpan& span : attribute_spans(text_, offset(node))) {
      if (!equal_no_case(span.name, name)) continue;
      const std::string before = text_.substr(span.value_at, span.value_size);
      const auto number = parse_number(before);
      if (before.empty() || (number && *number == 0))
        edits_.push_back({span.value_at, span.value_size, value});
      else
        edits_.push_back({span.value_at + span.value_size, 0, (value[0] == '-' ? "" : "+") + value});
      return;
    }
    edits_.push_back({end_of_attributes(text_, offset(node)), 0, " " + name + "=\"" + value + "\""});
  }

  const std::string& text_;
  const Machine& machine_;
  const Candidate& candidate_;
  pugi::xml_document document_;
  pugi::xml_node variables_, static_, inputs_;
  std::vector<pugi::xml_node> chains_;
  std::vector<TextEdit> edits_;
};

}  // namespace

std::string add_string(const Machine& machine, const Candidate& candidate) {
  const Choice& c = candidate.choice;
  std::string text = c.effect->id;
  char separator = ':';
  const auto put = [&](const std::string& key, const std::string& value) {
    text += separator + key + "=" + value;
    separator = ',';
  };
  const bool custom = c.effect == &custom_effect();
  if (c.axis) put("axis", machine.axes[*c.axis].name);
  if (c.axis2) put("axis2", machine.axes[*c.axis2].name);
  for (std::size_t i = 0; i < c.inputs.size(); ++i) put(numbered("input", i), c.inputs[i]);
  if (c.place) {
    put("branch", c.place->workpiece ? "workpiece" : "tool");
    put("transform", std::to_string(transform_at(machine, *c.place).n));
    put("dof", dof_name(machine, *c.place));
  }
  if (c.reference) put("reference", number_text(*c.reference));
  for (std::size_t i = 0; i < c.units.size(); ++i)
    if (!c.units[i].empty()) put(numbered("unit", i), quote(c.units[i]));
  if (!custom) put("form", c.form->label);
  if (!custom && asks_for(*c.form, "{sum}")) put("sum", c.sum);
  if (!custom && has_range(*c.form)) {
    put("from", number_text(c.from));
    put("to", number_text(c.to));
  }
  if (!c.runs.empty()) put("runs", joined(c.runs));
  for (const auto& [name, value] : c.start) put("start." + name, number_text(value));
  if (custom) put("term", c.term);
  return text;
}

Choice parse_add_string(const std::string& text, const Machine& machine, const std::vector<Effect>& effects) {
  return AddReader(text, machine, effects).read();
}

std::string add_to_machine_text(const std::string& text, const Machine& machine, const Candidate& candidate) {
  return Adder(text, machine, candidate).add();
}

}  // namespace vernier
