// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tools/diagnose/propose/enumerate.h"
#include "tools/diagnose/propose/evidence.h"
#include "tools/maths/orthonormal.h"

namespace vernier::diagnose {

/// Effect of a candidate at its best scanned values on the residual, after the model's own free
/// parameters are fitted.
struct Scored {
  std::size_t candidate = 0;    // index into the list that was scanned
  std::vector<double> scanned;  // values of its scanned unknowns
  double gain = 0;              // decrease of chi^2
  double own_share = 0;         // smallest share of a column that the model cannot absorb
  Eigen::Index unknowns = 0;    // coefficients and scanned values
};

/// Scores of all candidates against a residual. `beside`: orthonormal columns (in the complement
/// of what the model absorbs) of effects already accepted. The candidates' parts along them do not
/// count.
class Scanner {
 public:
  Scanner(const Evidence& evidence, const std::vector<ScannedCandidate>& candidates);

  /// Returns the best values on the grid for every candidate that is visible in the data, in the
  /// order of the list, from `first_candidate` on. `progress`: share done.
  std::vector<Scored> scan(const Eigen::MatrixXd& beside, const std::function<void(double)>& progress,
                           std::size_t first_candidate = 0);

  /// Searches periods below those of the grid. For each candidate with such periods, returns the
  /// best one above the level of chance. Of those that fit as well, it returns the longest, which
  /// is the usual name of the family.
  std::vector<Scored> scan_fine(const Eigen::MatrixXd& beside, std::size_t first_candidate = 0) const;

  /// Moves the scanned values between the grid's neighbours to the largest gain.
  void refine(Scored& scored, const Eigen::MatrixXd& beside) const;

  /// Returns the other periods that fit as well as that of a candidate with one period, within
  /// chance. The positions of its axis do not distinguish them. Longest first, down to 1/1000 of
  /// the range; empty for other candidates.
  std::vector<double> aliases(const Scored& scored, const Eigen::MatrixXd& beside) const;

  /// Independent columns of a scored candidate after projection. Columns that the model or earlier
  /// columns contain are dropped. `kept`: indices of their linear unknowns.
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
  /// Difference of chi^2 within which two periods fit alike, beside a wave that leaves a chi^2 of
  /// `left`. If that exceeds the noise, it is the scale.
  double alike_within(double left) const;
  /// Best of a candidate's periods, by the full decrease of the residual.
  Scored best_period(std::size_t candidate, const std::vector<double>& periods, const Eigen::MatrixXd& beside,
                     const Eigen::VectorXd& residual) const;
  /// The residual that candidates must explain beside those columns.
  Eigen::VectorXd residual_beside(const Eigen::MatrixXd& beside) const;
  /// Gain of a scored candidate at other scanned values; 0 if it is not visible in the data there.
  double gain_at(ColumnMaker& maker, const Scored& scored, const std::vector<double>& scanned,
                 const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) const;
  /// Returns frequencies at which a wave may fit as well as one at `own`, up to `most`: by the
  /// positions' own window, and, if affordable, all peaks of its exact gain near `mine`.
  std::vector<double> possible_aliases(const Scored& scored, double own, double most, double mine,
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
