// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// The error as a function of one axis at one degree of freedom, estimated from the readings.
struct AxisFunction {
  double seen = 0;         // number of independent functions of the axis that the free parameters of the
                           // model do not explain
  double fast_share = 0;   // share of the decrease of chi^2 that half-waves shorter than `resolved` cause
  double resolved = 0;     // shortest half-wave that counts as smooth, unit of the axis
  double log_p = 0;        // logarithm of the probability that noise has such short half-waves
  bool own_table = false;  // true: the model has free parameters for functions of this axis (a table of its
                           // own)
};

/// The decrease of chi^2 that a set of columns causes.
struct Gain {
  double chi_square = 0;  // decrease of chi^2, in units of the noise that remains with the columns in the
                          // model
  double rank = 0;        // number of independent columns
};

/// Returns the decrease of chi^2 by the whitened columns `raw`. The model's free parameters and the whitened
/// columns `beside` are fitted too.
Gain gain_of(const Evidence& evidence, const Eigen::MatrixXd& raw, const Eigen::MatrixXd& beside);

/// Returns the decrease of the BIC by the whitened columns `raw`, beside `beside` as in gain_of(), each model
/// with its most likely noise, but never below a given u. `scanned`: number of unknowns that were searched
/// for the columns.
double bic_decrease(const Evidence& evidence, const Eigen::MatrixXd& raw, const Eigen::MatrixXd& beside,
                    std::size_t scanned);

/// Returns the decrease of the BIC by an accepted effect `item` of the pool, beside `beside`.
double bic_decrease_by(const Evidence& evidence, const Pool& pool, std::size_t item,
                       const Eigen::MatrixXd& beside);

/// Estimates the error as a function of one axis. function_of_axis uses the readings, not the form that the
/// search selected. The test compares half-waves down to an eighth of the measured range with half-waves of
/// half this length. With fewer than 17 positions the half-waves are longer, with two positions for each
/// half-wave. `beside`: columns of other effects, after projection on the orthogonal complement of the
/// model's free parameters.
AxisFunction function_of_axis(const Evidence& evidence, std::size_t axis, const effects::DofPlace& place,
                              const Eigen::MatrixXd& beside);

/// Returns the natural logarithm of a p-value: the probability that noise alone makes an accepted term appear
/// to change along the axes. The test adds two products to the model with all accepted effects: the term
/// times the position of every axis, and times the square of the position. For a curve of one axis, a change
/// along this axis is not tested.
double log_p_of_change(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                       std::size_t item);

/// Returns one sentence with the reason why an accepted effect cannot be what its name states; empty if there
/// is no reason for doubt. A curve of an axis must be smooth at the distance of its stations. The readings
/// must show more independent functions of the axis than the curve has coefficients. If the standard
/// uncertainty u is given, a term must not change along the axes in ways that its form does not contain.
std::string doubt_of_shape(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t item);

/// Returns true if an effect of the catalogue stays a cause whatever the doubtful effects really are: it
/// depends on the motion (approach direction, speed, acceleration, travel since a reversal), on nothing else,
/// and no doubtful effect depends on the same quantity. An input, the time or a run is not sufficient: it can
/// follow an error without a name by chance.
bool stands_beside(const Evidence& evidence, const Pool& pool, std::size_t item,
                   const std::vector<std::size_t>& doubtful);

}  // namespace vernier::diagnose
