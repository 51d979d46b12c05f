// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <set>
#include <string>
#include <vector>

#include "tools/diagnose/finder.h"
#include "tools/diagnose/refit.h"
#include "tools/diagnose/types.h"

namespace vernier::diagnose {

/// Results of the search and of the fits, from which the verdict is determined.
struct Findings {
  const DiagnoseOptions& options;
  const model::Measurement& measurement;  // measurement of the machine of the base fit
  const model::Machine& machine;          // machine as the user gave it
  const Finder& finder;
  const std::vector<std::size_t>& accepted;       // indices of the effects of the stepwise model; the cause
                                                  // is first
  const std::set<std::size_t>& confirmed;         // indices of the effects that the check rows confirm
  const std::vector<std::string>& not_confirmed;  // names of the steps that the check rows contradict
  const std::vector<Alternatives>& alternatives;  // alternatives to each accepted effect
  const std::vector<std::size_t>& listed;         // indices of the effects in the order of
                                                  // Diagnosis::candidates

  /// Alternatives to an accepted effect that the data do not reject.
  std::vector<std::size_t> close(std::size_t position) const {
    return not_rejected(alternatives, position, options.thresholds.acceptance.distance);
  }
};

}  // namespace vernier::diagnose
