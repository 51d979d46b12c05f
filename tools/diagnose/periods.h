// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/evidence.h"
#include "tools/effects/candidate.h"

namespace vernier::diagnose {

/// Periods of an axis below those of the grid: too many to project every one. A wave so fast is nearly
/// orthogonal to what the model absorbs, so a periodogram shows where one may be.
struct FinePeriods {
  std::size_t axis = 0;
  double slowest = 0, fastest = 0;  // periods per unit of the axis; fastest 0: none to look for
  double step = 0;                  // from one frequency looked at to the next
  double length = 0;                // range of the axis that was read, in its unit
  Eigen::VectorXd carrier;          // what the sine and the cosine of the term are multiplied by, per reading

  bool any() const { return fastest > slowest; }
  bool holds(double period) const { return any() && period * slowest <= 1 && period * fastest >= 1; }
  /// How many frequencies the range read tells apart.
  double tries() const { return (fastest - slowest) * length; }
};

/// The shortest period of an axis that its positions tell from every longer one: 2.1 of their steps where
/// those are even, nearly so or multiples of one; 0 where the positions are uneven enough for all periods
/// down to 1/1000 of the range. In the axis' unit. tool.
double shortest_told_apart(const Evidence& evidence, std::size_t axis);

/// Frequencies, in periods per unit of an axis, by which two waves may differ and still be the same at all of
/// its positions, nearly: 1/s and its multiples where they stand s apart. Up to `most`. tool.
std::vector<double> alias_frequencies(const Evidence& evidence, std::size_t axis, double most);

/// What to look for at an axis below the shortest period of `grid` (increasing): down to 1/1000 of the range
/// that was read, to 2.5 periods for each position, and not below `shortest`, as above. `carrier` stays
/// empty. tool.
FinePeriods fine_periods(const Evidence& evidence, std::size_t axis, const std::vector<double>& grid,
                         double shortest);

/// The factor that two columns sin(2 pi q / p) and cos(2 pi q / p) of a candidate share at all readings, the
/// same for every period p; empty where the term is no such pair. Before poses are weighed. tool.
Eigen::VectorXd carrier_of(const Evidence& evidence, const effects::Candidate& candidate,
                           const FinePeriods& fine);

/// The most promising fine periods for each of several candidates of one axis, by the periodogram of a
/// residual that stands outside of what the model absorbs, those below the level of chance left out; refined.
/// The best of each, and the longest of those that do nearly as well (it may be their alias).
std::vector<std::vector<double>> promising_periods(const Evidence& evidence,
                                                   const std::vector<const FinePeriods*>& of_axis,
                                                   const Eigen::VectorXd& residual);

}  // namespace vernier::diagnose
