// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/projected.h"
#include "tools/effects/candidate.h"

namespace vernier::diagnose {

/// Periods of an axis that are shorter than those of the grid; there are too many to project each period. A
/// cyclic error with so short a period is nearly orthogonal to the part that the model absorbs. A periodogram
/// therefore shows the possible short periods.
struct FinePeriods {
  std::size_t axis = 0;
  double slowest = 0, fastest = 0;  // frequencies, periods per unit of the axis; fastest 0: no search
  double step = 0;                  // interval of the tested frequencies
  double length = 0;                // measured range of the axis, in its unit
  Eigen::VectorXd carrier;          // common factor of the sine and the cosine of the term, per reading

  bool any() const { return fastest > slowest; }
  bool holds(double period) const { return any() && period * slowest <= 1 && period * fastest >= 1; }
  /// Returns the number of frequencies that the measured range distinguishes.
  double tries() const { return (fastest - slowest) * length; }
};

/// Returns the shortest period of an axis that the positions of the axis distinguish from every longer
/// period. The result is 2.1 steps if the positions are even, nearly even or multiples of one step. The
/// result is 0 if the positions are uneven enough for all periods down to 1/1000 of the range. The period is
/// in the unit of the axis.
double shortest_told_apart(const Evidence& evidence, std::size_t axis);

/// Returns the frequency differences at which two cyclic errors are nearly identical at all positions of an
/// axis. Unit: periods per unit of the axis. If the positions have the spacing s, these frequencies are 1/s
/// and its multiples. Frequencies up to `most` are returned.
std::vector<double> alias_frequencies(const Evidence& evidence, std::size_t axis, double most);

/// Returns the search range at an axis below the shortest period of `grid` (increasing). The search range
/// extends down to 1/1000 of the measured range, to 2.5 periods for each position, and not below `shortest`
/// (shortest_told_apart). `carrier` stays empty.
FinePeriods fine_periods(const Evidence& evidence, std::size_t axis, const std::vector<double>& grid,
                         double shortest);

/// Returns the common factor of the columns sin(2 pi q / p) and cos(2 pi q / p) of a candidate at all
/// readings. The factor is equal for every period p. Empty if the term is not such a pair. Call carrier_of
/// before poses are weighted.
Eigen::VectorXd carrier_of(const Evidence& evidence, const effects::Candidate& candidate,
                           const FinePeriods& fine);

/// A cyclic error sin(2 pi f q), cos(2 pi f q) of the positions q of an axis, times a carrier per reading.
struct WaveOfAxis {
  std::size_t axis = 0;
  Eigen::VectorXd carrier;  // of each reading
};

/// Returns the exact decrease of chi^2 by a wave at the frequencies first + k * step, beside the
/// part that the model absorbs and the orthonormal columns `beside`. `residual`: outside of both.
/// A gain is 0 where the wave is not independent of both.
Eigen::VectorXd wave_gains(const Evidence& evidence, const WaveOfAxis& wave, double first, double step,
                           Eigen::Index count, const Eigen::MatrixXd& beside,
                           const Eigen::VectorXd& residual);

/// Returns the sines and cosines of a wave at the frequencies first + k * step.
ProjectedWaves projected_waves(const Evidence& evidence, const WaveOfAxis& wave, double first, double step,
                               Eigen::Index count);

/// True if exact gains (wave_gains) at `count` frequencies are affordable. A long record uses a periodogram
/// instead: in a long record, cyclic errors are nearly orthogonal to the columns of the model's free
/// parameters.
bool is_affordable(const Evidence& evidence, Eigen::Index count, const Eigen::MatrixXd& beside);

/// Returns the most promising short periods for each of several candidates of one axis, refined:
/// the best ones, and the longest of those that fit nearly as well (the best may be its alias).
/// promising_periods uses the exact gain of each period beside the orthonormal columns `beside` if that is
/// affordable, else the periodogram of `residual`. Periods below the level of chance are excluded. `kept`:
/// renewed, for the indices `candidates` of the list; null keeps nothing.
std::vector<std::vector<double>> promising_periods(const Evidence& evidence,
                                                   const std::vector<const FinePeriods*>& of_axis,
                                                   const Eigen::MatrixXd& beside,
                                                   const Eigen::VectorXd& residual,
                                                   ProjectedColumns* kept = nullptr,
                                                   const std::vector<std::size_t>& candidates = {});

}  // namespace vernier::diagnose
