// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tests/support/hidden_survey_columns.h"
#include "tests/support/hidden_survey_inputs.h"

namespace vernier::support {

/// What alternatives are judged on.
struct AlternativeTest {
  const Geometry& geometry;
  const std::vector<LoggedColumn>& columns;
  const std::vector<std::string>& runs;
  const FormColumns& form_columns;
  Eigen::VectorXd residual;      // projected, weighted
  Eigen::VectorXd truth;         // the effect itself, projected
  double truth_chi_square = 0;   // of the fit with the true form
  Eigen::Index truth_width = 1;  // independent columns and free numbers of the true form
  std::vector<std::string> inputs;
  bool by_speed = false;  // the true form
};

/// Does feed or velocity drive it? At one feed it may look like a form that they do not drive: another cause.
bool is_by_speed(const Form& form);

/// chi^2 that is left when these projected columns are fitted too.
double chi_square_with(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual);

/// Every other form of every effect against the truth, best first, one per cause. A form whose columns hold
/// the truth's, without more coefficients, with the same inputs and both driven by speed or neither, is
/// the same effect under another name: added to `accept`. One with more coefficients only says the same more
/// loosely and is no alternative.
std::vector<Alternative> find_alternatives(const AlternativeTest& court, std::vector<Cause>& accept,
                                           Draw& draw);

/// Is the cause one of these? Empty axis and input of `accept` match any.
bool is_accepted(const std::vector<Cause>& accept, const Cause& cause);

}  // namespace vernier::support
