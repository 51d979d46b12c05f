// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "tests/support/hidden_survey_forms.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::support {

using namespace vernier::model;
using namespace vernier::text;

/// What the free parameters of a model cannot follow. Vectors are over the fit observations, weighted by 1/u.
class Complement {
 public:
  /// `at`: the model with the values to linearise at. Directions whose singular value (columns scaled to unit
  /// length) is below 1e-4 of the largest count as not free.
  Complement(const Machine& at, const Measurement& measurement);

  /// Picks the fit observations of a vector over all observations and weights them.
  Eigen::VectorXd weighted(const Eigen::VectorXd& over_all) const;
  Eigen::MatrixXd project(const Eigen::MatrixXd& columns) const;
  /// Takes these projected columns out as well.
  void extend(const Eigen::MatrixXd& columns);
  Eigen::Index observations() const { return weights_.size(); }
  std::size_t parameters() const { return parameters_; }

 private:
  std::vector<Eigen::Index> fit_;  // indices of the fit observations
  Eigen::VectorXd weights_;
  Eigen::MatrixXd basis_;
  std::size_t parameters_ = 0;
};

/// Orthonormal basis of the columns, those left out that are nearly dependent.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

/// First-order columns of forms: how the fit observations answer to each coefficient.
class FormColumns {
 public:
  /// Keeps references. `machine` knows all logged columns as inputs.
  FormColumns(const Machine& machine, const Measurement& measurement, const Complement& complement);

  /// Observations x coefficients; the column of the unknown reference last where `with_reference`. Projected.
  Eigen::MatrixXd operator()(const Form& form, bool with_reference) const;

 private:
  const Eigen::VectorXd& sensitivity(const Place& place) const;
  const Eigen::VectorXd& factor(const std::string& text, std::size_t coefficient) const;

  Machine machine_;  // with k1 k2 k3 as statics
  std::size_t first_static_;
  const Measurement& measurement_;
  const Complement& complement_;
  mutable std::map<std::tuple<bool, int, std::string>, Eigen::VectorXd> sensitivity_;
  mutable std::map<std::pair<std::string, std::size_t>, Eigen::VectorXd> factor_;
};

}  // namespace vernier::support
