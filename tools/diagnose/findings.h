// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tools/diagnose/finder.h"
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

  /// Returns the alternatives to an accepted effect that the data do not reject. An alternative to the first
  /// effect is none to a later one: it would be counted twice.
  std::vector<std::size_t> close(std::size_t position) const {
    const double distance = options.thresholds.acceptance.distance;
    // A rare form of the same columns is at the limit itself, and the fits beside other effects move it.
    constexpr double kMovedByFits = 0.1;  // BIC
    std::vector<std::size_t> items =
        alternatives[position].within(position == 0 ? distance : distance - kMovedByFits);
    if (position == 0) return items;
    const std::vector<std::size_t> of_first = alternatives.front().within(distance);
    std::erase_if(items, [&](std::size_t item) {
      return std::find(of_first.begin(), of_first.end(), item) != of_first.end();
    });
    return items;
  }
};

}  // namespace vernier::diagnose
