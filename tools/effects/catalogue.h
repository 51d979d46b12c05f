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

/// Rule for the locations in the chain where a form of an effect may act. In these rules, `q` is the axis
/// that drives the effect.
enum class PlaceRule : std::uint8_t {
  kOwn,       // the degree of freedom that the axis q itself moves
  kCross,     // the other lengths of the transform that q moves
  kTurn,      // the other angles of the transform that q moves
  kLength,    // every length of the chain
  kAngle,     // every angle of the chain
  kBase,      // lengths of the transform that carries the whole machine
  kBaseTurn,  // angles of the transform that carries the whole machine
  kSag,       // angles about a horizontal axis and lengths along gravity, of any transform
  kJoint,     // the angle that a rotary axis moves, if gravity has a moment about this axis
  kLink,      // an angle or a length of a link that several axes rotate relative to gravity
  kBend,      // both angles of such a link across one of its local axes, together with one cause
  kEachAxis,  // the own degrees of freedom of all axes together, with one coefficient
  kPair,      // the own degrees of freedom of two linear axes together
  kNormal,    // the three lengths of the measuring frame together, along nx ny nz
  kPoint,    // the three lengths of a constant `sixdof` behind all axes of its branch together (a tool point)
  kSeveral,  // degrees of freedom of one transform together; a search finds the term of each
};

/// Method that finds the values of a form's unknowns.
enum class UnknownKind : std::uint8_t {
  kLinear,  // the term is linear in this unknown
  kTime,    // a time constant, s: searched from the interval between rows to a few times the duration of the
            // rows
  kTravel,  // a decay length: searched from the distance between positions to the range of q
  kPeriod,  // a period of q: searched from 1/100 of the range (a plain sine: 1/1000) to most of the range
  kGrid,    // searched over the values that the catalogue lists
};

/// Plausible values of a coefficient, in its unit.
struct PlausibleRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool contains(double value) const { return low <= value && value <= high; }
};

struct UnknownRule {
  std::string name, unit;  // name and unit; the unit may contain {dof} {q} {T}
  UnknownKind kind = UnknownKind::kLinear;
  std::optional<double> scale;  // plausible size in a fit (Static::scale), in the unit of the unknown
  double limit = 0;          // for kLinear: largest plausible size of the whole term, mm or deg; 0: no limit
  PlausibleRange plausible;  // for kLinear: plausible range of the unknown itself
  double low = 0, high = 0;  // for kGrid: lowest and highest value
  std::size_t count = 0;     // for kGrid: number of values, on a logarithmic scale
};

/// One form of an effect: its term, its unknowns and its location rule. The term is an expression with
/// placeholders. {q}: the driving axis; {T} {S}: inputs that are temperatures; {L}: a load; {F}: an
/// accelerometer feature; {V}: any other logged quantity; {ref}: the reference of {T}; {mid} {from} {to}
/// {span}: of the range of {q}; {hats N}: a piecewise linear basis of N functions over that range; {runs}: a
/// sum of one step per run; {sum}: the sum of parallel joints up to {q} and beyond; {n}: nx, ny or nz. Four
/// placeholders of a term stand for moments and components of gravity, computed from the chain (gravity.h),
/// with magnitude at most 1. {across}: the moment of gravity about the angle of a bar that points along a
/// local axis; {across1} {across2}: of both such axes; {along}: gravity along the length; {moment}: the
/// moment of a mass farther out.
struct EffectForm {
  std::string label;
  PlaceRule place = PlaceRule::kOwn;
  std::string term;
  bool rare = false;                  // true: this form is less frequent than the other forms of the effect
  std::vector<model::ExprPtr> trees;  // the parsed term: one tree, two for a pair, three for a point
  std::set<std::string> marks;        // names of the placeholders: q, T, hats ...
  std::size_t hats = 0;               // N of {hats N}

  bool asks_for(const std::string& mark) const { return marks.contains(mark); }
  /// True if the form acts at degrees of freedom of one transform together; a choice then has no dof.
  bool acts_at_transform() const { return place == PlaceRule::kSeveral || place == PlaceRule::kPoint; }
  bool asks_for_input() const { return asks_for("T") || asks_for("L") || asks_for("F") || asks_for("V"); }
  /// Returns true if the condition `is` is true for any node of the term.
  template <class Is>
  bool any(const Is& is) const {
    return std::any_of(trees.begin(), trees.end(),
                       [&](const model::ExprPtr& tree) { return model::any_node(*tree, is); });
  }
};

/// Parses form.term, and sets the other members of the form from the term. Throws ExpressionError if the term
/// is not valid.
void read_term(EffectForm& form);
/// Returns the placeholders in a name: q for dir{q}, "hats 5" for {hats 5}.
std::vector<std::string> marks_in(const std::string& name);

/// The number that a report states as the size of an effect. The size is the factor times one unknown, or
/// times the root of the sum of the squares of several unknowns (the amplitude of a sine and a cosine).
struct EffectSize {
  double factor = 1;
  std::vector<std::string> unknowns;  // names of the unknowns in the catalogue
  std::string name;                   // name of the number, "reversal value B"; empty: that of the effect
};

/// An entry of the catalogue: an effect that a report may name as missing.
struct Effect {
  std::string id, title, formula, signature, exposed_by;
  std::string short_name;          // follows the name of the machine part, as in "Z carriage: lag"
  std::optional<EffectSize> size;  // no value if no single number describes the size of the effect
  std::vector<std::string> impostors;
  bool rare = false;           // true: the effect is rare and needs more evidence than its alternatives
  bool builds_up = false;      // true: a function of the travel since a reversal, of unknown shape; other
                               // reversal errors of the axis can be parts of it
  bool needs_touches = false;  // true: only readings along the normal of a surface can show the effect
  std::string
      of_instrument;  // sentence for the verdict if the instrument, and not the machine, causes the effect
  std::string cause;  // effects with the same cause, axis and input differ only in location or shape and are
                      // not alternatives
  std::vector<EffectForm> forms;
  std::vector<UnknownRule> unknowns;

  const UnknownRule* find_unknown(std::string_view name) const;
  /// True if a search finds the terms of this effect. If a search finds the terms, each choice of the effect
  /// has its own term (Choice::term).
  bool has_found_terms() const { return !forms.empty() && forms.front().place == PlaceRule::kSeveral; }
};

/// Parses effects from a text in the format of tools/docs/effects.md. `file`: name of the file in messages.
/// If the text is not a catalogue of effects, throws InputError with file, line and word.
std::vector<Effect> parse_effects(const std::string& text, const std::string& file);

/// Returns the catalogue of effects that is part of the program.
const std::vector<Effect>& built_in_effects();

/// Returns the built-in catalogue with the effects of the users' files added. An effect in a user's file
/// replaces the built-in effect with the same id.
std::vector<Effect> effect_catalogue(const std::vector<std::string>& files);

/// Returns the name of a location rule as it is in the catalogue.
const char* place_name(PlaceRule rule);

}  // namespace vernier::effects
