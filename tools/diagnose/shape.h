// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// The error as a function of one axis at one degree of freedom, as the readings show it.
struct AxisFunction {
  double seen = 0;         // independent functions of the axis that the model's own parameters do not absorb
  double fast_share = 0;   // share of the explained part that needs half-waves shorter than `resolved`
  double resolved = 0;     // shortest half-wave that counts as smooth, unit of the axis
  double log_p = 0;        // logarithm of the probability that noise has such short half-waves
  bool own_table = false;  // the model has free values of its own for such functions
};

/// The part of the residual that columns explain.
struct Gain {
  double chi_square = 0;  // in units of the noise that remains beside them
  double rank = 0;        // number of independent columns
};

/// Returns the part of the residual that the whitened columns `raw` explain beside the model's free
/// parameters and the whitened columns `beside`.
Gain gain_of(const Evidence& evidence, const Eigen::MatrixXd& raw, const Eigen::MatrixXd& beside);

/// function_of_axis uses the readings, not the selected form. The test compares half-waves down to an eighth
/// of the measured range with half-waves of half that length. With fewer than 17 positions the half-waves are
/// longer: two positions for each half-wave. `beside`: columns of other effects, after projection on the
/// orthogonal complement of the model's free parameters.
AxisFunction function_of_axis(const Evidence& evidence, std::size_t axis, const effects::DofPlace& place,
                              const Eigen::MatrixXd& beside);

/// Returns the logarithm of the probability that noise alone makes an accepted term appear to change along
/// the axes. The test adds the term times the position of every axis, and times its square, beside all
/// accepted items. A curve of one axis may change along that axis.
double log_p_of_change(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                       std::size_t item);

/// Returns one sentence with the reason why an accepted effect cannot be what its name states; empty if there
/// is no doubt. A curve of an axis must be smooth at the spacing of its stations. The readings must show more
/// functions of the axis than the curve has coefficients. If the uncertainty is given, a term must not change
/// along the axes in ways that its form does not contain.
std::string doubt_of_shape(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t item);

}  // namespace vernier::diagnose
