// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/propose/enumerate.h"

namespace vernier::diagnose {

/// Returns the thermal response of each structure of the machine, estimated from the residual. A response is
/// a sum of temperatures and of first-order lags of temperatures. A response acts at the degrees of freedom
/// of one transform, as a constant and in proportion to the position of the structure's axis. Forward,
/// backward and exchange steps on the extended BIC select the summands of a response (thermal transfer
/// functions, as Horejs and Mayr use them). `effects`: the catalogue of effects; the result is empty if no
/// effect of the catalogue has found terms. `beside`: orthonormal columns of the effects that are already in
/// the model. The response does not explain the part of the readings along these columns.
std::vector<ScannedCandidate> enumerate_responses(const Evidence& evidence,
                                                  const std::vector<effects::Effect>& effects,
                                                  const Eigen::MatrixXd& beside);

}  // namespace vernier::diagnose
