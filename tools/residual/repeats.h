// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

/// Scatter of rows at equal conditions, compared with the residual between conditions (lack of
/// fit; Draper and Smith, Applied Regression Analysis, 3rd ed., section 2.1). Each file is an instrument with
/// a separate scatter; a file with few repeats does not contribute to the figures.
struct Repeats {
  std::size_t freedom = 0;                              // of the pure error, all lengths
  std::optional<double> pure_error_um, lack_of_fit_um;  // at least 5 degrees of freedom
  std::optional<double> log_p;                          // all kinds together
  std::vector<std::size_t> files;                       // whose repeats count, by their index
};

/// Compares the residuals of rows that measure the same state again. samples: one for each kind of reading.
Repeats compare_repeats(const std::vector<KindSample>& samples, const model::Measurement& measurement);

/// Scatter of the residual from the nearest pairs of rows in all columns but time and order, um:
/// an upper bound of the noise. Lengths only; nullopt with fewer than 10 pairs.
std::optional<double> neighbour_error_um(const std::vector<KindSample>& samples,
                                         const std::vector<RecordedColumn>& columns);

}  // namespace vernier::residual
