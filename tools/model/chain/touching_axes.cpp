// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/touching_axes.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <map>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"

namespace vernier::model {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// All products of at most `degree` of the columns (scaled to -1..1), with the constant.
MatrixXd polynomial(const MatrixXd& columns, int degree) {
  std::vector<VectorXd> terms = {VectorXd::Ones(columns.rows())}, last = terms;
  std::vector<Index> from = {0};  // of each of the last terms: its largest factor
  for (int power = 1; power <= degree; ++power) {
    std::vector<VectorXd> next;
    std::vector<Index> next_from;
    for (std::size_t i = 0; i < last.size(); ++i)
      for (Index k = from[i]; k < columns.cols(); ++k) {
        next.push_back(last[i].cwiseProduct(columns.col(k)));
        next_from.push_back(k);
      }
    terms.insert(terms.end(), next.begin(), next.end());
    last = std::move(next);
    from = std::move(next_from);
  }
  MatrixXd matrix(columns.rows(), static_cast<Index>(terms.size()));
  for (std::size_t k = 0; k < terms.size(); ++k) matrix.col(static_cast<Index>(k)) = terms[k];
  return matrix;
}

/// Number of products of at most `degree` of so many columns.
std::size_t count_of_terms(std::size_t columns, int degree) {
  std::size_t count = 1;
  for (int power = 1; power <= degree; ++power)
    count = count * (columns + static_cast<std::size_t>(power)) / static_cast<std::size_t>(power);
  return count;
}

VectorXd scaled(const VectorXd& column) {
  const double low = column.minCoeff(), high = column.maxCoeff();
  if (!(high > low)) return VectorXd::Zero(column.size());
  return (2 * (column.array() - low) / (high - low) - 1).matrix();
}

/// rms of the position of one axis beside a polynomial of the others, over the rows of each object; infinite
/// if no object has enough rows for a polynomial.
double rest_beside_others(const std::vector<Column>& position,
                          const std::map<std::size_t, std::vector<std::size_t>>& rows_of, std::size_t axis) {
  constexpr int kMostDegree = 4;
  constexpr std::size_t kRowsOfATerm = 2;
  double squares = 0, count = 0;
  for (const auto& [thing, rows] : rows_of) {
    int degree = kMostDegree;
    while (degree > 0 && rows.size() < kRowsOfATerm * count_of_terms(position.size() - 1, degree)) --degree;
    if (degree == 0) continue;
    MatrixXd others(static_cast<Index>(rows.size()), static_cast<Index>(position.size()) - 1);
    Index at = 0;
    for (std::size_t other = 0; other < position.size(); ++other)
      if (other != axis) others.col(at++) = scaled(position[other](rows).matrix());
    const VectorXd own = position[axis](rows).matrix();
    const MatrixXd terms = polynomial(others, degree);
    squares += (own - terms * maths::least_norm(terms, own)).squaredNorm();
    count += static_cast<double>(rows.size());
  }
  return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::infinity();
}

}  // namespace

double extent_of_points(const Machine& machine, const Measurement& m, const std::vector<std::size_t>& rows) {
  if (rows.empty()) return 0;
  const Eigen::Matrix3Xd points = forward(machine, m.states).position(Eigen::all, rows);
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

std::set<std::size_t> touching_axes(const Machine& machine, const Measurement& m,
                                    const std::vector<std::size_t>& rows, double error_mm) {
  std::map<std::size_t, std::vector<std::size_t>> rows_of;
  for (const std::size_t row : std::set<std::size_t>(rows.begin(), rows.end()))
    if (const std::size_t thing = m.thing_of(row); thing != kNoThing) rows_of[thing].push_back(row);
  std::set<std::size_t> axes;
  if (rows_of.empty()) return axes;
  const double extent_mm = extent_of_points(machine, m, rows);
  std::vector<Column> position;
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) position.push_back(commanded(m, axis));
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const Column own = position[axis](rows);
    const double travel = own.maxCoeff() - own.minCoeff();
    const double mm = machine.axes[axis].rotary ? maths::kRadPerDeg * extent_mm : 1;
    if (!(travel > 0)) continue;
    if (mm * travel < kTravelOverError * error_mm ||
        mm * rest_beside_others(position, rows_of, axis) < kRestOverError * error_mm)
      axes.insert(axis);
  }
  return axes;
}

}  // namespace vernier::model
