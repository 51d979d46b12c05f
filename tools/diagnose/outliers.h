// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/propose/thresholds.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// Tests whether the instrument is the cause: a few readings are far from all others (a lost beam, a bumped
/// target). The machine is fitted again without the rows of these readings, and the residual must then be
/// noise. Returns a sentence with the line numbers of these readings. Returns nullopt if outliers are not the
/// cause, or if no uncertainty defines the noise. `of_all`: residual of the machine's fit to all rows, mm or
/// deg.
std::optional<std::string> outliers_to_blame(const model::Machine& machine,
                                             const model::Measurement& measurement,
                                             const Eigen::VectorXd& of_all,
                                             const VerdictThresholds& thresholds);

/// The rows without the gross outliers, and the sentence that lists the excluded rows.
struct WithoutOutliers {
  std::vector<std::size_t> kept;
  std::string sentence;
};

/// Excludes the rows with a reading far from the model with the effects found so far. At most a share of the
/// rows is excluded. Returns nullopt if there are no such rows, or more rows than this share. `machine`,
/// `of_all`: with the effects found so far.
std::optional<WithoutOutliers> without_gross_outliers(const model::Machine& machine,
                                                      const model::Measurement& measurement,
                                                      const Eigen::VectorXd& of_all,
                                                      const VerdictThresholds& thresholds);

}  // namespace vernier::diagnose
