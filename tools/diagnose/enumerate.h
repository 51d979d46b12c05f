// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/evidence.h"
#include "tools/diagnose/periods.h"
#include "tools/effects/candidate.h"
#include "tools/effects/input_class.h"

namespace vernier::diagnose {

/// A candidate, and the values over which its scanned unknowns are looked for.
struct ScannedCandidate {
  effects::Candidate candidate;
  std::vector<std::vector<double>> grid;  // one list per unknown that is no coefficient, increasing
  bool may_lose_columns = false;          // hats: the model may absorb a part of their span
  FinePeriods fine;                       // of a wave: the periods below its grid
  double most_driven = 2;                 // times beyond the grid that is still where it was looked for

  /// Did a fit drive a scanned unknown from where it was found out of the range in which it was looked for?
  bool is_driven_out(std::size_t unknown, double found, double value) const;
};

/// Every effect of the catalogue at every place of the machine that the rule of its form admits and that the
/// rows can tell apart, with every logged column as input whose unit fits. tool.
std::vector<ScannedCandidate> enumerate_candidates(const Evidence& evidence,
                                                   const std::vector<effects::Effect>& effects);

/// Places, as Evidence::places(), that do to all observations what another one of their kind does many times
/// as strongly: a length across the reading, seen through a tilt of the machine by minutes. What a survey
/// shows there sits at the other one. tool.
std::vector<char> outshone_places(const Evidence& evidence);

/// The degrees of freedom that the observations can tell apart: of those that do the same to all observations
/// (all but 1e-7 of the direction) the first one, rows of the file before one that stands in. `angles_apart`:
/// the first angle and the first length. tool.
std::vector<effects::DofPlace> distinct_places(const Evidence& evidence, bool angles_apart);

}  // namespace vernier::diagnose
