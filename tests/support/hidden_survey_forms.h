// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/support/hidden_survey_family.h"
#include "tests/support/hidden_survey_inputs.h"
#include "tests/support/hidden_survey_motion.h"

namespace vernier::support {

using namespace vernier::text;

/// An effect at a place: terms with their coefficients. Texts name the linear coefficients k1, k2 ...; other
/// numbers (periods, time constants) stand in them as numbers.
struct Form {
  Cause cause;
  std::vector<std::string> inputs;
  std::vector<Place> places;
  std::vector<double> coefficients;  // of k1, k2 ...: relative sizes and signs of a plausible truth
  int free_numbers = 0;              // periods, time constants: what a search must find beside them
  std::string reference_factor;      // of an input: what an unknown reference would multiply; else empty
};

/// How a survey must be made for an effect to show, and what the model must not have.
struct Demands {
  bool moving = false, probing = false;
  bool bare = false;         // location errors held
  bool without_own = false;  // the table column at the form's place not freed
  bool shift_per_run = true;
};
Demands demands_of(const std::string& effect);

/// Where a number that a form does not fix comes from: `share` 0..1 of the range of its admissible values.
using Share = std::function<double()>;

/// Every form of an effect on a machine with these logged columns.
std::vector<Form> forms_of(const std::string& effect, const Geometry& geometry,
                           const std::vector<LoggedColumn>& columns, const std::vector<std::string>& runs,
                           const Share& share, Draw& draw);

/// Is this degree of freedom an angle?
bool is_angle(const std::string& dof);

/// All effects that forms exist for, and how many values of its unfixed number a scan should visit.
struct EffectScan {
  const char* effect;
  int steps;
};
const std::vector<EffectScan>& effect_scans();

}  // namespace vernier::support
