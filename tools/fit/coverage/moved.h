// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// A tool point or a set-up that moved during a survey.
struct Move {
  double share = 0;  // rms influence of the move on the residual of the nominal machine, divided by this
                     // residual without the move
  std::string words;
};

/// Tests whether the tool point or the set-up moved at a row, so that later readings belong to another tool
/// point or set-up. find_move is used if the residual of a fit exceeds its noise. At each of several rows,
/// nine shifts and rotations of tool point and set-up are fitted together with the model (linearised at
/// `fitted`). `scale`: prior standard deviations of the model's parameters around `centre`. A move is
/// accepted if it explains most of the excess residual and such a result is improbable by chance. `nominal`:
/// residual of the nominal machine after a fit of its set-up. Returns nullopt if no move is accepted.
std::optional<Move> find_move(const model::Machine& fitted, const model::Measurement& rows,
                              const model::ParameterSet& parameters, const Eigen::VectorXd& centre,
                              const Eigen::VectorXd& scale, const Eigen::VectorXd& nominal);

}  // namespace vernier::fit
