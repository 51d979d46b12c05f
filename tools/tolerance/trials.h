// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace vernier::tolerance {

/// Normal random numbers that are equal on every computer for a seed (those of the standard library are not).
/// Box and Muller 1958.
class Normals {
 public:
  explicit Normals(std::uint64_t seed) : engine_(seed) {}
  Eigen::MatrixXd draw(Eigen::Index rows, Eigen::Index columns);
  double uniform();  // in (0, 1)
  double next();

 private:
  std::mt19937_64 engine_;
};

/// Returns random samples of the discrepancy of a model at points (3 x N, mm): smooth random fields along
/// each direction, standard deviation std_mm (x, y, z). A field is a sum of cosines whose wavelengths are
/// even in logarithm between two bounds (mm), half of them along an axis. All points of a sample have the
/// same field. 3 N x samples, mm. Random Fourier features, Rahimi and Recht 2007.
Eigen::MatrixXd draw_discrepancy(Normals& normals, const Eigen::Matrix3Xd& points,
                                 const Eigen::Vector3d& std_mm, double shortest_mm, double longest_mm,
                                 Eigen::Index draws);

/// Statistics of blocks of trials of one value.
class TrialTally {
 public:
  /// Adds a block of trials; the block is sorted. limits: limits of the values that conform.
  void take(std::vector<double>& block, const std::optional<std::array<double, 2>>& limits);

  std::size_t trials() const { return trials_; }
  double mean() const;
  double std() const;
  /// Returns the lower end of the interval that contains 95 % of a block, as many below as above; high()
  /// returns the upper end. Both are averages over the blocks.
  double low() const { return average(low_); }
  double high() const { return average(high_); }
  /// Returns the share of the trials within the limits.
  double conforming() const;
  /// Returns twice the standard deviation of the average of an end of the interval, for the end with the
  /// larger value (JCGM 101:2008, 7.9.4). doubt() needs two blocks at least.
  double doubt() const;

 private:
  static double average(const std::vector<double>& list);

  double sum_ = 0, squares_ = 0;
  std::vector<double> low_, high_;  // of each block
  std::size_t conforming_ = 0, trials_ = 0;
};

}  // namespace vernier::tolerance
