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

/// A number of the model that is one coefficient: a static, a scale factor, a column of a table.
struct Coefficient {
  std::string name;                     // `alpha`, `scalefactor.X`, `table.X.rY`
  std::vector<std::size_t> parameters;  // of a ParameterSet without set-ups
};
std::vector<Coefficient> coefficients_of(const model::ParameterSet& parameters);

/// Returns the coefficients whose effect depends on an axis or input that did not vary while the effect was
/// visible, to within the noise of the readings. Example: heat that was measured at one position of an axis.
/// In the measured poses a rotation about a far point has the same effect as a shift. For each coefficient
/// and variable, the function replaces the effect by the effect with the variable at its mean (weighted by
/// the effect's square). The variable counts as unvaried if this replacement, beside a free set-up, explains
/// the fit rows as well, to within three standard deviations in all. If a variable changed only together with
/// another variable, the replacement uses the line of this dependence (weighted regression). An example is
/// heat that was measured on a diagonal of X and Y. Three cases are excluded. First: rows that read
/// rotations, because they distinguish a rotation from a shift. Second: a station table is not tested against
/// its own axis. Third: a single axis that never moved; the rule `measured-range` of the safety sheet reports
/// it.
std::vector<model::FitRecord::Unvaried> unvaried_dependences(const ReadingsBesideSetUp& readings);

/// Returns those properties of the model that no reading confirms, as possible motions of the tool point at
/// each state, one standard uncertainty: 3 N x e, mm. There are two kinds of properties. An unvaried
/// dependence may be as in the model or absent. An alternative term may be the true term in place of the
/// model's term (tools/fit/coverage/alternatives.h). e is the number of properties; it depends only on `bare`
/// and `record`. bare: the fitted machine without its BaseShifts; parameters: the parameters of `bare`.
Eigen::MatrixXd unmeasured_columns(const model::Machine& bare, const model::ParameterSet& parameters,
                                   const model::FitRecord& record, const model::States& states);

}  // namespace vernier::fit
