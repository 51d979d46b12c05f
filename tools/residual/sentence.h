// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/residual/types.h"

namespace vernier::residual {

/// Data that the sentence of a finding needs in addition to the finding.
struct SentenceFacts {
  std::string unit, second_unit;         // of the columns
  double low = 0, high = 0;              // range of the column
  double at_low_um = 0, at_high_um = 0;  // the explained curve there
  double highest_at = 0, lowest_at = 0;  // where the curve is highest and lowest
  bool monotone = false, time = false;
  std::string highest_run, lowest_run;
  std::vector<std::string> disagreeing;  // runs in which the effect would be visible, but is not
};

/// Returns one sentence in plain English for a finding.
std::string sentence_of(const Finding& finding, const SentenceFacts& facts);

}  // namespace vernier::residual
