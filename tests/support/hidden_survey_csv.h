// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tests/support/hidden_survey_inputs.h"
#include "tests/support/hidden_survey_motion.h"

namespace vernier::support {

/// A measurement file without its readings.
struct SurveyTable {
  const Geometry& geometry;
  const MotionOptions& options;
  const std::vector<MotionRow>& rows;
  const std::vector<LoggedColumn>& columns;
  double u_mm;
  bool with_u = true;
  std::vector<double> growing_u = {};  // of each row over u_mm; empty: 1
};

/// Where the nominal tool point is in each row, mm.
Eigen::Matrix3Xd nominal_points(const SurveyTable& table);

/// The file; `readings`: per row in the order of the header, mm. Empty: all 0. Of a `d` reading the nominal
/// point is where the nominal chain stands.
std::string survey_csv(const SurveyTable& table, const Eigen::VectorXd& readings);

}  // namespace vernier::support
