// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/least_squares/problem.h"

#include <algorithm>
#include <limits>

#include "tools/fit/least_squares/statistics.h"

namespace vernier::fit {

namespace {

/// to += weight * from, a block of `rows` x `columns` of two column-major matrices. Six rows, a
/// table's or a BaseShift's, are the usual case, so their loop is unrolled.
void add_block(double* to, Eigen::Index to_stride, const double* from, Eigen::Index from_stride,
               Eigen::Index rows, Eigen::Index columns, double weight) {
  if (rows == 6) {
    for (Eigen::Index j = 0; j < columns; ++j, to += to_stride, from += from_stride)
      for (int i = 0; i < 6; ++i) to[i] += weight * from[i];
    return;
  }
  for (Eigen::Index j = 0; j < columns; ++j, to += to_stride, from += from_stride)
    for (Eigen::Index i = 0; i < rows; ++i) to[i] += weight * from[i];
}

/// Adds one row's contribution. Each pair of groups has one block of `inner`. Every pair of their
/// stations adds it with the product of their weights. Fills the lower triangle (and parts of the
/// upper within a group).
void scatter(const std::vector<model::ParameterGroup>& groups, const Eigen::MatrixXd& inner,
             const Eigen::VectorXd& answer, NormalEquations& sum) {
  const Eigen::Index n = sum.normal.rows(), slots = inner.rows();
  for (std::size_t b = 0; b < groups.size(); ++b) {
    const model::ParameterGroup& low = groups[b];
    for (const auto& [row, row_weight] : low.first_weight) {
      for (Eigen::Index i = 0; i < low.width; ++i) sum.gradient[row + i] += row_weight * answer[low.slot + i];
      for (std::size_t a = 0; a <= b; ++a) {
        const model::ParameterGroup& high = groups[a];
        for (const auto& [column, column_weight] : high.first_weight)
          if (column <= row)
            add_block(sum.normal.data() + column * n + row, n, inner.data() + high.slot * slots + low.slot,
                      slots, low.width, high.width, row_weight * column_weight);
      }
    }
  }
}

/// inner = g * g^T and answer = g * r for slots x observations g. Both triangles are filled,
/// because a table's block with itself is used whole.
void inner_products(const Eigen::MatrixXd& g, const Eigen::VectorXd& r, Eigen::MatrixXd& inner,
                    Eigen::VectorXd& answer) {
  const Eigen::Index slots = g.rows();
  inner.resize(slots, slots);
  answer.setZero(slots);
  for (Eigen::Index o = 0; o < g.cols(); ++o) {
    const double* column = g.col(o).data();
    double* to = inner.data();
    for (Eigen::Index j = 0; j < slots; ++j, to += slots) {
      const double factor = column[j];
      if (o == 0)
        for (Eigen::Index i = 0; i < slots; ++i) to[i] = factor * column[i];
      else
        for (Eigen::Index i = 0; i < slots; ++i) to[i] += factor * column[i];
    }
    for (Eigen::Index i = 0; i < slots; ++i) answer[i] += r[o] * column[i];
  }
}

/// A parameter that moves no reading by more than this (mm or deg per unit, rms) has only rounding
/// effects: positions of 1e4 mm have a rounding error of 1e-12. Scaling up such a column would
/// create a false parameter.
constexpr double kRounding = 1e-11;

void silence_rounding(NormalEquations& equations, double squared_weights) {
  for (Eigen::Index i = 0; i < equations.normal.rows(); ++i) {
    if (equations.normal(i, i) > kRounding * kRounding * squared_weights) continue;
    equations.normal.row(i).setZero();
    equations.normal.col(i).setZero();
    equations.gradient[i] = 0;
  }
}

}  // namespace

FitProblem::FitProblem(const model::Machine& machine, const model::Measurement& measurement,
                       const model::ParameterSet& parameters)
    : machine_(machine),
      measurement_(measurement),
      parameters_(parameters),
      linearizer_(machine, measurement, parameters),
      weights_(fit_weights(measurement)) {
  measured_.resize(weights_.size());
  for (std::size_t i = 0; i < measurement.observations.size(); ++i)
    measured_[static_cast<Eigen::Index>(i)] = measurement.observations[i].value;
}

model::Machine FitProblem::at(const Eigen::VectorXd& point) const {
  model::Machine machine = machine_;
  parameters_.set(machine, point);
  return machine;
}

void FitProblem::set_priors(const Eigen::SparseMatrix<double>& precision, Eigen::VectorXd centre) {
  prior_precision_ = precision;
  prior_centre_ = std::move(centre);
}

double FitProblem::prior_cost(const Eigen::VectorXd& point) const {
  if (prior_centre_.size() == 0) return 0;
  const Eigen::VectorXd off = point - prior_centre_;
  return off.dot(prior_precision_ * off);
}

void FitProblem::hold_size(std::function<Eigen::VectorXd(const Eigen::VectorXd&)> direction,
                           Eigen::VectorXd dual) {
  size_ = std::move(direction);
  size_dual_ = std::move(dual);
}

void FitProblem::blind(const Eigen::VectorXd& point, Eigen::VectorXd& gradient) const {
  if (size_) {
    const Eigen::VectorXd v = size_(point);
    gradient -= size_dual_ * (v.dot(gradient) / size_dual_.dot(v));
  }
  for (Eigen::Index i = 0; i < gradient.size(); ++i)
    if (is_unseen(i)) gradient[i] = 0;
}

void FitProblem::blind(const Eigen::VectorXd& point, NormalEquations& equations) const {
  blind(point, equations.gradient);
  if (size_) {
    const Eigen::VectorXd v = size_(point), w = size_dual_ / size_dual_.dot(v), seen = equations.normal * v;
    equations.normal += v.dot(seen) * w * w.transpose() - w * seen.transpose() - seen * w.transpose();
  }
  for (Eigen::Index i = 0; i < equations.normal.rows(); ++i) {
    if (!is_unseen(i)) continue;
    equations.normal.row(i).setZero();
    equations.normal.col(i).setZero();
  }
}

model::Linearisation FitProblem::linearised(const Eigen::VectorXd& point) const {
  model::Linearisation linear =
      model::linearise(at(point), linearizer_, measurement_.observations.size(), parameters_.size());
  if (!size_ && unseen_.empty()) return linear;
  const auto blinded = [&](Eigen::MatrixXd jacobian) {
    if (size_) {
      const Eigen::VectorXd v = size_(point), w = size_dual_ / size_dual_.dot(v);
      jacobian -= (jacobian * v) * w.transpose();
    }
    for (Eigen::Index i = 0; i < jacobian.cols(); ++i)
      if (is_unseen(i)) jacobian.col(i).setZero();
    return jacobian;
  };
  linear.jacobian = blinded(linear.jacobian).sparseView();
  if (linear.known_jacobian.rows() > 0) linear.known_jacobian = blinded(linear.known_jacobian);
  return linear;
}

Eigen::MatrixXd FitProblem::known_jacobian(const Eigen::VectorXd& point) const {
  if (things().empty()) return {};
  return linearised(point).known_jacobian;
}

Eigen::MatrixXd FitProblem::things_jacobian(const Eigen::VectorXd& point) const {
  if (things().empty()) return {};
  const model::HeldLinearisation held = model::linearise_held(at(point), measurement_, parameters_);
  const Eigen::MatrixXd all = weights_.asDiagonal() * held.by_unknown;
  std::vector<Eigen::Index> seen;
  for (Eigen::Index k = 0; k < all.cols(); ++k)
    if (all.col(k).squaredNorm() > held.precision[k]) seen.push_back(k);
  return all(Eigen::all, seen);
}

Eigen::MatrixXd FitProblem::known_normal(const Eigen::VectorXd& point) const {
  const Eigen::MatrixXd known = known_jacobian(point);
  if (known.rows() == 0) return {};
  return known.transpose() * known;
}

/// The unknown values of things are eliminated: the derivatives are those at things that follow the
/// parameters. That is the Schur complement of the normal equations, without its cancellation of large
/// numbers.
NormalEquations FitProblem::readings_with_things(const Eigen::VectorXd& point) const {
  constexpr Eigen::Index kRowsAtOnce = 256;  // a block of dense rows that stays in the cache
  const model::Linearisation linear =
      model::linearise(at(point), linearizer_, measurement_.observations.size(), parameters_.size());
  const Eigen::Index n = linear.jacobian.cols(), count = linear.jacobian.rows();
  NormalEquations sum;
  const Eigen::VectorXd residual = weights_.cwiseProduct(measured_ - linear.predicted);
  sum.cost = residual.squaredNorm() + linear.known_residual.squaredNorm();
  sum.normal = Eigen::MatrixXd::Zero(n, n);
  sum.gradient = Eigen::VectorXd::Zero(n);
  for (Eigen::Index first = 0; first < count; first += kRowsAtOnce) {
    const Eigen::Index rows = std::min(kRowsAtOnce, count - first);
    const Eigen::MatrixXd block =
        weights_.segment(first, rows).asDiagonal() * Eigen::MatrixXd(linear.jacobian.middleRows(first, rows));
    sum.normal.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
    sum.gradient += block.transpose() * residual.segment(first, rows);
  }
  if (linear.known_residual.size() > 0) {
    sum.normal.selfadjointView<Eigen::Lower>().rankUpdate(linear.known_jacobian.transpose());
    // The estimates follow the parameters by `known_jacobian`; their known values do not.
    sum.gradient += linear.known_jacobian.transpose() * linear.known_residual;
  }
  return sum;
}

double FitProblem::cost(const Eigen::VectorXd& point) const {
  try {
    const model::Prediction now = model::predict_with_things(at(point), measurement_);
    return (measured_ - now.predicted).cwiseProduct(weights_).squaredNorm() + now.known_cost +
           prior_cost(point);
  } catch (const text::InputError&) {
    return std::numeric_limits<double>::infinity();
  }
}

Eigen::VectorXd FitProblem::weighted_residuals(const Eigen::VectorXd& point,
                                               model::SparseRows* jacobian) const {
  if (jacobian == nullptr)
    return (measured_ - model::predict(at(point), measurement_)).cwiseProduct(weights_);
  const model::Linearisation linear = linearised(point);
  *jacobian = weights_.asDiagonal() * linear.jacobian;
  return (measured_ - linear.predicted).cwiseProduct(weights_);
}

NormalEquations FitProblem::equations(const Eigen::VectorXd& point) const {
  const auto n = static_cast<Eigen::Index>(parameters_.size());
  NormalEquations result;
  result.gradient = Eigen::VectorXd::Zero(n);
  result.normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd weighted, inner;
  Eigen::VectorXd residual, answer;
  if (!things().empty()) result = readings_with_things(point);
  const auto add_row = [&](const model::RowLinear& row) {
    const auto first = static_cast<Eigen::Index>(row.first_observation);
    const Eigen::Index count = row.predicted.size();
    const auto weight = weights_.segment(first, count);
    weighted = row.gradient * weight.asDiagonal();
    residual = weight.cwiseProduct(measured_.segment(first, count) - row.predicted);
    inner_products(weighted, residual, inner, answer);
    result.cost += residual.squaredNorm();
    scatter(row.groups, inner, answer, result);
  };
  if (things().empty()) linearizer_.each_row(at(point), add_row);
  result.normal.triangularView<Eigen::StrictlyUpper>() = result.normal.transpose();
  blind(point, result);
  silence_rounding(result, weights_.squaredNorm());
  if (prior_centre_.size() > 0) {
    result.cost += prior_cost(point);
    result.normal += prior_precision_;
    result.gradient += prior_precision_ * (prior_centre_ - point);
  }
  return result;
}

Slope FitProblem::slope(const Eigen::VectorXd& point) const {
  Slope result;
  result.gradient = Eigen::VectorXd::Zero(point.size());
  Eigen::VectorXd weighted, answer;
  const auto add_row = [&](const model::RowLinear& row) {
    const auto first = static_cast<Eigen::Index>(row.first_observation);
    const Eigen::Index count = row.predicted.size();
    const auto weight = weights_.segment(first, count);
    weighted = weight.cwiseProduct(measured_.segment(first, count) - row.predicted);
    result.cost += weighted.squaredNorm();
    answer.noalias() = row.gradient * weighted.cwiseProduct(weight);
    for (const model::ParameterGroup& group : row.groups)
      for (const auto& [start, share] : group.first_weight)
        result.gradient.segment(start, group.width) += share * answer.segment(group.slot, group.width);
  };
  try {
    linearizer_.each_row(at(point), add_row,
                         [&](const model::ThingsAt& met) { result.cost += met.known_cost(); });
  } catch (const text::InputError&) {
    result.cost = std::numeric_limits<double>::infinity();
    return result;
  }
  blind(point, result.gradient);
  result.cost += prior_cost(point);
  if (prior_centre_.size() > 0) result.gradient += prior_precision_ * (prior_centre_ - point);
  return result;
}

Eigen::VectorXd FitProblem::bend_with_things(const Eigen::VectorXd& point, const Eigen::VectorXd& step,
                                             const Eigen::VectorXd& ahead, double part) const {
  const model::Linearisation linear = linearised(point);
  const Eigen::VectorXd second =
      2 / (part * part) * (ahead - linear.predicted - part * (linear.jacobian * step));
  return linear.jacobian.transpose() * second.cwiseProduct(weights_.cwiseAbs2());
}

Eigen::VectorXd FitProblem::bend(const Eigen::VectorXd& point, const Eigen::VectorXd& step) const {
  // A tenth of the step: large enough that the difference exceeds rounding, small enough for the
  // second derivative.
  constexpr double kPart = 0.1;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(point.size());
  Eigen::VectorXd ahead;
  try {
    ahead = model::predict(at(point + kPart * step), measurement_);
  } catch (const text::InputError&) {
    return result;
  }
  if (!things().empty()) return bend_with_things(point, step, ahead, kPart);
  linearizer_.each_row(at(point), [&](const model::RowLinear& row) {
    for (Eigen::Index o = 0; o < row.predicted.size(); ++o) {
      const Eigen::Index at_row = static_cast<Eigen::Index>(row.first_observation) + o;
      double slope = 0;
      for (const model::ParameterGroup& group : row.groups)
        for (const auto& [first, weight] : group.first_weight)
          slope += weight *
                   row.gradient.col(o).segment(group.slot, group.width).dot(step.segment(first, group.width));
      const double second = 2 / (kPart * kPart) * (ahead[at_row] - row.predicted[o] - kPart * slope);
      const double weighted = second * weights_[at_row] * weights_[at_row];
      for (const model::ParameterGroup& group : row.groups)
        for (const auto& [first, weight] : group.first_weight)
          result.segment(first, group.width) +=
              weight * weighted * row.gradient.col(o).segment(group.slot, group.width);
    }
  });
  return result;
}

}  // namespace vernier::fit
