// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

/// Settings of a search for findings that are equal for all kinds.
struct FindingContext {
  const model::Measurement& measurement;
  const std::vector<RecordedColumn>& columns;
  std::size_t tried = 1;  // terms and frequencies of all kinds: the factor of every p-value
  double least_p = 0.01;  // corrected; a finding must be below it
};

/// Returns the number of terms and frequencies that a search over this sample tries.
std::size_t count_tried(const KindSample& sample, const std::vector<RecordedColumn>& columns);

/// Selects the most significant term, then the most significant term beside it, and so on. Then
/// find_structure removes terms that are superfluous beside the other terms. Sentences are filled in. Shares
/// of every column are added to `shares`.
std::vector<Finding> find_structure(const KindSample& sample, const FindingContext& context,
                                    std::vector<ColumnShare>& shares);

}  // namespace vernier::residual
