// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace vernier::support {

/// The term-discovery benchmark: a reading per row, y = g + c * (T - 20) * x + noise, where g is smooth
/// geometry of 3.3 um rms, the noise 1 um and T one of twelve logged inputs, two of which are confounded with
/// it. A clean find names (T - 20) * x and nothing else.
struct TermDiscovery {
  Eigen::Matrix3Xd position;             // mm: x 0..600, y 0..400, z -300..0
  std::vector<std::string> input_names;  // twelve: T, its two confounders, nine that mean nothing
  Eigen::MatrixXd inputs;                // rows x 12; temperatures in degC
  /// What the geometry is made of: piecewise linear functions of x, of y and of z over five stations each.
  Eigen::MatrixXd geometry_basis;
  Eigen::VectorXd geometry_um, reading_um;
  double coefficient = 0;  // c, um / (mm K)
  /// Cramer-Rao bound of c where the geometry and the reference temperature are unknown: um / (mm K).
  double bound = 0;
};

/// sigmas: c over its bound (the 33, 12 and 5). The same for the same seed.
TermDiscovery make_term_discovery(std::uint64_t seed, double sigmas, Eigen::Index rows = 2000);

/// The same as files of FORMATS: a machine whose tables hold the geometry, a survey that reads x.
struct TermDiscoveryFiles {
  std::string model, csv;
};
TermDiscoveryFiles term_discovery_files(const TermDiscovery& data);

}  // namespace vernier::support
