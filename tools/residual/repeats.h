// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

/// Scatter of rows with equal conditions (pure error), compared with the residual between different
/// conditions (lack of fit; Draper and Smith, Applied Regression Analysis, 3rd ed., section 2.1). Each
/// measurement file counts as an instrument with its own scatter. A file with few repeats does not
/// contribute to the scatter and the lack of fit.
struct Repeats {
  std::size_t freedom = 0;                              // degrees of freedom of the pure error, for all
                                                        // lengths
  std::optional<double> pure_error_um, lack_of_fit_um;  // no value for fewer than 5 degrees of freedom
  std::optional<double> log_p;                          // logarithm of the p-value for all kinds together
  std::vector<std::size_t> files;                       // indices of the files whose repeats are used
};

/// Compares the residuals of rows that measure the same state more than once. `samples`: one sample for each
/// kind of reading.
Repeats compare_repeats(const std::vector<KindSample>& samples, const model::Measurement& measurement);

/// Returns the scatter of the residual, um, from the nearest pairs of rows in all columns except time and
/// order. The scatter of the nearest pairs is an upper limit of the noise. Only readings of lengths are used
/// for the scatter. The function neighbour_error_um() returns nullopt if there are fewer than 10 pairs.
std::optional<double> neighbour_error_um(const std::vector<KindSample>& samples,
                                         const std::vector<RecordedColumn>& columns);

}  // namespace vernier::residual
