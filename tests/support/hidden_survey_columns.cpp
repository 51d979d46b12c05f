// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_columns.h"

#include <cstring>
#include <stdexcept>

#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/parameters.h"

namespace vernier::support {

using namespace vernier::model;
using namespace vernier::text;
namespace {

/// Orthonormal basis of what the scaled columns span.
Eigen::MatrixXd span(Eigen::MatrixXd columns, double cutoff) {
  if (columns.cols() == 0) return columns;  // a model with nothing free
  const double largest = columns.colwise().norm().maxCoeff();
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const double norm = columns.col(c).norm();
    // A column that is nearly zero is rounding, not a parameter.
    if (norm > 1e-9 * largest)
      columns.col(c) /= norm;
    else
      columns.col(c).setZero();
  }
  const Eigen::Index n = columns.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(r, Eigen::ComputeFullU);
  Eigen::Index rank = 0;
  while (rank < n && svd.singularValues()[rank] > cutoff * svd.singularValues()[0]) ++rank;
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(columns.rows(), rank);
  basis.topRows(n) = svd.matrixU().leftCols(rank);
  basis.applyOnTheLeft(qr.householderQ());
  return basis;
}

std::size_t dof_index(const Transform& transform, const std::string& name) {
  for (std::size_t d = 0; d < transform.dof_count(); ++d)
    if (name == transform.dof_name(d)) return d;
  throw std::logic_error("no degree of freedom " + name);
}

}  // namespace

Complement::Complement(const Machine& at, const Measurement& m) {
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (m.check[m.observations[i].row] == 0) fit_.push_back(static_cast<Eigen::Index>(i));
  weights_.resize(static_cast<Eigen::Index>(fit_.size()));
  for (std::size_t i = 0; i < fit_.size(); ++i) {
    const Observation& o = m.observations[static_cast<std::size_t>(fit_[i])];
    weights_[static_cast<Eigen::Index>(i)] = 1 / uncertainty_of(m, o);
  }
  const ParameterSet parameters(at, m.states.run_names);
  parameters_ = parameters.size();
  const Eigen::MatrixXd all = linearise(at, m, parameters).jacobian;
  Eigen::MatrixXd jacobian(weights_.size(), all.cols());
  for (std::size_t i = 0; i < fit_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    jacobian.row(row) = weights_[row] * all.row(fit_[i]);
  }
  if (jacobian.cols() > jacobian.rows()) throw std::runtime_error("fewer fit observations than parameters");
  basis_ = span(std::move(jacobian), 1e-4);
}

Eigen::VectorXd Complement::weighted(const Eigen::VectorXd& over_all) const {
  Eigen::VectorXd result(weights_.size());
  for (Eigen::Index i = 0; i < result.size(); ++i)
    result[i] = weights_[i] * over_all[fit_[static_cast<std::size_t>(i)]];
  return result;
}

Eigen::MatrixXd Complement::project(const Eigen::MatrixXd& columns) const {
  return columns - basis_ * (basis_.transpose() * columns);
}

void Complement::extend(const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd more = orthonormal(columns);
  basis_.conservativeResize(Eigen::NoChange, basis_.cols() + more.cols());
  basis_.rightCols(more.cols()) = more;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd basis(columns.rows(), columns.cols());
  Eigen::Index rank = 0;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const double norm = columns.col(c).norm();
    if (norm < 1e-12) continue;
    Eigen::VectorXd v = columns.col(c) / norm;
    for (int twice = 0; twice < 2; ++twice)
      v -= basis.leftCols(rank) * (basis.leftCols(rank).transpose() * v);
    if (v.norm() < 1e-4) continue;
    basis.col(rank++) = v.normalized();
  }
  return basis.leftCols(rank);
}

FormColumns::FormColumns(const Machine& machine, const Measurement& measurement, const Complement& complement)
    : machine_(machine),
      first_static_(machine.statics.size()),
      measurement_(measurement),
      complement_(complement) {
  for (const char* name : {"k1", "k2", "k3"}) {
    Static item;
    item.name = name;
    item.hidden = true;
    machine_.statics.push_back(item);
  }
}

const Eigen::VectorXd& FormColumns::sensitivity(const Place& place) const {
  const auto [found, is_new] = sensitivity_.try_emplace({place.workpiece, place.n, place.dof});
  if (!is_new) return found->second;
  constexpr double kStep = 1e-3;  // mm, deg: third-order error far below a millionth
  Eigen::VectorXd readings[2];
  for (const int side : {0, 1}) {
    Machine moved = machine_;
    for (Transform& t : place.workpiece ? moved.workpiece : moved.tool) {
      if (t.n != place.n) continue;
      ExprPtr& dof = t.dof[dof_index(t, place.dof)];
      dof = make_node(Op::kAdd, {dof, make_number(side == 0 ? -kStep : kStep)});
    }
    readings[side] = predict(moved, measurement_);
  }
  found->second = complement_.weighted((readings[1] - readings[0]) / (2 * kStep));
  return found->second;
}

const Eigen::VectorXd& FormColumns::factor(const std::string& text, std::size_t coefficient) const {
  const auto [found, is_new] = factor_.try_emplace({text, coefficient});
  if (!is_new) return found->second;
  Machine machine = machine_;
  for (std::size_t k = 0; k < 3; ++k) machine.statics[first_static_ + k].value = k == coefficient ? 1 : 0;
  const Column rows = model::evaluate(machine, *parse_expression_for(machine, text), measurement_.states);
  Eigen::VectorXd each(static_cast<Eigen::Index>(measurement_.observations.size()));
  for (Eigen::Index i = 0; i < each.size(); ++i)
    each[i] = rows[static_cast<Eigen::Index>(measurement_.observations[static_cast<std::size_t>(i)].row)];
  found->second = complement_.weighted(each);
  return found->second;
}

Eigen::MatrixXd FormColumns::operator()(const Form& form, bool with_reference) const {
  const bool extra = with_reference && !form.reference_factor.empty();
  const std::size_t count = form.coefficients.size();
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(complement_.observations(), static_cast<Eigen::Index>(count + (extra ? 1 : 0)));
  // The sensitivity is weighted already: the factor's weight is taken out again.
  const Eigen::VectorXd& weight = factor("1", 0);
  for (const Place& place : form.places) {
    const Eigen::ArrayXd by = sensitivity(place).array() / weight.array();
    for (std::size_t k = 0; k < count; ++k)
      columns.col(static_cast<Eigen::Index>(k)).array() += by * factor(place.text, k).array();
    if (extra) columns.rightCols(1).array() += by * factor(form.reference_factor, 0).array();
  }
  return complement_.project(columns);
}

}  // namespace vernier::support
