// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace vernier::tolerance {

/// Generator of normally distributed random numbers; for equal seeds the numbers are equal on every computer
/// (those of the standard library can differ). Method: Box and Muller 1958.
class Normals {
 public:
  explicit Normals(std::uint64_t seed) : engine_(seed) {}
  Eigen::MatrixXd draw(Eigen::Index rows, Eigen::Index columns);
  double uniform();  // uniform random number in (0, 1)
  double next();

 private:
  std::mt19937_64 engine_;
};

/// Returns random samples of the model's discrepancy at points (3 x N, mm): smooth random fields along x, y
/// and z with the standard deviations std_mm. A field is a sum of cosines; the logarithms of their
/// wavelengths are uniform between two bounds (mm). The probability that the wave vector of a cosine is along
/// an axis is one half. All points of a sample belong to the same field. The result of draw_discrepancy() has
/// 3 N rows (mm) and one column per sample. Method: random Fourier features, Rahimi and Recht 2007.
Eigen::MatrixXd draw_discrepancy(Normals& normals, const Eigen::Matrix3Xd& points,
                                 const Eigen::Vector3d& std_mm, double shortest_mm, double longest_mm,
                                 Eigen::Index draws);

/// Statistics of the values of one characteristic over several blocks of trials.
class TrialTally {
 public:
  /// Adds a block of trials; the function sorts the values of the block. limits: lower and upper limit of the
  /// values that conform.
  void take(std::vector<double>& block, const std::optional<std::array<double, 2>>& limits);

  std::size_t trials() const { return trials_; }
  double mean() const;
  double std() const;
  /// Returns the lower end of the interval that contains 95 % of a block, with equal numbers of trials below
  /// and above the interval; high() returns the upper end. Both ends of the interval are averages over the
  /// blocks.
  double low() const { return average(low_); }
  double high() const { return average(high_); }
  /// Returns the share of the trials whose value is within the limits.
  double conforming() const;
  /// Returns twice the standard deviation of the averaged interval ends, the larger of the lower and upper
  /// end (JCGM 101:2008, 7.9.4). The function doubt() needs at least two blocks of Monte Carlo trials.
  double doubt() const;

 private:
  static double average(const std::vector<double>& list);

  double sum_ = 0, squares_ = 0;
  std::vector<double> low_, high_;  // interval ends of each block
  std::size_t conforming_ = 0, trials_ = 0;
};

}  // namespace vernier::tolerance
