// SPDX-License-Identifier: GPL-3.0-or-later
// How certain a quantity of a fitted machine is, by the record of its last fit.
#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::exchange {

/// Largest share of a value that its undetermined standard uncertainty may be: beyond it, the value is that
/// of no reading.
inline constexpr double kMostShare = 0.5;

/// Returns the squares of the changes of `of` (a function of a machine) by the columns of `factor`, which is
/// a factor of the covariance of the last fit: the variance of `of`.
template <class Of>
Eigen::VectorXd variance_of(const model::Machine& machine, const Eigen::MatrixXd& factor, const Of& of) {
  const model::FitRecord& record = *machine.fitted;
  model::Machine moved = machine;
  moved.base_shifts.clear();
  moved.tool_shifts.clear();
  const model::ParameterSet parameters(moved, {});
  const Eigen::VectorXd values = parameters.get(moved), as_fitted = of(moved);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(as_fitted.size());
  for (Eigen::Index column = 0; column < factor.cols(); ++column) {
    Eigen::VectorXd shifted = values;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const auto place = std::find(record.parameters.begin(), record.parameters.end(), parameters[i].name);
      if (place == record.parameters.end()) continue;
      shifted[static_cast<Eigen::Index>(i)] += factor(place - record.parameters.begin(), column);
    }
    parameters.set(moved, shifted);
    squares += (of(moved) - as_fitted).cwiseAbs2();
  }
  return squares;
}

}  // namespace vernier::exchange
