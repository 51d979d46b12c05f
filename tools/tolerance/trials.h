// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace vernier::tolerance {

/// Normal numbers that are the same everywhere for a seed (the library's distributions are not). Box and
/// Muller 1958.
class Normals {
 public:
  explicit Normals(std::uint64_t seed) : engine_(seed) {}
  Eigen::MatrixXd draw(Eigen::Index rows, Eigen::Index columns);

 private:
  double uniform();
  double next();
  std::mt19937_64 engine_;
};

/// Blocks of trials of one value, summed up.
class TrialTally {
 public:
  /// A block; it is sorted. limits: of what conforms.
  void take(std::vector<double>& block, const std::optional<std::array<double, 2>>& limits);

  std::size_t trials() const { return trials_; }
  double mean() const;
  double std() const;
  /// Ends of the interval that holds 95 % of a block, as many below as above: averages over the blocks.
  double low() const { return average(low_); }
  double high() const { return average(high_); }
  /// Of the trials, those within the limits.
  double conforming() const;
  /// Twice the standard deviation of the averages of both ends, the larger one (JCGM 101:2008, 7.9.4).
  /// Two blocks at least.
  double doubt() const;

 private:
  static double average(const std::vector<double>& list);

  double sum_ = 0, squares_ = 0;
  std::vector<double> low_, high_;  // of each block
  std::size_t conforming_ = 0, trials_ = 0;
};

}  // namespace vernier::tolerance
