// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/diagnose/propose/thresholds.h"
#include "tools/fit/noise/noise.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// Evidence of held-out rows for one step of the stepwise model. A step adds one effect to the model.
struct Proof {
  double evidence = 0;  // natural logarithm of the likelihood ratio (e-value) of the held-out rows: model
                        // with the step against model without the step
  double expected = 0;  // mean of the evidence if the step is true; its negative if the step is absent. The
                        // variance of the evidence is twice this mean.
  double least_of_file =
      0;  // smallest evidence of the held-out rows of one file; 0 if there is one file only
  /// Returns the required evidence (natural logarithm) for accepting the step. The required evidence is odds
  /// of 20 to 1. If 99 of 100 true effects with this `expected` reach only smaller odds, the smaller odds are
  /// required, but the step must not increase the error of the held-out rows. If a true effect does not reach
  /// odds of 20 to 1 in the mean, the held-out rows give little information: their error must not increase by
  /// more than an effect without influence increases it (kEvidenceOfNothing).
  double asked(const ProofThresholds& thresholds) const;
};

/// Evaluates the check rows with the model before and after one step. `before`, `after`: residuals (measured
/// - model) of all observations with the two models; `noise`: correlation of the errors of the readings.
/// `variance`: variance of the independent noise of a weighted reading. With u it is at least 1, and exceeds
/// 1 if the stated u is too small; without u it is in mm^2.
Proof proof_on_check_rows(const model::Measurement& rows, const Eigen::VectorXd& before,
                          const Eigen::VectorXd& after, const fit::NoiseModel& noise, double variance);

}  // namespace vernier::diagnose
