// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "tools/effects/catalogue.h"
#include "tools/model/expression.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::effects {

extern const char* const kBuiltInCatalogue;  // the text of catalogue.txt

namespace {

constexpr std::array<const char*, 16> kPlaceNames = {"own",      "cross",  "turn",  "length", "angle", "base",
                                                     "baseturn", "sag",    "joint", "link",   "bend",  "each",
                                                     "pair",     "normal", "point", "several"};

/// N of "hats N".
std::optional<std::size_t> hats_of(const std::string& mark) {
  constexpr std::string_view kHats = "hats ";
  // Largest N of {hats N}. A table of more stations is not a searchable effect.
  constexpr double kMostHats = 100;
  if (mark.rfind(kHats, 0) != 0) return std::nullopt;
  const auto count = text::parse_number(mark.substr(kHats.size()));
  if (!count || *count < 2 || *count > kMostHats || *count != std::floor(*count)) return std::nullopt;
  return static_cast<std::size_t>(*count);
}

/// Reads one catalogue, line by line.
class CatalogueReader {
 public:
  explicit CatalogueReader(const std::string& file) : file_(file) {}

  std::vector<Effect> read(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
      ++line_;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      const auto first = line.find_first_not_of(" \t");
      if (first != std::string::npos && line[first] != '#') take(line.substr(first));
    }
    if (!effects_.empty()) check(effects_.back());
    return std::move(effects_);
  }

 private:
  [[noreturn]] void fail(const std::string& word, const std::string& what) const {
    fail_at(line_, word, what);
  }
  [[noreturn]] void fail_at(std::size_t line, const std::string& word, const std::string& what) const {
    throw text::InputError(text::Place{file_, line}, word, what);
  }

  static std::string next_word(std::string& rest) {
    const auto end = rest.find_first_of(" \t");
    std::string word = rest.substr(0, end);
    const auto begin = end == std::string::npos ? end : rest.find_first_not_of(" \t", end);
    rest = begin == std::string::npos ? std::string() : rest.substr(begin);
    return word;
  }

  void take(std::string rest) {
    const std::string key = next_word(rest);
    if (key == "effect") return begin(rest);
    if (effects_.empty()) fail(key, "the first line of an effect must be \"effect ID\"");
    Effect& now = effects_.back();
    if (rest.empty()) fail(key, "this line has no text after its first word");
    if (key == "title")
      now.title = rest;
    else if (key == "short")
      now.short_name = rest;
    else if (key == "size")
      take_size(now, rest);
    else if (key == "formula")
      now.formula = rest;
    else if (key == "signature")
      now.signature = rest;
    else if (key == "exposed")
      now.exposed_by = rest;
    else if (key == "impostors")
      while (!rest.empty()) now.impostors.push_back(next_word(rest));
    else if (key == "rare")
      now.rare = true;
    else if (key == "builds-up")
      now.builds_up = true;
    else if (key == "touches")
      now.needs_touches = true;
    else if (key == "instrument")
      now.of_instrument = rest;
    else if (key == "cause")
      now.cause = next_word(rest);
    else if (key == "seldom")
      take_seldom(now, rest);
    else if (key == "form")
      take_form(now, rest);
    else if (key == "unknown")
      take_unknown(now, rest);
    else
      fail(key,
           "expected effect, title, short, size, formula, signature, exposed, impostors, rare, builds-up, "
           "touches, "
           "instrument, cause, seldom, form or unknown");
  }

  void begin(const std::string& id) {
    if (!effects_.empty()) check(effects_.back());
    if (id.empty() || id.find_first_of(" \t:,=") != std::string::npos) fail(id, "not an effect id");
    for (const Effect& other : effects_)
      if (other.id == id) fail(id, "the catalogue has this effect twice");
    effects_.push_back({});
    effects_.back().id = id;
    first_line_ = line_;
    form_line_.clear();
  }

  void take_size(Effect& effect, std::string rest) const {
    static constexpr const char* kForm = "a size is \"size FACTOR UNKNOWN... [as NAME]\"";
    EffectSize size;
    const std::string factor = next_word(rest);
    const auto value = text::parse_number(factor);
    if (!value || *value == 0 || rest.empty()) fail(factor, kForm);
    size.factor = *value;
    while (!rest.empty()) {
      std::string word = next_word(rest);
      if (word != "as") {
        size.unknowns.push_back(std::move(word));
        continue;
      }
      if (rest.empty() || size.unknowns.empty()) fail(word, kForm);
      size.name = std::exchange(rest, "");
    }
    effect.size = size;
  }

