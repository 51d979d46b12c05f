// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/fit/readings_beside_set_up.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// What one number stands for in a model's claim: a static, a scale factor, a column of a table.
struct Coefficient {
  std::string name;                     // `alpha`, `scalefactor.X`, `table.X.rY`
  std::vector<std::size_t> parameters;  // of a ParameterSet without set-ups
};
std::vector<Coefficient> coefficients_of(const model::ParameterSet& parameters);

/// The coefficients whose effect depends on an axis or input that did not vary where the effect was seen, to
/// within the noise of the readings. Heat that was measured at one place of an axis is the example: a
/// rotation about a far point and a shift are the same there. For each coefficient and variable the effect
/// with the variable held at its mean there (weighted by the effect's square) takes the place of the effect
/// itself; it counts as unvaried where that explains the fit rows as well, to within three standard
/// deviations in all, beside a free set-up. A variable that changed only together with another one is held on
/// the line along which it did (weighted regression): heat that was measured on a diagonal of X and Y. Rows that read rotations distinguish a rotation from a shift, a
/// station table is not asked about its own axis, and a single axis that never moved is the sheet's rule
/// `measured-range`. tool.
std::vector<model::FitRecord::Unvaried> unvaried_dependences(const ReadingsBesideSetUp& readings);

/// Claims that no reading supports, as what they may move the tool point by at each state, one standard
/// uncertainty: 3 N x e, mm. An unvaried dependence may be as the model says or not be there; an alternative
/// term may be the true one (tools/fit/alternatives.h). e depends on machine and record alone. bare: without
/// BaseShifts, fitted; parameters: its own. tool.
Eigen::MatrixXd unmeasured_columns(const model::Machine& bare, const model::ParameterSet& parameters,
                                   const model::FitRecord& record, const model::States& states);

}  // namespace vernier::fit
