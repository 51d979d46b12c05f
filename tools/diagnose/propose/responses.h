// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/propose/enumerate.h"

namespace vernier::diagnose {

/// Returns the thermal response of each structure of the machine, as the residual shows it: a sum of
/// temperatures and first-order lags of temperatures, constant and by the position of the structure's axis,
/// at the degrees of freedom of one transform. Forward, backward and exchange steps on the extended BIC
/// select the summands (thermal transfer functions, as Horejs and Mayr use them). `effects`:
/// the catalogue; no result without an effect of found terms. `beside`: orthonormal columns of effects that
/// the response does not have to explain.
std::vector<ScannedCandidate> enumerate_responses(const Evidence& evidence,
                                                  const std::vector<effects::Effect>& effects,
                                                  const Eigen::MatrixXd& beside);

}  // namespace vernier::diagnose