  void take_form(Effect& effect, std::string rest) {
    EffectForm form;
    form.label = next_word(rest);
    const std::string place = next_word(rest);
    const auto found = std::find(kPlaceNames.begin(), kPlaceNames.end(), place);
    if (found == kPlaceNames.end())
      fail(place, "unknown location rule; known rules are own, cross, turn, length, angle, base, ...");
    if (rest.empty()) fail(form.label, "a form is \"form LABEL PLACE TERM\"");
    form.place = static_cast<PlaceRule>(found - kPlaceNames.begin());
    form.term = rest;
    check_braces(rest);
    try {
      read_term(form);
    } catch (const model::ExpressionError& error) {
      fail(rest, error.what());
    }
    for (const EffectForm& other : effect.forms)
      if (other.label == form.label) fail(form.label, "the effect has two forms of this label");
    effect.forms.push_back(form);
    form_line_.push_back(line_);
  }

  void check_braces(const std::string& term) const {
    for (std::size_t at = 0; at < term.size(); ++at) {
      if (term[at] == '}') fail(term.substr(at), "} without {");
      if (term[at] != '{') continue;
      const auto end = term.find('}', at);
      if (end == std::string::npos) fail(term.substr(at), "{ without }");
      at = end;
    }
  }

  void take_seldom(Effect& effect, std::string rest) const {
    while (!rest.empty()) {
      const std::string label = next_word(rest);
      const auto form = std::find_if(effect.forms.begin(), effect.forms.end(),
                                     [&](const EffectForm& f) { return f.label == label; });
      if (form == effect.forms.end())
        fail(label, "no line \"form\" of this effect above this line has this label");
      form->rare = true;
    }
  }

  void take_unknown(Effect& effect, std::string rest) {
    UnknownRule rule;
    rule.name = next_word(rest);
    if (!text::is_name(rule.name) || model::is_reserved_word(rule.name))
      fail(rule.name, "an unknown cannot have this name, because the name is reserved");
    if (effect.find_unknown(rule.name) != nullptr) fail(rule.name, "the effect declares this unknown twice");
    rule.unit = next_word(rest);
    std::string kind = next_word(rest);
    const auto number = [&] {
      const std::string word = next_word(rest);
      const auto value = text::parse_number(word);
      if (!value) fail(word, "expected a number");
      return *value;
    };
    if (kind == "scale") {
      rule.scale = number();
      if (!(*rule.scale > 0)) fail(rule.name, "a scale is a number above 0");
      kind = next_word(rest);
    }
    if (kind == "linear") {
      rule.kind = UnknownKind::kLinear;
      if (!rest.empty()) rule.limit = number();
      if (!rest.empty()) {
        rule.plausible.low = number();
        rule.plausible.high = number();
        if (!(rule.plausible.low < rule.plausible.high))
          fail(rule.name, "the plausible range is \"LOW HIGH\" with LOW < HIGH");
      }
    } else if (kind == "time") {
      rule.kind = UnknownKind::kTime;
    } else if (kind == "travel") {
      rule.kind = UnknownKind::kTravel;
    } else if (kind == "period") {
      rule.kind = UnknownKind::kPeriod;
    } else if (kind == "grid") {
      rule.kind = UnknownKind::kGrid;
      rule.low = number();
      rule.high = number();
      const double count = number();
      if (!(rule.low > 0 && rule.high > rule.low && count >= 2 && count <= 1000))
        fail(rule.name, "a grid is \"grid LOW HIGH COUNT\" with 0 < LOW < HIGH and COUNT 2 to 1000");
      rule.count = static_cast<std::size_t>(count);
    } else {
      fail(kind, "the line \"unknown NAME UNIT KIND\" needs as KIND: linear, time, travel, period or grid");
    }
    if (!rest.empty()) fail(rest, "this line has more words than the keyword allows");
    effect.unknowns.push_back(rule);
  }

  void check(const Effect& effect) const {
    if (effect.forms.empty()) fail_at(first_line_, effect.id, "the effect has no form; add a line with form");
    if (effect.title.empty() || effect.signature.empty())
      fail_at(first_line_, effect.id, "title or signature is missing");
    if (effect.unknowns.empty())
      fail_at(first_line_, effect.id, "the effect has no unknown; add a line with unknown");
    if (effect.size)
      for (const std::string& name : effect.size->unknowns)
        if (effect.find_unknown(name) == nullptr)
          fail_at(first_line_, name, "size: this effect declares no unknown (coefficient) of this name");
    std::set<std::string> used;
    for (std::size_t i = 0; i < effect.forms.size(); ++i) {
      const std::set<std::string> here = unknowns_of(effect, effect.forms[i], form_line_[i]);
      if (here.empty())
        fail_at(form_line_[i], effect.forms[i].term,
                "the term of this form contains no unknown (coefficient) that this effect declares");
      used.insert(here.begin(), here.end());
    }
    for (const UnknownRule& rule : effect.unknowns)
      if (!used.contains(rule.name))
        fail_at(first_line_, rule.name, "no form of the effect contains this unknown (coefficient)");
  }

