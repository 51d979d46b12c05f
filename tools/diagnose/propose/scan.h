// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tools/diagnose/propose/enumerate.h"
#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/projected.h"
#include "tools/maths/orthonormal.h"

namespace vernier::diagnose {

/// Effect of a candidate at its best scanned values on the residual, after the free parameters of the model
/// are fitted.
struct Scored {
  std::size_t candidate = 0;    // index into the list that was scanned
  std::vector<double> scanned;  // values of its scanned unknowns
  double gain = 0;              // decrease of chi^2
  double own_share = 0;         // smallest share of a column that the model cannot absorb
  Eigen::Index unknowns = 0;    // coefficients and scanned values
};

/// Scores of all candidates against a residual. `beside`: orthonormal columns of the effects already
/// accepted, in the orthogonal complement of the model's free parameters. The parts of candidates along these
/// columns do not count.
class Scanner {
 public:
  Scanner(const Evidence& evidence, const std::vector<ScannedCandidate>& candidates);

  /// Returns the best values on the grid for every candidate that is visible in the data, in the
  /// order of the list, from `first_candidate` on. `progress`: share done.
  std::vector<Scored> scan(const Eigen::MatrixXd& beside, const std::function<void(double)>& progress,
                           std::size_t first_candidate = 0);

  /// Searches periods shorter than those of the grid. For each candidate with such periods, returns the best
  /// period above the level of chance. Among periods that fit as well as the best, scan_fine returns the
  /// longest, which is the usual name of the family.
  std::vector<Scored> scan_fine(const Eigen::MatrixXd& beside, std::size_t first_candidate = 0);

  /// Moves the scanned values between the grid's neighbours to the largest gain.
  void refine(Scored& scored, const Eigen::MatrixXd& beside) const;

  /// For a candidate with one period, returns the other periods that fit as well as the period of the
  /// candidate, within chance. The positions of the axis do not distinguish these periods. Longest first,
  /// down to 1/1000 of the range; empty for other candidates.
  std::vector<double> aliases(const Scored& scored, const Eigen::MatrixXd& beside) const;

  /// Returns the independent columns of a scored candidate after projection. Columns that the model or
  /// earlier columns contain are dropped. `kept`: indices of the linear unknowns of the columns that remain.
  Eigen::MatrixXd projected(const Scored& scored, std::vector<std::size_t>* kept = nullptr) const;

  const std::vector<ScannedCandidate>& candidates() const { return candidates_; }

 private:
  class Part;
  /// Difference of chi^2 within which two periods fit equally well, if the remaining chi^2 with the cyclic
  /// error is `left`. If that exceeds the noise, it is the scale.
  double alike_within(double left) const;
  /// Best of a candidate's periods, by the full decrease of the residual.
  Scored best_period(std::size_t candidate, const std::vector<double>& periods, const Eigen::MatrixXd& beside,
                     const Eigen::VectorXd& residual) const;
  /// Returns the residual beside the columns `beside`, which candidates must explain.
  Eigen::VectorXd residual_beside(const Eigen::MatrixXd& beside) const;
  /// Returns the gain of a scored candidate at other scanned values; 0 if the readings do not depend on the
  /// candidate at these values.
  double gain_at(ColumnMaker& maker, const Scored& scored, const std::vector<double>& scanned,
                 const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) const;
  /// Returns frequencies at which a cyclic error may fit as well as one at `own`, up to `most`: from the
  /// spectral window of the positions, and, if the computing time permits, all peaks of the exact gain near
  /// `mine`.
  std::vector<double> possible_aliases(const Scored& scored, double own, double most, double mine,
                                       const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) const;
  /// Sets gain, share and unknowns of a candidate at a point of scanned values; false if the readings do not
  /// depend on the candidate at this point.
  bool score(const ProjectedPoint& point, const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual,
             Scored& scored) const;
  /// Returns the columns of a candidate at scanned values.
  ProjectedPoint projected_at(ColumnMaker& maker, std::size_t candidate,
                              const std::vector<double>& scanned) const;

  const Evidence& evidence_;
  const PoolThresholds& thresholds_;
  const std::vector<ScannedCandidate>& candidates_;
  ProjectedColumns kept_;
};

/// Returns every combination of the values of several lists.
std::vector<std::vector<double>> grid_points(const std::vector<std::vector<double>>& lists);

}  // namespace vernier::diagnose
