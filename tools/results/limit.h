// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/model/measurement.h"

namespace vernier::results {

/// A limit for residuals: "2u" (a multiple of the standard uncertainty u of each row), "0.2mm", "25um",
/// "0.025deg" (for readings of orientation). The limit "rms=1.5u" is for the rms of the residuals. A limit
/// without "rms=" applies to the residual of each row.
struct ResidualLimit {
  std::string words;
  bool rms = false, of_u = false, rotation = false;
  double value = 0;  // in mm, in deg, or as a multiple of u
};

/// Converts a text to a limit. Throws InputError if the text has another form.
ResidualLimit residual_limit(const std::string& words);

/// Tests the residuals against a limit: {limit, of (largest or rms), role (check rows if the file has any),
/// rows, beyond, worst: {file, line, value, limit} in um or mdeg as `unit` states, pass}. For a row with x y
/// z, the distance in space is tested (for a rotation, the angle). Each reading other than x y z and
/// rotations is tested separately against the limit. `residual`: one value per observation, mm or deg.
/// Throws InputError if the file has no reading of the kind in the limit, or if the limit is in u and a
/// reading has no standard uncertainty.
nlohmann::ordered_json judge_residuals(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                                       const ResidualLimit& limit);

}  // namespace vernier::results
