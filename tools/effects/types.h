// SPDX-License-Identifier: GPL-3.0-or-later
// Data types for an effect at a location of a machine.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/effects/places.h"

namespace vernier::effects {

/// All data that are necessary to add a form of an effect to a machine. An `add` string contains the same
/// data.
struct Choice {
  const Effect* effect = nullptr;
  const EffectForm* form = nullptr;
  std::optional<std::size_t> axis, axis2;  // axis: placeholder {q}; axis2: the second axis of a pair
  std::vector<std::string> inputs;         // inputs for the placeholders {T} or {L} or {F}, then {S}
  std::vector<std::string> units;          // units of the inputs
  std::optional<DofPlace> place;
  std::string sum;                    // text for the placeholder {sum}
  std::optional<std::size_t> toward;  // for {across}: local axis of the bar, 0 to 2
  std::optional<std::size_t> mass;    // for {moment}: index of the transform in its branch behind which the
                                      // mass is
  std::optional<double> reference;    // for {ref}; no value: the declared reference, or 20 if none is
                                      // declared
  double from = 0, to = 0;            // range for {from} {to} {mid} {hats N}
  std::vector<std::string> runs;      // run labels for {runs}
  std::map<std::string, double> start;
  /// Term that a search found; empty for other effects. For the effect `custom`, the term is an expression
  /// with the unknown k. For PlaceRule::kSeveral, the term has an expression with the unknowns k1, k2 … for
  /// each degree of freedom: "X:k1*Z|Z:k2".
  std::string term;
};

/// A term that an effect adds to one degree of freedom. All names in this term are final.
struct CandidateTerm {
  DofPlace place;
  std::string text;
};

/// A static that an effect adds to a machine.
struct CandidateUnknown {
  std::string name, unit;
  std::string rule;  // name of the unknown in the catalogue: k, p, tau ...
  UnknownKind kind = UnknownKind::kLinear;
  double start = 0;
  std::optional<double> scale;  // plausible size in a fit (Static::scale); no value: by the unit
  double limit = 0;  // for a linear unknown: largest plausible size of the term, mm or deg; 0: no limit
  PlausibleRange plausible;
};

/// An effect at a location in the chain of a machine. A Candidate can be evaluated, or written to a machine
/// file.
struct Candidate {
  Choice choice;
  std::vector<CandidateTerm> terms;
  std::vector<CandidateUnknown> unknowns;
  std::string label;   // name of its location: "backlash of X in X of transform 2"
  std::string spoken;  // name for people: "X carriage: backlash" (spoken.h)
};

/// Returns the linear unknowns (coefficients) of a candidate, in their order. The term of the candidate is
/// linear in these coefficients.
inline std::vector<CandidateUnknown> linear_unknowns(const Candidate& candidate) {
  std::vector<CandidateUnknown> unknowns;
  for (const CandidateUnknown& unknown : candidate.unknowns)
    if (unknown.kind == UnknownKind::kLinear) unknowns.push_back(unknown);
  return unknowns;
}
/// Returns the unknowns of a candidate that are not linear: periods, time constants, decay lengths. Other
/// functions use the order of the returned list for the values of the unknowns.
inline std::vector<CandidateUnknown> scanned_unknowns(const Candidate& candidate) {
  std::vector<CandidateUnknown> unknowns;
  for (const CandidateUnknown& unknown : candidate.unknowns)
    if (unknown.kind != UnknownKind::kLinear) unknowns.push_back(unknown);
  return unknowns;
}

}  // namespace vernier::effects
