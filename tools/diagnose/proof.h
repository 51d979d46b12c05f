// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/diagnose/propose/thresholds.h"
#include "tools/fit/noise/noise.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// Evidence of held-out rows for a step from one model to another.
struct Proof {
  double evidence = 0;  // natural logarithm of the likelihood ratio (an e-value) of these rows, with the step
                        // against without it
  double expected = 0;  // its mean if the step is true; the opposite if the step is absent. In both cases its
                        // variance is twice that value.
  /// Returns the required evidence for the step from one model to the other. The required evidence is odds of
  /// 20 to 1, or the odds that 99 of 100 true steps of this `expected` reach, if these odds are smaller. The
  /// logarithm of the required evidence is at least zero. Exception: if these rows depend only weakly on the
  /// step, the step must only not increase the error of these rows.
  double asked(const ProofThresholds& thresholds) const;
};

/// Evaluates the check rows under two models. before, after: residuals (measured - model) of all
/// observations; noise: correlation of the readings' errors. variance: variance of the independent noise of a
/// weighted reading, if the stated u is too small, at least 1 (with u); without u its square in mm.
Proof proof_on_check_rows(const model::Measurement& rows, const Eigen::VectorXd& before,
                          const Eigen::VectorXd& after, const fit::NoiseModel& noise, double variance);

}  // namespace vernier::diagnose
