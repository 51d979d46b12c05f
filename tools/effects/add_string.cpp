// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/add_string.h"
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "tools/effects/gravity.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/xml_text.h"

namespace vernier::effects {
namespace {

/// Returns a value as an add string writes it. The characters that the string itself uses become
/// %XX.
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
    const auto is_hex = [&](std::size_t at) {
      return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at])) != 0;
    };
    if (text[i] != '%' || !is_hex(i + 1) || !is_hex(i + 2)) {
      value += text[i];
      continue;
    }
    const auto digit = [](char c) { return c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10; };
    value += static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2]));
    i += 2;
  }
  return value;
}

bool has_range(const EffectForm& form) {
  return form.asks_for("hats") || form.asks_for("mid") || form.asks_for("from") || form.asks_for("to") ||
         form.asks_for("span");
}

/// Returns the numbered key: input, input2, input3 ...
std::string numbered(const std::string& key, std::size_t i) {
  return i == 0 ? key : key + std::to_string(i + 1);
}

std::string quoted_list(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& item : list) text += (text.empty() ? "" : "|") + quote(item);
  return text;
}

/// Reads one add string against a machine.
class AddReader {
 public:
  AddReader(const std::string& text, const model::Machine& machine, const std::vector<Effect>& effects)
      : text_(text), machine_(machine), axes_(machine), effects_(effects) {}

  Choice read() {
    split();
    find_effect();
    read_axes();
    read_inputs();
    read_place();
    read_pull();
    choose_form();
    fill_place();
    if (choice_.form->place == PlaceRule::kJoint) require_moment();
    read_numbers();
    if (!used_all())
      fail(unused(), "unknown key in the description of the effect (`vernier add --help` lists the keys)");
    return choice_;
  }

 private:
  [[noreturn]] void fail(const std::string& word, const std::string& what) const {
    throw text::InputError("\"" + text_ + "\": \"" + word + "\": " + what);
  }

  void split() {
    const auto colon = text_.find(':');
    id_ = text_.substr(0, colon);
    std::string rest = colon == std::string::npos ? std::string() : text_.substr(colon + 1);
    while (!rest.empty()) {
      if (rest.rfind("term=", 0) == 0) {  // an expression may contain commas, so it is the last value
        values_["term"] = rest.substr(5);
        break;
      }
      const auto comma = rest.find(',');
      const std::string item = rest.substr(0, comma);
      const auto equals = item.find('=');
      if (equals == std::string::npos || equals == 0) fail(item, "expected KEY=VALUE");
      const std::string key = item.substr(0, equals), value = item.substr(equals + 1);
      // Labels of runs are quoted one by one, because a label may contain the separator.
      if (!values_.emplace(key, key == "runs" ? value : unquote(value)).second)
        fail(item.substr(0, equals), "this key occurs twice");
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
      if (!term) fail(id_, "a custom effect needs term=EXPRESSION with the unknown k");
      choice_.term = *term;
      return;
    }
    for (const Effect& effect : effects_)
      if (effect.id == id_) choice_.effect = &effect;
    if (choice_.effect == nullptr) fail(id_, "unknown effect (`vernier effects` lists them)");
    if (!choice_.effect->has_found_terms()) return;
    const auto term = take("term");
    if (!term)
      fail(id_,
           "this effect needs term=DOF:EXPRESSION|DOF:EXPRESSION with the unknowns k1, k2, ... "
           "(`vernier diagnose` finds it)");
    choice_.term = *term;
  }

  void read_axes() {
    for (auto [key, target] : {std::pair{"axis", &choice_.axis}, std::pair{"axis2", &choice_.axis2}})
      if (const auto name = take(key)) {
        *target = machine_.find_axis(*name);
        if (!*target) fail(*name, "the machine has no axis of this name");
      }
  }

  void read_inputs() {
    while (const auto name = take(numbered("input", choice_.inputs.size()))) {
      if (!text::is_name(*name)) fail(*name, "not a name");
      if (model::is_reserved_word(*name)) fail(*name, "this name is reserved");
      choice_.inputs.push_back(*name);
      const auto known = machine_.find_input(*name);
      if (!known && model::resolve_name(machine_, *name).kind != model::SymbolKind::kUnresolved)
        fail(*name, "the machine file uses this name for something that is not an input");
      choice_.units.push_back(known ? machine_.inputs[*known].unit : "");
    }
    const auto unit = take("unit");
    for (std::size_t i = 0; i < choice_.units.size(); ++i) {
      const auto own = i == 0 ? unit : take(numbered("unit", i));
      if (choice_.units[i].empty()) choice_.units[i] = own.value_or(unit.value_or(""));
    }
  }

