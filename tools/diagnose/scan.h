// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tools/diagnose/enumerate.h"
#include "tools/diagnose/evidence.h"
#include "tools/maths/orthonormal.h"

namespace vernier::diagnose {

/// What a candidate at its best scanned values does to the residual, after the model's own free parameters
/// have had their chance.
struct Scored {
  std::size_t candidate = 0;    // index into the list that was scanned
  std::vector<double> scanned;  // values of its scanned unknowns
  double gain = 0;              // fall of chi^2
  double own_share = 0;         // least share of a column that the model cannot absorb
  Eigen::Index unknowns = 0;    // coefficients and scanned values
};

/// Scores of all candidates against a residual. `beside`: orthonormal columns (in the complement of what the
/// model absorbs) of effects already accepted; the candidates' parts along them do not count.
class Scanner {
 public:
  Scanner(const Evidence& evidence, const std::vector<ScannedCandidate>& candidates);

  /// Best values on the grid for every candidate that the data can see at all; in the order of the list,
  /// from `first_candidate` on.
  /// `progress`: share done.
  std::vector<Scored> scan(const Eigen::MatrixXd& beside, const std::function<void(double)>& progress,
                           std::size_t first_candidate = 0);

  /// Waves below the periods of the grid: of each candidate that has them the best one that stands out of
  /// chance; of those that do as well the longest, by whose name a field engineer would call the family.
  std::vector<Scored> scan_fine(const Eigen::MatrixXd& beside, std::size_t first_candidate = 0) const;

  /// The scanned values moved between the grid's neighbours to where the gain is largest.
  void refine(Scored& scored, const Eigen::MatrixXd& beside) const;

  /// The other periods at which a candidate with one period does as well, but for what chance would do: the
  /// positions of its axis do not tell them apart. Longest first, down to 1/1000 of the range; empty for
  /// other candidates.
  std::vector<double> aliases(const Scored& scored, const Eigen::MatrixXd& beside) const;

  /// Independent columns of a scored candidate after projection; dropped are those that the model or the
  /// columns before them hold already. `kept`: which of the linear unknowns they are.
  Eigen::MatrixXd projected(const Scored& scored, std::vector<std::size_t>* kept = nullptr) const;

  const std::vector<ScannedCandidate>& candidates() const { return candidates_; }

 private:
  struct Point {
    std::size_t candidate;
    std::vector<double> scanned;
  };
  void scan_part(std::size_t first, std::size_t step, const Eigen::MatrixXd& beside,
                 const Eigen::VectorXd& residual, std::vector<Scored>& best,
                 const std::function<void(double)>& progress) const;
  /// Best of a candidate's periods, by what they explain in full.
  Scored best_period(std::size_t candidate, const std::vector<double>& periods, const Eigen::MatrixXd& beside,
                     const Eigen::VectorXd& residual) const;
  /// What candidates have to explain beside those columns.
  Eigen::VectorXd residual_beside(const Eigen::MatrixXd& beside) const;
  /// Gain of a scored candidate at other scanned values; 0 where the data cannot see it there.
  double gain_at(ColumnMaker& maker, const Scored& scored, const std::vector<double>& scanned,
                 const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) const;
  bool score(const Eigen::MatrixXd& raw, const Eigen::MatrixXd& projected, const Eigen::MatrixXd& beside,
             const Eigen::VectorXd& residual, Scored& scored) const;

  const Evidence& evidence_;
  const PoolThresholds& thresholds_;
  const std::vector<ScannedCandidate>& candidates_;
};

/// Every combination of the values of several lists.
std::vector<std::vector<double>> grid_points(const std::vector<std::vector<double>>& lists);

}  // namespace vernier::diagnose
