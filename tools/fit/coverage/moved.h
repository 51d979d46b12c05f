// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Tool or set-up that moved during a survey.
struct Move {
  double share = 0;  // rms of its influence on the residual of the nominal machine, divided by that residual
                     // without the move
  std::string words;
};

/// Tests whether readings from a row on belong to another tool point or another set-up than the readings
/// before. find_move is used if the residual of a fit exceeds its noise. At each of several rows, the nine
/// shifts and rotations of tool point and set-up are fitted beside the model (linearised at `fitted`). scale:
/// prior standard deviations of the model's parameters about `centre`. The move is accepted if it explains
/// most of the excess residual and chance does not explain that. nominal: residual of the nominal machine
/// after its set-up. Returns nullopt if no row is accepted.
std::optional<Move> find_move(const model::Machine& fitted, const model::Measurement& rows,
                              const model::ParameterSet& parameters, const Eigen::VectorXd& centre,
                              const Eigen::VectorXd& scale, const Eigen::VectorXd& nominal);

}  // namespace vernier::fit
