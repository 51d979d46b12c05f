// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/residual/types.h"

namespace vernier::residual {

/// Data that the sentence about a finding needs, in addition to the finding itself.
struct SentenceFacts {
  std::string unit, second_unit;         // units of the two columns
  double low = 0, high = 0;              // range of the column
  double at_low_um = 0, at_high_um = 0;  // value of the explained curve at `low` and at `high`
  double highest_at = 0, lowest_at = 0;  // values of the column at which the curve has its maximum and
                                         // minimum
  double step = 0;                       // of positions that are multiples of one step; 0: they are not
  bool monotone = false, time = false;
  bool direction = false;  // a column of approach directions: -1, 0 (not known), 1
  bool in_space = false;   // successive rows are neighbours in position
  std::string highest_run, lowest_run;
  std::vector<std::string> disagreeing;  // runs in which the effect should be visible but is not
};

/// Returns one sentence in plain English about a finding.
std::string sentence_of(const Finding& finding, const SentenceFacts& facts);

}  // namespace vernier::residual
