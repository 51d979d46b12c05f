// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

#include "tools/diagnose/thresholds.h"
#include "tools/fit/noise.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// What rows that no fit and no selection saw say of a step from one model to another.
struct Proof {
  double evidence = 0;  // natural logarithm of the likelihood ratio (an e-value): how much likelier the step
                        // makes these rows
  double expected = 0;  // what it would be on average if the step were true; the opposite if it were not
                        // there at all. Either way its variance is twice that.
  /// What the step must bring: 20 to 1 where all but one true step in a hundred would, less where it is too
  /// small on these rows for that, but never less than nothing. None where it hardly shows on them.
  std::optional<double> asked(const ProofThresholds& thresholds) const;
};

/// The check rows under two models. before, after: residuals (measured - model) of all observations; noise:
/// how the readings' errors are correlated; variance: of a weighted reading's own part, where the stated u is
/// too small, at least 1 (with u); without u its square in mm. tool.
Proof proof_on_check_rows(const model::Measurement& rows, const Eigen::VectorXd& before,
                          const Eigen::VectorXd& after, const fit::NoiseModel& noise, double variance);

}  // namespace vernier::diagnose