  /// Returns the unknowns that a form uses. Throws if its term contains something that a term may
  /// not contain.
  std::set<std::string> unknowns_of(const Effect& effect, const EffectForm& form, std::size_t line) const {
    const std::size_t terms = form.place == PlaceRule::kPair ? 2 : form.place == PlaceRule::kPoint ? 3 : 1;
    if (form.trees.size() != terms)
      fail_at(
          line, form.term,
          "a form with the location `pair` has two terms separated by |, one with the location `point` has "
          "three, every other form has one term");
    std::set<std::string> used;
    for (const model::ExprPtr& tree : form.trees)
      model::walk(*tree, [&](const model::Expr& node) {
        if (node.op != model::Op::kSymbol) return;
        for (const std::string& mark : marks_in(node.name)) check_mark(mark, line);
        if (effect.find_unknown(node.name) != nullptr) used.insert(node.name);
      });
    if (form.asks_for("hats") || form.asks_for("runs")) used.insert("h");
    if (used.contains("h") && effect.find_unknown("h") == nullptr)
      fail_at(line, form.term, "a term with {hats} or {runs} must use the unknown h");
    return used;
  }

  void check_mark(const std::string& mark, std::size_t line) const {
    static constexpr std::array kMarks = {"q",      "T",       "S",       "L",     "F",     "V", "ref",
                                          "mid",    "from",    "to",      "span",  "sum",   "n", "runs",
                                          "across", "across1", "across2", "along", "moment"};
    const bool known = std::any_of(kMarks.begin(), kMarks.end(), [&](const char* m) { return mark == m; });
    if (!known && !hats_of(mark)) fail_at(line, "{" + mark + "}", "not a placeholder");
  }

  std::string file_;
  std::size_t line_ = 0, first_line_ = 0;  // current line, and first line of the entry
  std::vector<std::size_t> form_line_;     // of the entry's forms
  std::vector<Effect> effects_;
};

}  // namespace

std::vector<std::string> marks_in(const std::string& name) {
  std::vector<std::string> marks;
  for (std::size_t at = name.find('{'); at != std::string::npos; at = name.find('{', at + 1))
    marks.push_back(name.substr(at + 1, name.find('}', at) - at - 1));
  return marks;
}

void read_term(EffectForm& form) {
  // No label of a run is in a catalogue, so a bar separates the terms of a pair or of a point.
  form.trees.clear();
  std::istringstream terms(form.term);
  for (std::string term; std::getline(terms, term, '|');) form.trees.push_back(model::parse_template(term));
  for (const model::ExprPtr& tree : form.trees)
    model::walk(*tree, [&](const model::Expr& node) {
      if (node.op != model::Op::kSymbol) return;
      for (const std::string& mark : marks_in(node.name)) {
        if (const auto hats = hats_of(mark)) form.hats = *hats;
        form.marks.insert(mark.substr(0, mark.find(' ')));
      }
    });
}

const UnknownRule* Effect::find_unknown(std::string_view name) const {
  for (const UnknownRule& rule : unknowns)
    if (rule.name == name) return &rule;
  return nullptr;
}

const char* place_name(PlaceRule rule) { return kPlaceNames[static_cast<std::size_t>(rule)]; }

std::vector<Effect> parse_effects(const std::string& text, const std::string& file) {
  return CatalogueReader(file).read(text);
}

const std::vector<Effect>& built_in_effects() {
  static const std::vector<Effect> effects = parse_effects(kBuiltInCatalogue, "catalogue.txt");
  return effects;
}

std::vector<Effect> effect_catalogue(const std::vector<std::string>& files) {
  std::vector<Effect> all = built_in_effects();
  for (const std::string& file : files)
    for (Effect& effect : parse_effects(text::read_file(file), file)) {
      const auto same =
          std::find_if(all.begin(), all.end(), [&](const Effect& e) { return e.id == effect.id; });
      if (same == all.end())
        all.push_back(std::move(effect));
      else
        *same = std::move(effect);
    }
  return all;
}

}  // namespace vernier::effects
