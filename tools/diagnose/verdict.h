// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <set>
#include <string>
#include <vector>

#include "tools/diagnose/finder.h"
#include "tools/diagnose/types.h"

namespace vernier::diagnose {

/// Results of the search and of the fits, as input of the verdict.
struct Findings {
  const DiagnoseOptions& options;
  const model::Measurement& measurement;  // for the machine of the base fit
  const model::Machine& machine;          // as given
  const Finder& finder;
  const std::vector<std::size_t>& accepted;       // items of the stepwise model, the cause first
  const std::set<std::size_t>& confirmed;         // items that the check rows confirm
  const std::vector<std::string>& not_confirmed;  // names of steps that the check rows contradict
  const Alternatives& alternatives;               // to the cause
  const std::vector<std::size_t>& listed;         // items in the order of Diagnosis::candidates

  /// Returns the alternatives that the data do not reject.
  std::vector<std::size_t> close() const {
    return alternatives.within(options.thresholds.acceptance.distance);
  }
};

/// Sets the verdict, its explanation and its details (`left`, `remaining`, `time_base`, `instrument`,
/// `runner_up`, aliases and confusions of candidates). The first rule that applies determines the verdict;
/// the table in the source gives the order of the rules. `answer`: with base, end, stepwise model and
/// candidates.
void set_verdict(const Findings& found, Diagnosis& answer);

}  // namespace vernier::diagnose