  /// Returns the transform that branch and transform name. Returns nullopt if the string does not
  /// name it.
  std::optional<DofPlace> named_transform() {
    const auto branch = take("branch"), number = take("transform");
    if (branch && *branch != "tool" && *branch != "workpiece") fail(*branch, "expected tool or workpiece");
    branch_ = branch;
    if (!number) return std::nullopt;
    for (const bool workpiece : {false, true}) {
      if (branch && (*branch == "workpiece") != workpiece) continue;
      const auto& list = workpiece ? machine_.workpiece : machine_.tool;
      for (std::size_t i = 0; i < list.size(); ++i)
        if (std::to_string(list[i].n) == *number) return DofPlace{workpiece, i, 0};
    }
    fail(*number, "neither branch of the machine has a transform of this name or number");
  }

  void read_place() {
    transform_ = named_transform();
    dof_ = take("dof");
    if (!transform_ && dof_ && choice_.axis) transform_ = axes_.own(*choice_.axis);
    if (!transform_ && dof_) {
      const std::vector<DofPlace> base = base_places(machine_);
      if (!base.empty()) transform_ = base[0];
    }
    if (!transform_) return;
    if (branch_ && (*branch_ == "workpiece") != transform_->workpiece)
      fail(*branch_, "the branch has several transforms; give transform=N");
    if (dof_) {
      const model::Transform& at = transform_at(machine_, *transform_);
      for (std::size_t d = 0; d < at.dof_count(); ++d)
        if (text::equal_no_case(at.dof_name(d), *dof_))
          choice_.place = DofPlace{transform_->workpiece, transform_->transform, d};
      if (!choice_.place) fail(*dof_, "this transform has no degree of freedom of this name");
    }
    const auto driver = choice_.axis ? std::nullopt : axes_.axis_of(*transform_);
    default_axis_ = driver;
  }

  /// Is a form consistent with the values that the string gives?
  bool fits(const EffectForm& form) const {
    const std::size_t inputs = form.asks_for("S") ? 2 : form.asks_for_input() ? 1 : 0;
    if (inputs != choice_.inputs.size()) return false;
    const std::optional<std::size_t> axis = choice_.axis ? choice_.axis : default_axis_;
    if ((form.place == PlaceRule::kPair) != choice_.axis2.has_value()) return false;
    if (form.asks_for("across") != choice_.toward.has_value()) return false;
    if (form.asks_for("moment") != choice_.mass.has_value()) return false;
    // A term of one period per revolution has no meaning on a linear axis. 360 mm would be a
    // period that nobody asked for.
    if (axis && !machine_.axes[*axis].rotary && form.term.find("sin({q})") != std::string::npos) return false;
    if (!choice_.place) return true;
    if (!acts_at_one(form)) return false;
    const bool angle = is_angle(machine_, *choice_.place);
    const bool at_own = axis && axes_.is_own(*axis, *choice_.place);
    switch (form.place) {
      case PlaceRule::kOwn:
      case PlaceRule::kJoint:
        return at_own;
      case PlaceRule::kCross:
        return !angle && !at_own;
      case PlaceRule::kTurn:
      case PlaceRule::kAngle:
      case PlaceRule::kBaseTurn:
      case PlaceRule::kBend:
        return angle;
      case PlaceRule::kLink:
        return form.asks_for("along") != angle;
      case PlaceRule::kLength:
      case PlaceRule::kBase:
        return !angle;
      default:
        return true;
    }
  }

  /// Reads the direction of a bar and the location of a mass. The gravity functions are computed
  /// for them.
  void read_pull() {
    if (const auto toward = take("toward")) {
      const std::size_t found = std::string("XYZ").find(*toward);
      if (toward->size() != 1 || found == std::string::npos) fail(*toward, "expected X, Y or Z");
      choice_.toward = found;
    }
    if (const auto mass = take("mass")) {
      const bool workpiece = choice_.place && choice_.place->workpiece;
      const auto& branch = workpiece ? machine_.workpiece : machine_.tool;
      for (std::size_t i = 0; i < branch.size(); ++i)
        if (std::to_string(branch[i].n) == *mass) choice_.mass = i;
      if (!choice_.mass) fail(*mass, "the branch has no transform of this number");
    }
  }

  void choose_form() {
    const auto label = take("form");
    if (choice_.effect == &custom_effect() || choice_.effect->has_found_terms()) {
      choice_.form = &choice_.effect->forms.front();
      return;
    }
    for (const EffectForm& form : choice_.effect->forms) {
      if (label ? form.label != *label : !fits(form)) continue;
      choice_.form = &form;
      return;
    }
    if (label) fail(*label, "this effect has no form of this name");
    fail(id_, "no form of this effect accepts these inputs at this degree of freedom");
  }

  static bool acts_at_one(const EffectForm& form) {
    return form.place != PlaceRule::kEachAxis && form.place != PlaceRule::kPair &&
           form.place != PlaceRule::kNormal && !form.acts_at_transform();
  }

