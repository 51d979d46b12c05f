// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/model/measurement.h"

namespace vernier::results {

/// A limit for residuals: "2u" (a multiple of the u of each row), "0.2mm", "25um", "0.025deg" (readings of
/// orientation). "rms=1.5u" tests the rms of the residuals; without rms= each row is tested.
struct ResidualLimit {
  std::string words;
  bool rms = false, of_u = false, rotation = false;
  double value = 0;  // mm, deg, or times u
};

/// Throws InputError for words of another form.
ResidualLimit residual_limit(const std::string& words);

/// Tests the residuals against the limit: {limit, of (largest or rms), role (check rows if the file has any),
/// rows, beyond, worst: {file, line, value, limit} in um or mdeg as `unit` states, pass}. For a row with x y
/// z, the distance in space counts (for a rotation likewise); each other reading is tested alone. residual:
/// mm or deg, one per observation. Throws InputError if the file has no reading of the limited kind, or if a
/// limit in u meets a reading without a standard uncertainty.
nlohmann::ordered_json judge_residuals(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                                       const ResidualLimit& limit);

}  // namespace vernier::results
