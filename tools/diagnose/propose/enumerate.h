// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/periods.h"
#include "tools/effects/candidate.h"
#include "tools/effects/input_class.h"

namespace vernier::diagnose {

/// A candidate effect, with the values over which its scanned unknowns are searched. A scanned unknown is not
/// a linear coefficient, for example a period or a time constant.
struct ScannedCandidate {
  effects::Candidate candidate;
  std::vector<std::vector<double>> grid;  // one list of increasing values for each scanned unknown
  bool may_lose_columns = false;          // true: the scan removes the columns that the free parameters of
                                          // the model also describe, and tests the candidate with its
                                          // other columns (piecewise linear basis, several runs)
  FinePeriods fine;                       // for a cyclic error: the periods shorter than those of its grid
  double penalty = 0;      // penalty for a search before the scan: twice the logarithm of the number of
                           // tested sets
  double most_driven = 2;  // factor by which a scanned unknown may leave its grid and still count as inside
                           // the search range

  /// True if a fit moved the scanned unknown `unknown` from its found value out of its search range.
  bool is_driven_out(std::size_t unknown, double found, double value) const;
};

/// Returns the candidates: every effect of the catalogue at every location of the machine that the rule of
/// the effect's form allows and that the rows can distinguish. Every logged column with a suitable unit is a
/// possible input of a candidate.
std::vector<ScannedCandidate> enumerate_candidates(const Evidence& evidence,
                                                   const std::vector<effects::Effect>& effects);

/// Returns the locations that another location of the same kind outshines: both have the same influence on
/// all observations, but the first is many times weaker. The result of outshone_places() has one flag for
/// each location, in the order of Evidence::places(). Example of a weak location: a length across the reading
/// direction that is visible only because the machine is tilted by a few minutes of arc. An effect at the
/// weak location is attributed to the strong location.
std::vector<char> outshone_places(const Evidence& evidence);

/// Returns the degrees of freedom of the chain that the observations can distinguish. Several degrees of
/// freedom may have the same influence on all observations (all but 1e-7 of the direction). If several
/// degrees of freedom have the same influence, only the first of them is in the result. Degrees of freedom of
/// transforms in the machine file have priority over those of the transform that with_base_row() adds.
/// `angles_apart`: true if an angle and a length with the same influence both stay in the result.
std::vector<effects::DofPlace> distinct_places(const Evidence& evidence, bool angles_apart);

}  // namespace vernier::diagnose
