// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::model {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// What the model says that each observation should read; mm, or deg for rotations. One entry per
/// observation. A predicted rotation vector is the one nearest to the measured (they repeat every 360 deg).
/// tool.
Eigen::VectorXd predict(const Machine& machine, const Measurement& measurement);

/// The same, and its derivatives by the free parameters (analytic): n_obs x n_params, mm or deg per parameter
/// unit.
struct Linearisation {
  Eigen::VectorXd predicted;
  SparseRows jacobian;
};
Linearisation linearise(const Machine& machine, const Measurement& measurement,
                        const ParameterSet& parameters);

/// The same with the work that does not depend on the parameters' values done beforehand.
class Linearizer;
Linearisation linearise(const Machine& machine, const Linearizer& linearizer, std::size_t observations,
                        std::size_t parameters);

}  // namespace vernier::model
