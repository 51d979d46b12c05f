// SPDX-License-Identifier: GPL-3.0-or-later
// An effect at a place of a machine: values, no algorithm.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/effects/places.h"

namespace vernier::effects {

/// All data that are necessary to add a form of an effect to a machine: the content of an `add` string.
struct Choice {
  const Effect* effect = nullptr;
  const EffectForm* form = nullptr;
  std::optional<std::size_t> axis, axis2;  // {q}, and the second axis of a pair
  std::vector<std::string> inputs;         // {T} or {L} or {F}, then {S}
  std::vector<std::string> units;          // of the inputs
  std::optional<DofPlace> place;
  std::string sum;                    // {sum}
  std::optional<std::size_t> toward;  // {across}: local axis of the bar, 0 to 2
  std::optional<std::size_t> mass;    // {moment}: the transform of its branch behind which the mass is
  std::optional<double> reference;    // {ref}; no value: the declared reference, 20 if none is declared
  double from = 0, to = 0;            // {from} {to} {mid} {hats N}
  std::vector<std::string> runs;      // {runs}
  std::map<std::string, double> start;
  /// Of a term that a search found. Effect `custom`: an expression with the unknown k. PlaceRule::kSeveral:
  /// an expression with the unknowns k1, k2 … for each degree of freedom, "X:k1*Z|Z:k2".
  std::string term;
};

/// A term that an effect adds to one degree of freedom. The names are final.
struct CandidateTerm {
  DofPlace place;
  std::string text;
};

/// A static that an effect adds.
struct CandidateUnknown {
  std::string name, unit;
  std::string rule;  // name in the catalogue: k, p, tau ...
  UnknownKind kind = UnknownKind::kLinear;
  double start = 0;
  double limit = 0;  // linear: largest plausible size of the term, mm or deg; 0: none
  PlausibleRange plausible;
};

/// An effect at a location of a machine. A Candidate can be evaluated, or written to a machine file.
struct Candidate {
  Choice choice;
  std::vector<CandidateTerm> terms;
  std::vector<CandidateUnknown> unknowns;
  std::string label;   // its location: "backlash of X in X of transform 2"
  std::string spoken;  // for people: "X carriage: backlash" (spoken.h)
};

/// Returns the unknowns that are coefficients, in the order of the candidate. The term is linear in these
/// unknowns.
inline std::vector<CandidateUnknown> linear_unknowns(const Candidate& candidate) {
  std::vector<CandidateUnknown> unknowns;
  for (const CandidateUnknown& unknown : candidate.unknowns)
    if (unknown.kind == UnknownKind::kLinear) unknowns.push_back(unknown);
  return unknowns;
}
/// Returns the unknowns that are not coefficients: periods, time constants, decay lengths. Lists of values of
/// these unknowns are in the order of this list.
inline std::vector<CandidateUnknown> scanned_unknowns(const Candidate& candidate) {
  std::vector<CandidateUnknown> unknowns;
  for (const CandidateUnknown& unknown : candidate.unknowns)
    if (unknown.kind != UnknownKind::kLinear) unknowns.push_back(unknown);
  return unknowns;
}

}  // namespace vernier::effects
