// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Tool or set-up that moved in the middle of a survey.
struct Move {
  double share = 0;  // of what it makes the nominal machine miss, over what that misses without it: rms
  std::string words;
};

/// Do readings from some row on see another tool point or another set-up than those before? Asked where a
/// fit leaves more than its noise: at each of some rows the nine shifts and turns of both are fitted beside
/// the model (linearised at `fitted`; scale: of its parameters, which hold them near `centre`), and they are
/// believed where they take most of the rest away and chance does not. nominal: what the nominal machine, set
/// up, leaves of the readings. Nothing: no such row. tool.
std::optional<Move> find_move(const model::Machine& fitted, const model::Measurement& rows,
                              const model::ParameterSet& parameters, const Eigen::VectorXd& centre,
                              const Eigen::VectorXd& scale, const Eigen::VectorXd& nominal);

}  // namespace vernier::fit
