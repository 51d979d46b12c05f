// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/propose/enumerate.h"

namespace vernier::diagnose {

/// Returns the thermal response of each structure of the machine, as the residual shows it: a sum of
/// temperatures and first-order lags of temperatures, constant and by the position of the structure's axis,
/// at the degrees of freedom of one transform. Forward, backward and exchange steps on the extended BIC
/// select the summands (transfer functions of the thermometers, ISO/TR 16907; Horejs et al. 2012). `effects`:
/// the catalogue; no result without an effect of found terms. `beside`: orthonormal columns of effects that
/// the response does not have to explain.
std::vector<ScannedCandidate> enumerate_responses(const Evidence& evidence,
                                                  const std::vector<effects::Effect>& effects,
                                                  const Eigen::MatrixXd& beside);

/// True if an input of the choice is a temperature.
bool depends_on_temperature(const model::Machine& machine, const effects::Choice& choice);

}  // namespace vernier::diagnose
