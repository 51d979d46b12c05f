// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/evidence.h"
#include "tools/diagnose/pool.h"

namespace vernier::diagnose {

/// What the readings show of an error as a function of one axis at one degree of freedom.
struct AxisFunction {
  double seen = 0;         // independent functions of the axis that the model's own parameters leave
  double fast_share = 0;   // part of what they explain that needs half-waves shorter than `resolved`
  double resolved = 0;     // shortest half-wave that is called smooth, unit of the axis
  double log_p = 0;        // logarithm of the chance that noise looks so fast
  bool own_table = false;  // the model has free values of its own for such functions
};

/// From the readings, not from the form that was taken: half-waves down to an eighth of the range that was
/// read (longer ones where it has fewer than 17 positions: two for each) against half-waves of half that
/// length. `beside`: other effects, any columns after projection on the complement of what the model absorbs.
/// tool.
AxisFunction function_of_axis(const Evidence& evidence, std::size_t axis, const effects::DofPlace& place,
                              const Eigen::MatrixXd& beside);

/// Logarithm of the chance that an accepted term seems to change along the axes by noise alone: the term
/// times the position of every axis, and times its square, beside all that is accepted. A curve of one axis
/// may change along that axis. tool.
double log_p_of_change(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                       std::size_t item);

/// Why an accepted effect cannot be read as what its name says, in a sentence; empty where it can. A curve of
/// an axis must be smooth at the spacing of its stations, and the readings must show more functions of the
/// axis than the curve has coefficients; where the uncertainty is given, a term must not change along the
/// axes beyond what it says. tool.
std::string doubt_of_shape(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t item);

}  // namespace vernier::diagnose
