// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/model/machine.h"

namespace vernier::effects {

/// A degree of freedom of a transform of the chain.
struct DofPlace {
  bool workpiece = false;
  std::size_t transform = 0;  // position in its branch
  std::size_t dof = 0;        // as Transform::dof
  bool operator==(const DofPlace&) const = default;
};

const model::Transform& transform_at(const model::Machine& machine, const DofPlace& place);
const char* dof_name(const model::Machine& machine, const DofPlace& place);
/// Is the degree of freedom an angle (deg), no length (mm)?
bool is_angle(const model::Machine& machine, const DofPlace& place);
/// Which degree of freedom every axis moves in the nominal chain. Worked out once for a machine: that means
/// to evaluate its chain at every place. tool.
class AxisPlaces {
 public:
  explicit AxisPlaces(const model::Machine& machine);

  /// Nothing for an axis that moves none.
  const std::optional<DofPlace>& own(std::size_t axis) const { return own_.at(axis); }
  /// +1 or -1: sense in which its own degree of freedom follows an axis (-1 for Y="-Y"); 0 for an axis
  /// without.
  double sense(std::size_t axis) const { return sense_.at(axis); }
  bool is_own(std::size_t axis, const DofPlace& place) const { return own(axis) == place; }
  /// The axis that moves a transform (the first one where there are several).
  std::optional<std::size_t> axis_of(const DofPlace& place) const;

 private:
  std::vector<std::optional<DofPlace>> own_;
  std::vector<double> sense_;
};
/// The lengths X Y Z that shift the whole measuring frame, where the chain has such a transform: the first
/// one of a chain without workpiece branch, the last one of a workpiece branch that does not turn there.
std::vector<DofPlace> base_places(const model::Machine& machine);
/// The machine with a place for rigid motions of the whole: where it has no base_places, because the row
/// there turns (a DH row, a table), an identity sixdof stands in at that end of the chain, numbered one below
/// the first row or one above the last. Predictions are the same; add_to_machine_text writes the row once it
/// takes a term. Places of diagnose, plan and `add` are those of this machine. tool.
model::Machine with_base_row(model::Machine machine);
/// Is the transform of this place one that with_base_row put in? It stands on no line of the file.
bool is_stand_in(const model::Machine& machine, const DofPlace& place);
/// The degrees of freedom of the transforms that carry everything: the first one of the tool branch and the
/// last one of the workpiece branch, each where the chain has that branch; beside a stand-in the row next to
/// it.
std::vector<DofPlace> carrier_places(const model::Machine& machine);
/// All degrees of freedom, tool branch first.
std::vector<DofPlace> all_places(const model::Machine& machine);

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

/// The `add` string of a choice, and back (FORMATS section 3). What the string leaves open is filled with the
/// axis' own transform and the form's first fit. Throws InputError with the offending word. tool.
std::string add_string(const model::Machine& machine, const Choice& choice);
Choice parse_add_string(const std::string& text, const model::Machine& machine,
                        const std::vector<Effect>& effects);

/// The machine file with the candidate's terms, statics (nominal 0) and inputs written into it; nothing else
/// changes. Throws InputError. tool.
std::string add_to_machine_text(const std::string& text, const model::Machine& machine,
                                const Candidate& candidate);

/// The effect of a term found by search: no named physics.
const Effect& custom_effect();

}  // namespace vernier::effects
