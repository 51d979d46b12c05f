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

/// Readings that explain the whole residual.
struct OutliersToBlame {
  std::string sentence;  // with the line numbers
  bool is_step = false;  // the rows follow each other (WithoutOutliers::step): no outliers
};

/// Tests whether the instrument is the cause: a few readings are far from all others (a lost beam, a bumped
/// target). The machine is fitted again without the rows of these readings, and the residual must then be
/// noise. Returns nullopt if such readings are not the cause, or if no uncertainty defines the noise.
/// `of_all`: residual of the machine's fit to all rows, mm or deg.
std::optional<OutliersToBlame> outliers_to_blame(const model::Machine& machine,
                                                 const model::Measurement& measurement,
                                                 const Eigen::VectorXd& of_all,
                                                 const VerdictThresholds& thresholds);

/// The rows without the gross outliers, and the sentence that lists the excluded rows.
struct WithoutOutliers {
  std::vector<std::size_t> kept;
  std::string sentence;
  /// Not empty if the excluded rows follow each other in the file more often than chance explains. Such rows
  /// are no outliers: this sentence names the line of the step.
  std::string step;
};

/// Returns the natural logarithm of the probability that `out` of `all` rows, excluded by chance, form at
/// most `groups` groups of successive rows. 0 < out < all. Wald and Wolfowitz 1940, number of runs.
double log_p_of_groups(std::size_t all, std::size_t out, std::size_t groups);

/// Excludes the rows with a reading far from the model with the effects found so far. At most a share of the
/// rows is excluded. Returns nullopt if there are no such rows, or more rows than this share. `machine`,
/// `of_all`: with the effects found so far.
std::optional<WithoutOutliers> without_gross_outliers(const model::Machine& machine,
                                                      const model::Measurement& measurement,
                                                      const Eigen::VectorXd& of_all,
                                                      const VerdictThresholds& thresholds);

}  // namespace vernier::diagnose
