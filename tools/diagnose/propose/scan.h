// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tools/diagnose/propose/by_rows.h"
#include "tools/diagnose/propose/enumerate.h"
#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/families.h"
#include "tools/diagnose/propose/projected.h"
#include "tools/maths/orthonormal.h"

namespace vernier::diagnose {

/// Effect of a candidate on the residual, with its scanned unknowns at their best values and the free
/// parameters of the model fitted.
struct Scored {
  std::size_t candidate = 0;    // index of the candidate in the scanned list
  std::vector<double> scanned;  // values of the candidate's scanned unknowns
  double gain = 0;              // decrease of chi^2
  double own_share = 0;         // smallest fraction of a column of the candidate that the free parameters of
                                // the model do not explain
  Eigen::Index unknowns = 0;    // number of coefficients and scanned values
};

/// Columns of the accepted effects that are independent of each other, and an orthonormal basis of their
/// span. The columns are in the orthogonal complement of the model's free parameters.
struct AcceptedColumns {
  explicit AcceptedColumns(const Eigen::MatrixXd& all);
  Eigen::MatrixXd columns, basis;
};

/// Part of the residual that a scan must explain: the residual after a fit of the accepted effects.
struct ScanTarget {
  Eigen::MatrixXd directions;  // orthonormal columns of the accepted effects, and the residual as last column
  Eigen::VectorXd residual;
};

/// Computes the scores of all candidates for a residual. `beside`: orthonormal columns of the accepted
/// effects, in the orthogonal complement of the model's free parameters. The part of a candidate along the
/// columns `beside` does not count.
class Scanner {
 public:
  Scanner(const Evidence& evidence, const std::vector<ScannedCandidate>& candidates);

  /// Returns the best values on the grid for every candidate that is visible in the data. The order is that
  /// of the list, beginning at `first_candidate`. The part of a candidate in the span of `accepted` does not
  /// count. `progress`: receives the completed fraction of the scan (0 to 1).
  std::vector<Scored> scan(const AcceptedColumns& accepted, const std::function<void(double)>& progress,
                           std::size_t first_candidate = 0);

  /// Searches periods of cyclic errors that are shorter than the periods of the grid. Returns the best short
  /// period for each candidate that has one above the level of chance. If several periods fit equally well,
  /// scan_fine returns the longest period, which is the usual one to report.
  std::vector<Scored> scan_fine(const Eigen::MatrixXd& beside, std::size_t first_candidate = 0);

  /// Refines the scanned values between neighbouring grid values, up to the largest decrease of chi^2.
  void refine(Scored& scored, const Eigen::MatrixXd& beside) const;

  /// Returns, for a candidate with one period, the other periods that fit equally well within chance. The
  /// positions of the axis do not distinguish alias periods. The alias periods are sorted, longest first,
  /// down to 1/1000 of the range. The result of aliases() is empty for a candidate without a single period.
  std::vector<double> aliases(const Scored& scored, const Eigen::MatrixXd& beside) const;

  /// Returns the independent columns of a scored candidate, after projection on the complement of the model's
  /// free parameters. A column that the model or earlier columns of the candidate contain is removed. `kept`:
  /// receives the indices of the linear unknowns whose columns remain.
  Eigen::MatrixXd projected(const Scored& scored, std::vector<std::size_t>* kept = nullptr) const;

  const std::vector<ScannedCandidate>& candidates() const { return candidates_; }

 private:
  class Part;
  struct Sources;
  /// Returns the sources of the directions of target(accepted.basis).
  Sources sources(const AcceptedColumns& accepted) const;
  /// True if the candidates are scored by the rows, without stored columns: the errors are independent, or
  /// the record is too long to store one column of each candidate.
  bool scans_by_rows() const;
  /// Prepares a scan of the candidates from `first_candidate` on beside the columns of `sources`. Returns the
  /// numbers of the stored products of these columns; empty if the scan is by rows.
  std::vector<std::size_t> prepare(const Sources& sources, std::size_t first_candidate);
  /// Returns the difference of chi^2 below which two periods fit equally well. `left`: chi^2 that remains
  /// with the cyclic error in the model. If `left` exceeds the noise, the difference is scaled by `left`.
  double alike_within(double left) const;
  /// Returns the score of a candidate with the best of the given periods, by the full decrease of the
  /// residual's chi^2.
  Scored best_period(std::size_t candidate, const std::vector<double>& periods,
                     const ScanTarget& target) const;
  /// Returns what a scan beside the accepted effects must explain.
  ScanTarget target(const Eigen::MatrixXd& beside) const;
  /// Returns the score of a candidate at the values `scanned`. `unknowns` is 0 if the readings do not depend
  /// on the candidate at these values.
  Scored score_at(ColumnMaker& maker, std::size_t candidate, const std::vector<double>& scanned,
                  const ScanTarget& target) const;
  /// Returns frequencies up to `most` at which a cyclic error may fit as well as at the frequency `own`. The
  /// alias frequencies come from the spectral window of the positions and, if the computing time permits,
  /// from all peaks of the exact decrease of chi^2 near `mine`.
  std::vector<double> possible_aliases(const Scored& scored, double own, double most, double mine,
                                       const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) const;
  /// Sets gain, share and number of unknowns of the grid point `at` of a batch. `products`: scalar products
  /// of the target's directions (rows) with the columns of the batch. Returns false if the readings do not
  /// depend on the candidate at this point.
  bool score(const ProjectedBatch& batch, std::size_t at, const Eigen::MatrixXd& products,
             Scored& scored) const;
  /// Returns the projected columns of a candidate at the values `scanned`, as a batch of one point.
  ProjectedBatch projected_at(ColumnMaker& maker, std::size_t candidate,
                              const std::vector<double>& scanned) const;

  const Evidence& evidence_;
  const PoolThresholds& thresholds_;
  const std::vector<ScannedCandidate>& candidates_;
  ProjectedColumns kept_;
  Families families_;
  ByRows by_rows_;
};

}  // namespace vernier::diagnose
