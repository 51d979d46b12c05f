// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/diagnose/thresholds.h"
#include "tools/fit/noise.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// What rows that no fit and no selection saw say of a step from one model to another.
struct Proof {
  double evidence = 0;  // natural logarithm of the likelihood ratio (an e-value): how much likelier the step
                        // makes these rows
  double expected = 0;  // what it would be on average if the step were true
  /// Is the step large enough on these rows for them to speak?
  bool can_tell(const ProofThresholds& thresholds) const { return expected >= thresholds.expected; }
  /// They speak for it.
  bool bears_out(const ProofThresholds& thresholds) const { return evidence >= thresholds.evidence; }
  /// They speak against it: less than what bears it out, and less than one true step in so many brings by
  /// chance. (Of a true step the evidence is normal with mean `expected` and twice that as variance.)
  bool speaks_against(const ProofThresholds& thresholds) const;
};

/// The check rows under two models. before, after: residuals (measured - model) of all observations; noise:
/// how the readings' errors hang together; variance: of a weighted reading's own part, where the stated u is
/// too small, at least 1 (with u); without u its square in mm. tool.
Proof proof_on_check_rows(const model::Measurement& rows, const Eigen::VectorXd& before,
                          const Eigen::VectorXd& after, const fit::NoiseModel& noise, double variance);

}  // namespace vernier::diagnose