  void fill_place() {
    const bool needs_axis = choice_.form->asks_for("q") || choice_.form->asks_for("hats");
    if (needs_axis && !choice_.axis) choice_.axis = default_axis_;
    if (choice_.form->acts_at_transform()) {
      if (dof_)
        fail(*dof_, choice_.form->place == PlaceRule::kPoint
                        ? "this form acts at the three lengths of the transform; do not give dof"
                        : "the term names the degrees of freedom; do not give dof");
      choice_.place = transform_;
      if (!choice_.place) fail(id_, "the location of the effect is missing: give branch and transform");
      return;
    }
    if (!acts_at_one(*choice_.form)) {
      if (transform_ || dof_)
        fail(dof_.value_or("transform"), "this form acts at several degrees of freedom; do not give dof");
      return;
    }
    if (choice_.place) return;
    const bool own = choice_.form->place == PlaceRule::kOwn || choice_.form->place == PlaceRule::kJoint;
    if (own && choice_.axis) choice_.place = axes_.own(*choice_.axis);
    if (!choice_.place) fail(id_, "the location of the effect is missing: give branch, transform and dof");
  }

  /// Throws if gravity has no effect: on a linear axis, and on a joint whose axis is parallel to
  /// gravity at every pose.
  void require_moment() const {
    if (!choice_.place) return;
    if (!is_angle(machine_, *choice_.place))
      fail(id_, "this effect acts at a rotary joint; the axis is not a rotary joint");
    if (!GravityChain(machine_).may_turn(*choice_.place))
      fail(id_,
           "gravity is parallel to the axis of this joint at every pose, so gravity has no moment about the "
           "joint");
  }

  double number(const std::string& key, const std::string& text) const {
    const auto value = text::parse_number(text);
    if (!value) fail(key + "=" + text, "expected a number");
    return *value;
  }

  void read_numbers() {
    if (const auto text = take("reference")) choice_.reference = number("reference", *text);
    if (const auto text = take("sum")) choice_.sum = *text;
    if (choice_.sum.empty() && choice_.axis) choice_.sum = machine_.axes[*choice_.axis].name;
    if (choice_.axis) {
      const model::Axis& axis = machine_.axes[*choice_.axis];
      choice_.from = axis.min.value_or(0);
      choice_.to = axis.max.value_or(0);
    }
    if (const auto text = take("from")) choice_.from = number("from", *text);
    if (const auto text = take("to")) choice_.to = number("to", *text);
    if (choice_.effect != &custom_effect() && has_range(*choice_.form) && !(choice_.to > choice_.from))
      fail(id_,
           "the axis has no min and max in the machine file: give the range of the effect with from and to");
    if (const auto runs = take("runs")) {
      std::string label;
      for (const char c : *runs + "|") {
        if (c == '|') {
          choice_.runs.push_back(unquote(label));
          label.clear();
        } else {
          label += c;
        }
      }
    }
    for (const auto& [key, value] : values_) {
      if (key.rfind("start.", 0) != 0) continue;
      const std::string name = key.substr(6);
      if (choice_.effect->find_unknown(name) == nullptr)
        fail(name, "this effect has no unknown (coefficient) of this name");
      choice_.start[name] = number(key, value);
      taken_.push_back(key);
    }
  }

  const std::string& text_;
  const model::Machine& machine_;
  AxisPlaces axes_;
  const std::vector<Effect>& effects_;
  std::string id_;
  std::map<std::string, std::string> values_;
  std::vector<std::string> taken_;
  std::optional<DofPlace> transform_;
  std::optional<std::string> dof_, branch_;
  std::optional<std::size_t> default_axis_;
  Choice choice_;
};

}  // namespace

std::string add_string(const model::Machine& machine, const Choice& c) {
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
    if (!c.form->acts_at_transform()) put("dof", dof_name(machine, *c.place));
  }
  if (c.reference) put("reference", text::number_text(*c.reference));
  for (std::size_t i = 0; i < c.units.size(); ++i)
    if (!c.units[i].empty()) put(numbered("unit", i), quote(c.units[i]));
  const bool found = custom || c.effect->has_found_terms();
  if (!found) put("form", c.form->label);
  if (!custom && c.form->asks_for("sum")) put("sum", c.sum);
  if (c.toward) put("toward", std::string(1, "XYZ"[*c.toward]));
  if (c.mass && c.place)
    put("mass", std::to_string((c.place->workpiece ? machine.workpiece : machine.tool).at(*c.mass).n));
  if (!custom && has_range(*c.form)) {
    put("from", text::number_text(c.from));
    put("to", text::number_text(c.to));
  }
  if (!c.runs.empty()) put("runs", quoted_list(c.runs));
  for (const auto& [name, value] : c.start) put("start." + name, text::number_text(value));
  if (found) put("term", c.term);
  return text;
}

Choice parse_add_string(const std::string& text, const model::Machine& machine,
                        const std::vector<Effect>& effects) {
  return AddReader(text, machine, effects).read();
}

}  // namespace vernier::effects
