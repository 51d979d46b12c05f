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

/// Uses the readings, not the form that was selected. It compares half-waves down to an eighth of
/// the measured range (longer ones if it has fewer than 17 positions: two for each) with
/// half-waves of half that length. `beside`: other effects, any columns after projection on the
/// complement of what the model absorbs. tool.
AxisFunction function_of_axis(const Evidence& evidence, std::size_t axis, const effects::DofPlace& place,
                              const Eigen::MatrixXd& beside);

/// Logarithm of the probability that an accepted term seems to change along the axes by noise
/// alone. Tested are the term times the position of every axis, and times its square, beside all
/// accepted items. A curve of one axis may change along that axis. tool.
double log_p_of_change(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                       std::size_t item);

/// Returns why an accepted effect cannot be what its name states, in a sentence; empty if it can.
/// A curve of an axis must be smooth at the spacing of its stations. The readings must show more
/// functions of the axis than the curve has coefficients. If the uncertainty is given, a term must
/// not change along the axes beyond its form. tool.
std::string doubt_of_shape(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t item);

}  // namespace vernier::diagnose
