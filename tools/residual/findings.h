// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

/// Settings of a search for findings that are the same for all kinds of readings.
struct FindingContext {
  const model::Measurement& measurement;
  const std::vector<RecordedColumn>& columns;
  std::size_t tried = 1;  // number of tested terms and frequencies of all kinds, by which every p-value is
                          // multiplied
  double least_p = 0.01;  // limit for the corrected p-value of a finding
};

/// Returns the number of terms and frequencies that a search over this sample tests.
std::size_t count_tried(const KindSample& sample, const std::vector<RecordedColumn>& columns);

/// Selects the most significant term of the residual, then the most significant additional term, and so on.
/// After the selection, find_structure removes terms that are not significant together with the other terms.
/// The sentence of each finding is also set. The share of every column is added to `shares`.
std::vector<Finding> find_structure(const KindSample& sample, const FindingContext& context,
                                    std::vector<ColumnShare>& shares);

}  // namespace vernier::residual
