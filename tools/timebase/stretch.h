// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

namespace vernier::timebase {

/// `rows` rows of a series (rows x channels) from `first`, mean and slope of each channel taken off: a drift
/// between two passes is no shift. Nothing beyond the series or where a cell is NaN. tool.
std::optional<Eigen::MatrixXd> stretch(const Eigen::MatrixXd& series, Eigen::Index first, Eigen::Index rows);

/// Concordance of two stretches of one size, -1..1; 1 only where they are equal. Source: Lin, Biometrics 45
/// (1989). tool.
double concordance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Rows that count as independent when a and b are correlated (Bartlett), cautiously: with absolute products,
/// so that an oscillation gains nothing. tool.
double effective_rows(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Chance that unrelated stretches of so many independent rows agree so well (Fisher's z). tool.
double chance_of_agreement(double correlation, double rows);

/// Chance that noise alone makes one rms so much larger than the other (Fisher's z of a ratio of variances).
/// tool.
double chance_of_ratio(double larger, double smaller, double rows);

/// Chance that a standard normal number exceeds z, and the z that it exceeds with chance p < 0.5. tool.
double upper_tail(double z);
double upper_quantile(double p);

}  // namespace vernier::timebase
