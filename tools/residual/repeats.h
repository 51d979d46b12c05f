// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

#include "tools/residual/sample.h"

namespace vernier::residual {

/// Scatter of rows at equal conditions, compared with the residual between conditions (lack of
/// fit; Draper and Smith, Applied Regression Analysis, 3rd ed., section 2.1).
struct Repeats {
  std::size_t freedom = 0;                              // of the pure error, all lengths
  std::optional<double> pure_error_um, lack_of_fit_um;  // at least 5 degrees of freedom
  std::optional<double> log_p;                          // all kinds together
};

/// tool.
Repeats compare_repeats(const std::vector<KindSample>& samples, const model::Measurement& measurement);

/// Scatter of the residual from the nearest pairs of rows in all columns but time and order, um:
/// an upper bound of the noise. Lengths only; nullopt with fewer than 10 pairs. tool.
std::optional<double> neighbour_error_um(const std::vector<KindSample>& samples,
                                         const std::vector<RecordedColumn>& columns);

}  // namespace vernier::residual
