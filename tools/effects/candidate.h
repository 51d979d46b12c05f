// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/effects/places.h"
#include "tools/model/machine.h"

namespace vernier::effects {

/// What has to be said to put a form of an effect into a machine: the content of an `add` string.
struct Choice {
  const Effect* effect = nullptr;
  const EffectForm* form = nullptr;
  std::optional<std::size_t> axis, axis2;  // {q}, and the second one of a pair
  std::vector<std::string> inputs;         // {T} or {L} or {F}, then {S}
  std::vector<std::string> units;          // of the inputs
  std::optional<DofPlace> place;
  std::string sum;                    // {sum}
  std::optional<std::size_t> toward;  // {across}: local axis of the bar, 0 to 2
  std::optional<std::size_t> mass;    // {moment}: the transform of its branch behind which the mass sits
  std::optional<double> reference;    // {ref}; none: the declared one, 20 for one not declared
  double from = 0, to = 0;            // {from} {to} {mid} {hats N}
  std::vector<std::string> runs;      // {runs}
  std::map<std::string, double> start;
  std::string term;  // of a found expression (effect `custom`)
};

/// A term that an effect adds to one degree of freedom; names are the final ones.
struct CandidateTerm {
  DofPlace place;
  std::string text;
};

/// A static that an effect brings along.
struct CandidateUnknown {
  std::string name, unit;
  std::string rule;  // name in the catalogue: k, p, tau ...
  UnknownKind kind = UnknownKind::kLinear;
  double start = 0;
  double limit = 0;  // linear: largest plausible size of the term, mm or deg; 0: none
};

/// An effect at a place of a machine, ready to be evaluated or written.
struct Candidate {
  Choice choice;
  std::vector<CandidateTerm> terms;
  std::vector<CandidateUnknown> unknowns;
  std::string label;   // where it stands: "backlash of X in X of transform 2"
  std::string spoken;  // for people: "X carriage: backlash" (spoken.h)
};

/// The unknowns that are coefficients, in their order: what the term is linear in.
inline std::vector<CandidateUnknown> linear_unknowns(const Candidate& candidate) {
  std::vector<CandidateUnknown> unknowns;
  for (const CandidateUnknown& unknown : candidate.unknowns)
    if (unknown.kind == UnknownKind::kLinear) unknowns.push_back(unknown);
  return unknowns;
}
/// The others: periods, time constants, decay lengths. Lists of their values are in this order.
inline std::vector<CandidateUnknown> scanned_unknowns(const Candidate& candidate) {
  std::vector<CandidateUnknown> unknowns;
  for (const CandidateUnknown& unknown : candidate.unknowns)
    if (unknown.kind != UnknownKind::kLinear) unknowns.push_back(unknown);
  return unknowns;
}

/// The choice of a candidate with its scanned unknowns starting at these values. tool.
Choice choice_at(const Candidate& candidate, const std::vector<double>& scanned);

/// Adds a candidate's unknowns to the machine's statics, so that its terms can be evaluated: the coefficients
/// at 0, the others at `scanned` (0 where that is empty). Returns the index of each coefficient. tool.
std::vector<std::size_t> add_unknowns(model::Machine& machine, const Candidate& candidate,
                                      const std::vector<double>& scanned);

/// Fills the placeholders and names the unknowns so that they clash with nothing in the machine. `axes`: of
/// the same machine. Throws InputError where the choice leaves something open that the form needs. tool.
Candidate make_candidate(const model::Machine& machine, const AxisPlaces& axes, const Choice& choice);
Candidate make_candidate(const model::Machine& machine, const Choice& choice);

/// The effect of a term found by search: no named physics.
const Effect& custom_effect();

}  // namespace vernier::effects
