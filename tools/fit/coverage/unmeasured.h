// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/fit/coverage/readings_beside_set_up.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// A coefficient of the model: a static, a scale factor, or a column of a table.
struct Coefficient {
  std::string name;                     // name of the coefficient: `alpha`, `scalefactor.X`, `table.X.rY`
  std::vector<std::size_t> parameters;  // indices of the coefficient's parameters in a ParameterSet without
                                        // set-ups
};
std::vector<Coefficient> coefficients_of(const model::ParameterSet& parameters);

/// Returns the coefficients whose effect depends on an axis or input that did not vary, within the noise of
/// the readings, while the effect was visible. Example: the effect of heat was measured at only one position
/// of an axis. With poses at only one position of an axis, a rotation about a far point has the same effect
/// on the readings as a shift. For each coefficient and each variable, unvaried_dependences replaces the
/// effect by the effect with the variable at its mean (weighted by the square of the effect). The variable
/// counts as unvaried if this replacement explains the fit rows as well, with a free set-up. Both
/// explanations count as equally good if they differ by at most three standard deviations in all.
/// If a variable changed only together with a second variable, the replacement uses the regression
/// line between both variables. Example of two variables that change together: the effect of heat
/// was measured on a diagonal of X and Y. Three cases are excluded from the test for unvaried
/// variables. First excluded case: rows with readings of rotations, because such readings
/// distinguish a rotation from a shift. Second excluded case: a station table is not tested against
/// its own axis. Third excluded case: a single axis that never moved, because the rule
/// `measured-range` of the safety sheet reports it.
std::vector<model::FitRecord::Unvaried> unvaried_dependences(const ReadingsBesideSetUp& readings);

/// Returns the possible motions of the tool point by those properties of the model that no reading confirms,
/// at each state: 3 N x e elements, mm. Each column is the motion of the tool point by one standard
/// uncertainty of one property. The function considers two kinds of unconfirmed properties of the
/// model. First kind: a dependence on a variable that did not vary. The dependence on a variable
/// that did not vary may be as in the model, or absent. Second kind: an alternative term may be the
/// true term instead of the model's term (tools/fit/coverage/alternatives.h). The number e of
/// properties depends only on `bare` and `record`. `bare`: the fitted machine without its
/// BaseShifts; `parameters`: the parameters of `bare`.
Eigen::MatrixXd unmeasured_columns(const model::Machine& bare, const model::ParameterSet& parameters,
                                   const model::FitRecord& record, const model::States& states);

}  // namespace vernier::fit
