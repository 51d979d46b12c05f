// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

namespace vernier::timebase {

/// Returns `rows` rows of a series (rows x channels) from the row `first` on, after removal of mean and slope
/// of each channel. Mean and slope are removed because a drift between two passes is not a shift in time.
/// Returns nullopt if the rows exceed the series or if a cell is NaN.
std::optional<Eigen::MatrixXd> stretch(const Eigen::MatrixXd& series, Eigen::Index first, Eigen::Index rows);

/// Returns the concordance correlation of two blocks of equal size, from -1 to 1. The concordance correlation
/// is 1 only if the blocks are equal. The definition is that of Lin, Biometrics 45 (1989).
double concordance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Returns the effective number of independent rows if the rows of `a` and `b` are correlated (Bartlett).
/// The effective number of independent rows is conservative, because absolute products are used. An
/// oscillation of the samples therefore does not increase the effective number of rows.
double effective_rows(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Returns the probability that two unrelated blocks with `rows` independent rows have this correlation or a
/// larger one (Fisher's z).
double chance_of_agreement(double correlation, double rows);

/// Returns the probability that noise alone makes one rms larger than the other by this ratio (Fisher's z of
/// a ratio of variances).
double chance_of_ratio(double larger, double smaller, double rows);

}  // namespace vernier::timebase
