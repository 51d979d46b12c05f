// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/periods.h"
#include "tools/effects/candidate.h"
#include "tools/effects/input_class.h"

namespace vernier::diagnose {

/// A candidate, and the values over which its scanned unknowns are searched.
struct ScannedCandidate {
  effects::Candidate candidate;
  std::vector<std::vector<double>> grid;  // one list per unknown that is not a coefficient, increasing
  bool may_lose_columns = false;          // piecewise linear basis: the model may absorb a part of its span
  FinePeriods fine;                       // of a cyclic error: the periods below its grid
  double penalty = 0;      // of a search before the scan: twice the logarithm of the number of tested sets
  double most_driven = 2;  // factor beyond the grid that still counts as inside the search range

  /// True if a fit moved a scanned unknown from its found value out of the range of its search.
  bool is_driven_out(std::size_t unknown, double found, double value) const;
};

/// Returns every effect of the catalogue at every location of the machine that the rule of its
/// form admits and that the rows can distinguish. Every logged column with a suitable unit is an
/// input.
std::vector<ScannedCandidate> enumerate_candidates(const Evidence& evidence,
                                                   const std::vector<effects::Effect>& effects);

/// Returns locations whose influence on all observations equals that of another location of their kind, but
/// is many times weaker. Index: as Evidence::places(). Example: a length across the reading direction that is
/// visible only because the machine is tilted by minutes. An effect that a survey shows at such a location
/// belongs to the other location.
std::vector<char> outshone_places(const Evidence& evidence);

/// Returns the degrees of freedom that the observations can distinguish. Among degrees of freedom with the
/// same influence on all observations (all but 1e-7 of the direction), the first is used. Rows of the machine
/// file have priority over an added row. `angles_apart`: returns the first angle and the first length.
std::vector<effects::DofPlace> distinct_places(const Evidence& evidence, bool angles_apart);

}  // namespace vernier::diagnose
