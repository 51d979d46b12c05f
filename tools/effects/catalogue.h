// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/model/expression.h"

namespace vernier::effects {

/// Rule for the locations where a form of an effect may act. In the rules, `q` is the axis that drives the
/// effect.
enum class PlaceRule : std::uint8_t {
  kOwn,       // the degree of freedom that the axis q itself moves
  kCross,     // the other lengths of q's transform
  kTurn,      // the other angles of q's transform
  kLength,    // every length of the chain
  kAngle,     // every angle of the chain
  kBase,      // lengths of the transform that carries everything
  kBaseTurn,  // angles of that transform
  kSag,       // angles about a horizontal axis and lengths along gravity, of any transform
  kJoint,     // the angle that a rotary axis moves, where gravity has a moment about it
  kLink,      // an angle or a length of a link that several axes turn against gravity
  kBend,      // both angles of such a link across one of its local axes, together
  kEachAxis,  // own degrees of freedom of all axes, together, with one coefficient
  kPair,      // own degrees of freedom of two linear axes, together
  kNormal,    // the three lengths of the measuring frame, together, along nx ny nz
  kSeveral,   // degrees of freedom of one transform, together; a search finds the term of each
};

/// Method that finds the values of a form's unknowns.
enum class UnknownKind : std::uint8_t {
  kLinear,  // the term is linear in it
  kTime,    // a time constant: scanned from the spacing of the rows to a few times their duration, s
  kTravel,  // a decay length: scanned from the spacing to the range of q
  kPeriod,  // a period of q: scanned from 1/100 of the range (a plain sine: 1/1000) to most of it
  kGrid,    // scanned over the values that the catalogue names
};

/// Plausible values of a coefficient, in its unit.
struct PlausibleRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool contains(double value) const { return low <= value && value <= high; }
};

struct UnknownRule {
  std::string name, unit;  // unit may hold {dof} {q} {T}
  UnknownKind kind = UnknownKind::kLinear;
  double limit = 0;          // kLinear: largest plausible size of the whole term, mm or deg; 0: none
  PlausibleRange plausible;  // kLinear: of the unknown itself
  double low = 0, high = 0;  // kGrid
  std::size_t count = 0;     // kGrid, logarithmic
};

/// One form of an effect: its term, its unknowns and its location rule. The term is an expression with
/// placeholders. {q}: the driving axis; {T} {S}: inputs that are temperatures; {L}: a load; {F}: an
/// accelerometer feature; {V}: any other logged quantity; {ref}: the reference of {T}; {mid} {from} {to}
/// {span}: of the range of {q}; {hats N}: a piecewise linear basis of N functions over that range; {runs}: a
/// sum of one step per run; {sum}: the sum of parallel joints up to {q} and beyond; {n}: nx, ny or nz. Four
/// placeholders are computed from the chain (gravity.h), with magnitude at most 1. {across}: the moment of
/// gravity about the angle of a bar that points along a local axis; {across1} {across2}: of both such axes;
/// {along}: gravity along the length; {moment}: the moment of a mass farther out.
struct EffectForm {
  std::string label;
  PlaceRule place = PlaceRule::kOwn;
  std::string term;
  bool rare = false;                  // less frequent than the effect's other forms
  std::vector<model::ExprPtr> trees;  // the parsed term: one tree, two for a pair
  std::set<std::string> marks;        // of its placeholders: q, T, hats ...
  std::size_t hats = 0;               // N of {hats N}

  bool asks_for(const std::string& mark) const { return marks.contains(mark); }
  bool asks_for_input() const { return asks_for("T") || asks_for("L") || asks_for("F") || asks_for("V"); }
  /// Returns true if the condition `is` is true for any node of the term.
  template <class Is>
  bool any(const Is& is) const {
    return std::any_of(trees.begin(), trees.end(),
                       [&](const model::ExprPtr& tree) { return model::any_node(*tree, is); });
  }
};

/// Parses form.term and fills the other members of the form from it. Throws ExpressionError.
void read_term(EffectForm& form);
/// Returns the placeholders in a name of a term: dir{q} has q, {hats 5} has "hats 5".
std::vector<std::string> marks_in(const std::string& name);

/// The number that describes an effect to a person. The size is the factor times one unknown, or times the
/// root of the sum of the squares of several unknowns (the amplitude of a sine and a cosine).
struct EffectSize {
  double factor = 1;
  std::vector<std::string> unknowns;  // by their names in the catalogue
};

/// An entry of the catalogue: an effect that a report may name as missing.
struct Effect {
  std::string id, title, formula, signature, exposed_by;
  std::string short_name;          // follows the part of the machine: "Z carriage: lag"
  std::optional<EffectSize> size;  // absent: no single number describes it
  std::vector<std::string> impostors;
  bool rare = false;           // rare: needs more evidence than its alternatives
  bool needs_touches = false;  // only readings along a surface's normal can show it
  std::string
      of_instrument;  // caused by the instrument, not an error of the machine: the verdict in a sentence
  std::string
      cause;  // effects of one cause, axis and input differ in location or shape: they are no alternatives
  std::vector<EffectForm> forms;
  std::vector<UnknownRule> unknowns;

  const UnknownRule* find_unknown(std::string_view name) const;
  /// True if the terms are those of a search: each choice has its own (Choice::term).
  bool has_found_terms() const { return !forms.empty() && forms.front().place == PlaceRule::kSeveral; }
};

/// Parses effects from a text in the format of tools/docs/effects.md. `file` is for messages.
/// Throws InputError with file, line and word.
std::vector<Effect> parse_effects(const std::string& text, const std::string& file);

/// Returns the catalogue that comes with the program.
const std::vector<Effect>& built_in_effects();

/// Returns the catalogue with the entries of users' files added. An entry with a known id replaces the
/// catalogue entry.
std::vector<Effect> effect_catalogue(const std::vector<std::string>& files);

/// Returns the name of a location rule as the catalogue writes it.
const char* place_name(PlaceRule rule);

}  // namespace vernier::effects
