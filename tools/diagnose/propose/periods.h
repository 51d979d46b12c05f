// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/projected.h"
#include "tools/effects/candidate.h"

namespace vernier::diagnose {

/// Periods of an axis that are shorter than the periods of the search grid. The number of short periods is
/// too large for a projection of each period. A cyclic error with a short period is nearly orthogonal to the
/// columns of the model's free parameters. Therefore a periodogram shows the possible short periods.
struct FinePeriods {
  std::size_t axis = 0;
  double slowest = 0, fastest = 0;  // search range of frequencies, periods per unit of the axis; fastest = 0:
                                    // no search
  double step = 0;                  // interval between the tested frequencies
  double length = 0;                // measured range of the axis, in its unit
  Eigen::VectorXd carrier;          // common factor of the sine and the cosine of the term, per reading
  /// Lowest frequency of the exact search; 0: `slowest`. The exact search repeats the frequencies of the
  /// grid: the grid refines only its best value, and with few positions the best value is often beside
  /// another peak.
  double from = 0;

  double begin() const { return from > 0 ? from : slowest; }
  bool any() const { return fastest > slowest; }
  bool holds(double period) const { return any() && period * slowest <= 1 && period * fastest >= 1; }
  /// Returns the number of frequencies that the measured range distinguishes.
  double tries() const { return (fastest - slowest) * length; }
};

/// Returns the shortest period of an axis that the positions of the axis distinguish from every longer
/// period. The shortest period is 2.1 steps if the positions of the axis are even, nearly even or multiples
/// of one step. The shortest period is 0 if the positions are so uneven that they distinguish all periods
/// down to 1/1000 of the range. The unit of the period is the unit of the axis.
double shortest_told_apart(const Evidence& evidence, std::size_t axis);

/// Returns alias frequencies of an axis: frequency differences at which two cyclic errors are nearly
/// identical at all positions of the axis. The unit of the frequency differences is periods per unit of the
/// axis. If the positions have the spacing s, the alias frequencies are 1/s and its multiples. Only alias
/// frequencies up to `most` are returned.
std::vector<double> alias_frequencies(const Evidence& evidence, std::size_t axis, double most);

/// Returns the search range of an axis for periods shorter than the shortest period of `grid` (increasing
/// values). The exact search begins at the longest period of `grid`. The search range ends at the longest of
/// three periods: 1/1000 of the measured range, the period with 80 periods for each position of the axis, and
/// `shortest` (shortest_told_apart). The member `carrier` of the result is empty.
FinePeriods fine_periods(const Evidence& evidence, std::size_t axis, const std::vector<double>& grid,
                         double shortest);

/// Returns the common factor (carrier) of the columns sin(2 pi q / p) and cos(2 pi q / p) of a candidate, for
/// each reading. The carrier is the same for every period p. The carrier is empty if the term of the
/// candidate is not a sine and cosine pair. Call carrier_of before the readings of common poses are weighted
/// (Evidence::weigh_poses).
Eigen::VectorXd carrier_of(const Evidence& evidence, const effects::Candidate& candidate,
                           const FinePeriods& fine);

/// A cyclic error sin(2 pi f q), cos(2 pi f q) of the positions q of an axis, times a carrier per reading.
struct WaveOfAxis {
  std::size_t axis = 0;
  Eigen::VectorXd carrier;  // factor for each reading
};

/// Returns the exact decrease of chi^2 by a cyclic error at each frequency first + k * step. The model's free
/// parameters and the orthonormal columns `beside` are fitted too. `residual`: residual after the fit of the
/// free parameters and `beside`. The decrease of chi^2 is 0 at a frequency whose cyclic error is not
/// independent of the free parameters and `beside`.
Eigen::VectorXd wave_gains(const Evidence& evidence, const WaveOfAxis& wave, double first, double step,
                           Eigen::Index count, const Eigen::MatrixXd& beside,
                           const Eigen::VectorXd& residual);

/// Returns the projected sine and cosine of a cyclic error at the frequencies first + k * step.
ProjectedWaves projected_waves(const Evidence& evidence, const WaveOfAxis& wave, double first, double step,
                               Eigen::Index count);

/// True if the computing time permits exact values of wave_gains at `count` frequencies. For a long record a
/// periodogram is used instead: there, cyclic errors are nearly orthogonal to the columns of the model's free
/// parameters.
bool is_affordable(const Evidence& evidence, Eigen::Index count, const Eigen::MatrixXd& beside);

/// Returns the most promising short periods, refined, for each of several candidates of one axis. The list
/// contains the best periods, and the longest period that fits nearly as well, because the best may be its
/// alias. promising_periods uses the exact decrease of chi^2 beside the columns `beside` if the computing
/// time permits; otherwise it uses the periodogram of `residual`. Periods whose decrease of chi^2 is likely
/// by chance are excluded. `kept`: store for the projected columns of the candidates with the indices
/// `candidates`; null stores nothing.
std::vector<std::vector<double>> promising_periods(const Evidence& evidence,
                                                   const std::vector<const FinePeriods*>& of_axis,
                                                   const Eigen::MatrixXd& beside,
                                                   const Eigen::VectorXd& residual,
                                                   ProjectedColumns* kept = nullptr,
                                                   const std::vector<std::size_t>& candidates = {});

}  // namespace vernier::diagnose
