// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/diagnose/propose/thresholds.h"
#include "tools/diagnose/types.h"
#include "tools/fit/noise/noise.h"
#include "tools/fit/types.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// Evidence of held-out rows for one step of the stepwise model. A step adds one effect to the model.
struct Proof {
  double evidence = 0;  // natural logarithm of the likelihood ratio (e-value) of the held-out rows: model
                        // with the step against model without the step
  double expected = 0;  // mean of the evidence if the step is true; its negative if the step is absent. The
                        // variance of the evidence is twice this mean.
  /// The held-out rows of one file.
  struct OfFile {
    std::size_t file = 0;  // its index in the measurement
    double evidence = 0, expected = 0;
  };
  std::vector<OfFile> files{};  // empty if the held-out rows are of one file
  /// Returns the required evidence (natural logarithm) for accepting the step. The required evidence is odds
  /// of 20 to 1. If 99 of 100 true effects with this `expected` reach only smaller odds, the smaller odds are
  /// required, but the step must not increase the error of the held-out rows. If a true effect does not reach
  /// odds of 20 to 1 in the mean, the held-out rows give little information: their error must not increase by
  /// more than an effect without influence increases it (kEvidenceOfNothing).
  double asked(const ProofThresholds& thresholds) const;
};

/// Returns the file whose held-out rows contradict the step: their evidence against it is very strong, and
/// less than one true step in a hundred has such an evidence. nullopt: no file contradicts the step.
/// `before`, `after`: fits without and with the step; `rows`: bound to the machine of `after`; `term`: what
/// the term of the effect contributes to the prediction of each reading, mm or deg. A file whose held-out
/// rows the term hardly changes (a tracker whose rows state no approach direction, for a backlash) does not
/// contradict the step: its residual changes only because the fit distributes other errors differently.
/// `noise`, `variance`: as for proof_on_check_rows().
std::optional<Proof::OfFile> contradicting_file(const Proof& proof, const ProofThresholds& thresholds,
                                                const model::Measurement& rows, const fit::FitResult& before,
                                                const fit::FitResult& after, const Eigen::VectorXd& term,
                                                const fit::NoiseModel& noise, double variance);

/// Evaluates the check rows with the model before and after one step. `before`, `after`: residuals (measured
/// - model) of all observations with the two models; `noise`: correlation of the errors of the readings.
/// `variance`: variance of the independent noise of a weighted reading. With u it is at least 1, and exceeds
/// 1 if the stated u is too small; without u it is in mm^2.
Proof proof_on_check_rows(const model::Measurement& rows, const Eigen::VectorXd& before,
                          const Eigen::VectorXd& after, const fit::NoiseModel& noise, double variance);

/// Returns the rms of residual / u over the check rows of each file. Empty if fewer than two files have check
/// rows, or if a check row has no u. `residual`: of all observations of `rows`, mm or deg.
std::vector<CheckOfFile> checks_of_files(const model::Measurement& rows, const Eigen::VectorXd& residual);

}  // namespace vernier::diagnose
