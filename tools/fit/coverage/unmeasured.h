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

/// A number that the model contains as one coefficient: a static, a scale factor, a column of a
/// table.
struct Coefficient {
  std::string name;                     // `alpha`, `scalefactor.X`, `table.X.rY`
  std::vector<std::size_t> parameters;  // of a ParameterSet without set-ups
};
std::vector<Coefficient> coefficients_of(const model::ParameterSet& parameters);

/// Returns the coefficients whose effect depends on an axis or input that did not vary while the
/// effect was visible, to within the noise of the readings. An example is heat that was measured
/// at one position of an axis: a rotation about a far point and a shift are the same there. For
/// each coefficient and variable, the effect is replaced by the effect with the variable held at
/// its mean (weighted by the effect's square). The variable counts as unvaried if this replacement
/// explains the fit rows as well, to within three standard deviations in all, beside a free
/// set-up. If a variable changed only together with another one, it is held on the line of that
/// dependence (weighted regression). An example is heat that was measured on a diagonal of X and
/// Y. Three cases are excluded. Rows that read rotations distinguish a rotation from a shift. A
/// station table is not tested against its own axis. A single axis that never moved belongs to the
/// sheet's rule `measured-range`. tool.
std::vector<model::FitRecord::Unvaried> unvaried_dependences(const ReadingsBesideSetUp& readings);

/// Returns the claims that no reading supports, as possible motions of the tool point at each
/// state, one standard uncertainty: 3 N x e, mm. An unvaried dependence may be as in the model or
/// absent. An alternative term may be the true one (tools/fit/coverage/alternatives.h). e depends only on
/// machine and record. bare: without BaseShifts, fitted; parameters: its own. tool.
Eigen::MatrixXd unmeasured_columns(const model::Machine& bare, const model::ParameterSet& parameters,
                                   const model::FitRecord& record, const model::States& states);

}  // namespace vernier::fit
