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
  std::string sentence;  // sentence for the report, with the line numbers of the readings
  bool is_step = false;  // true: the rows follow each other, so that the cause is a step and not outliers
                         // (WithoutOutliers::step)
};

/// Tests whether outliers are the cause of the residual: a few readings that are far from all others (a lost
/// beam, a bumped target). The machine is fitted again without the rows of the outliers. The residual of this
/// fit must be noise. Returns nullopt if outliers are not the cause, or if the rows have no uncertainty that
/// defines the noise. `of_all`: residual of the fit to all rows, mm or deg.
std::optional<OutliersToBlame> outliers_to_blame(const model::Machine& machine,
                                                 const model::Measurement& measurement,
                                                 const Eigen::VectorXd& of_all,
                                                 const VerdictThresholds& thresholds);

/// The rows of a measurement without gross outliers, and the sentence that lists the excluded rows.
struct WithoutOutliers {
  std::vector<std::size_t> kept;
  std::string sentence;
  /// A sentence that names the line of a step. The sentence is not empty if the excluded rows follow each
  /// other in the file more often than chance explains. Excluded rows that follow each other are a step of
  /// the instrument, not outliers.
  std::string step;
};

/// Returns the natural logarithm of a probability (number of runs, Wald and Wolfowitz 1940). If `out` of
/// `all` rows are excluded at random, they form at most `groups` groups of successive rows with this
/// probability. Condition: 0 < out < all.
double log_p_of_groups(std::size_t all, std::size_t out, std::size_t groups);

/// Excludes the rows with a gross outlier: a reading far from the model with the effects found so far. The
/// excluded rows are at most a given share of all rows (VerdictThresholds::most_outliers). Returns nullopt
/// if there are no gross outliers, or if their share of the rows is too large. `machine`, `of_all`: the model
/// with the effects found so far, and its residual.
std::optional<WithoutOutliers> without_gross_outliers(const model::Machine& machine,
                                                      const model::Measurement& measurement,
                                                      const Eigen::VectorXd& of_all,
                                                      const VerdictThresholds& thresholds);

/// True if a second model increases the sum of squares of the weighted residual of the check rows. A residual
/// beyond the limit of an outlier counts as a residual at this limit, so that true outliers hardly change the
/// result. Each model has its rows and its residual, mm or deg.
bool is_worse_on_check_rows(const model::Measurement& rows_before, const Eigen::VectorXd& before,
                            const model::Measurement& rows_after, const Eigen::VectorXd& after,
                            const VerdictThresholds& thresholds);

}  // namespace vernier::diagnose
