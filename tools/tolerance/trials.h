// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace vernier::tolerance {

/// Normal random numbers that are the same everywhere for a seed (the library's distributions are
/// not). Box and Muller 1958.
class Normals {
 public:
  explicit Normals(std::uint64_t seed) : engine_(seed) {}
  Eigen::MatrixXd draw(Eigen::Index rows, Eigen::Index columns);
  double uniform();  // in (0, 1)
  double next();

 private:
  std::mt19937_64 engine_;
};

/// Random samples of the discrepancy of a model at points (3 x N, mm): smooth random fields along
/// each direction, standard deviation std_mm (x, y, z). They are made of waves whose lengths are
/// evenly distributed in logarithm between two bounds (mm), half of them along an axis. All points
/// of a sample belong to the same field. 3 N x draws, mm. Random Fourier features, Rahimi and
/// Recht 2007.
Eigen::MatrixXd draw_discrepancy(Normals& normals, const Eigen::Matrix3Xd& points,
                                 const Eigen::Vector3d& std_mm, double shortest_mm, double longest_mm,
                                 Eigen::Index draws);

/// Sums over blocks of trials of one value.
class TrialTally {
 public:
  /// Adds a block. It is sorted. limits: of conformity.
  void take(std::vector<double>& block, const std::optional<std::array<double, 2>>& limits);

  std::size_t trials() const { return trials_; }
  double mean() const;
  double std() const;
  /// Ends of the interval that contains 95 % of a block, with equal shares below and above:
  /// averages over the blocks.
  double low() const { return average(low_); }
  double high() const { return average(high_); }
  /// Share of the trials within the limits.
  double conforming() const;
  /// Twice the standard deviation of the averages of both ends, the larger one (JCGM 101:2008,
  /// 7.9.4). At least two blocks are needed.
  double doubt() const;

 private:
  static double average(const std::vector<double>& list);

  double sum_ = 0, squares_ = 0;
  std::vector<double> low_, high_;  // of each block
  std::size_t conforming_ = 0, trials_ = 0;
};

}  // namespace vernier::tolerance
