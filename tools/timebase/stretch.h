// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

namespace vernier::timebase {

/// Returns `rows` rows of a series (rows x channels) from `first`, without mean and slope of each
/// channel. A drift between two passes is not a shift. Returns nullopt beyond the series or if a
/// cell is NaN.
std::optional<Eigen::MatrixXd> stretch(const Eigen::MatrixXd& series, Eigen::Index first, Eigen::Index rows);

/// Returns the concordance of two blocks of one size, -1..1; 1 only if the blocks are equal. Source: Lin,
/// Biometrics 45 (1989).
double concordance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Effective number of independent rows if a and b are correlated (Bartlett). The number is conservative: it
/// uses absolute products, so that an oscillation does not increase it.
double effective_rows(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Returns the probability that unrelated blocks with this number of independent rows agree so well (Fisher's
/// z).
double chance_of_agreement(double correlation, double rows);

/// Returns the probability that noise alone makes one rms so much larger than the other (Fisher's z of a
/// ratio of variances).
double chance_of_ratio(double larger, double smaller, double rows);

/// upper_tail: probability that a standard normal number exceeds z. The function after it: the z that a
/// standard normal number exceeds with probability p < 0.5.
double upper_tail(double z);
double upper_quantile(double p);

}  // namespace vernier::timebase
