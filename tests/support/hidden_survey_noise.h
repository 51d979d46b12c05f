// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tests/support/hidden_survey.h"
#include "tests/support/hidden_survey_draw.h"
#include "tests/support/hidden_survey_motion.h"
#include "tools/model/measurement.h"

namespace vernier::support {

const char* noise_law_name(NoiseLaw law);
/// Throws std::invalid_argument.
NoiseLaw noise_law_named(const std::string& name);

/// Standard deviation of a reading under a law, outliers and what hangs together included, in units of u.
double whole_noise(NoiseLaw law);

/// Size of the parts of the laws, in units of u.
inline constexpr double kQuantum = 2;            // step of the display; the rest of u is white
inline constexpr double kOutlierShare = 0.03;    // of the rows
inline constexpr double kAutoregression = 0.95;  // from row to row
inline constexpr double kDisturbance = 2;        // of the instrument: rms of a drift, height of a step

/// Every pose read three times in a row, within 2 um: rows are taken in threes, of which the first one
/// stands.
void repeat_poses(std::vector<MotionRow>& rows, Draw& draw);

/// The errors of the readings in units of their u. `white`: one normal number a reading, which every law
/// starts from; `wild`: rows with an outlier.
Eigen::VectorXd noise_of(NoiseLaw law, const model::Measurement& readings, Eigen::VectorXd white, Draw& draw,
                         std::vector<std::size_t>& wild);

/// u of each row over that of the survey, rms 1, where it grows with the distance of points (3 x rows, mm)
/// from an instrument in the corner; 0.4 to 2 times before that.
std::vector<double> growing_u(const Eigen::Matrix3Xd& points);

}  // namespace vernier::support
