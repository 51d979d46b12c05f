// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/acceptance.h"

#include <algorithm>

#include "tools/diagnose/propose/enumerate.h"
#include "tools/diagnose/propose/scan.h"
#include "tools/maths/decompositions.h"

namespace vernier::diagnose {
namespace {

/// Rows of a matrix or vector that belong to one block.
std::vector<Eigen::Index> rows_of(const std::vector<int>& blocks, int block) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i] == block) rows.push_back(static_cast<Eigen::Index>(i));
  return rows;
}

/// Returns the number of directions that the other runs do not determine. `information`: theirs of
/// each direction, increasing; `least`: required share of it.
Eigen::Index lost_directions(const Eigen::VectorXd& information, double least) {
  Eigen::Index lost = 0;
  while (lost < information.size() && information[lost] < least) ++lost;
  return lost;
}

/// Returns the part of the model's free parameters that only the held-out rows determine (their
/// own set-up), as orthonormal columns over these rows. It is fitted to them. New columns are not
/// fitted to them: they must come from the other rows.
Eigen::MatrixXd fitted_to_block_alone(const Eigen::MatrixXd& model_rows, double least) {
  if (model_rows.cols() == 0) return model_rows;  // nothing is free
  const Eigen::MatrixXd normal =
      Eigen::MatrixXd::Identity(model_rows.cols(), model_rows.cols()) - model_rows.transpose() * model_rows;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(normal);
  return maths::orthonormal(
      model_rows * eigen.eigenvectors().leftCols(lost_directions(eigen.eigenvalues(), least)), 1e-6, nullptr);
}

/// Returns the level of each value. Levels are separated where neighbours in size differ by
/// `least_width`. If that gives one level or too many levels, the range is divided into parts, if
/// each part has at least that width.
std::vector<int> levels_of(const std::vector<double>& values, double least_width, const FoldExtent& folds) {
  const auto parts = static_cast<int>(folds.parts_of_sweep);
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> begins;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] > least_width) begins.push_back(sorted[i]);
  const double width = sorted.back() - sorted.front();
  if ((begins.empty() || begins.size() >= folds.most_levels) && width > parts * least_width) {
    begins.clear();
    for (int i = 1; i < parts; ++i) begins.push_back(sorted.front() + i * width / parts);
  }
  std::vector<int> levels;
  for (const double value : values)
    levels.push_back(
        static_cast<int>(std::upper_bound(begins.begin(), begins.end(), value) - begins.begin()));
  return levels;
}

/// Index of the position of each fit observation among the different positions of an axis, in order of size.
std::vector<std::size_t> positions_in_order(const Evidence& evidence, std::size_t axis) {
  std::vector<double> values, sorted;
  for (const std::size_t row : evidence.rows())
    values.push_back(evidence.measurement().states.axis[axis][static_cast<Eigen::Index>(row)]);
  sorted = values;
  std::sort(sorted.begin(), sorted.end());
  // Positions at one target differ by the positioning error of the axis.
  const double apart = evidence.thresholds().layout.small_step * (sorted.back() - sorted.front());
  std::vector<double> first = {sorted.front()};
  for (const double value : sorted)
    if (value - first.back() > apart) first.push_back(value);
  std::vector<std::size_t> order;
  for (const double value : values)
    order.push_back(
        static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), value) - first.begin()) - 1);
  return order;
}

std::size_t count_of(const std::vector<std::size_t>& order) {
  return *std::max_element(order.begin(), order.end()) + 1;
}

}  // namespace

HeldOut leave_blocks_out(const Evidence& evidence, const Eigen::MatrixXd& columns, Eigen::Index watched_first,
                         Eigen::Index watched_count, const std::vector<int>& blocks) {
  HeldOut result;
  const Eigen::MatrixXd own = maths::orthonormal(columns, 1e-6, nullptr);
  const Eigen::MatrixXd& q = evidence.absorbed();
  Eigen::MatrixXd basis(q.rows(), q.cols() + own.cols());
  basis << q, own;
  const Eigen::VectorXd& r = evidence.residual();
  const Eigen::VectorXd all = basis.transpose() * r;
  // Full set of columns in terms of `own`, to follow the watched ones.
  const Eigen::MatrixXd in_own = own.transpose() * columns;
  const auto watched_part = [&](const Eigen::VectorXd& theta) -> Eigen::VectorXd {
    if (watched_count == 0 || own.cols() < columns.cols()) return Eigen::VectorXd();
    const Eigen::VectorXd coefficient = maths::least_squares(in_own, theta.tail(own.cols()));
    return columns.middleCols(watched_first, watched_count) *
           coefficient.segment(watched_first, watched_count);
  };
  const Eigen::VectorXd whole = watched_part(all);
  const double determined = evidence.thresholds().acceptance.determined_share;
  const int count = 1 + *std::max_element(blocks.begin(), blocks.end());
  for (int block = 0; block < count; ++block) {
    const std::vector<Eigen::Index> rows = rows_of(blocks, block);
    if (rows.empty()) continue;
    const Eigen::MatrixXd left_out = basis(rows, Eigen::all);
    const Eigen::VectorXd r_out = r(rows);
    if (basis.cols() == 0) {
      result.chi_square += r_out.squaredNorm();
      result.predicted_square += r_out.squaredNorm();
      continue;
    }
    const Eigen::MatrixXd normal =
        Eigen::MatrixXd::Identity(basis.cols(), basis.cols()) - left_out.transpose() * left_out;
    const Eigen::VectorXd moment = all - left_out.transpose() * r_out;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(normal);
    const Eigen::Index lost = lost_directions(eigen.eigenvalues(), determined);
    const Eigen::Index seen = basis.cols() - lost;
    const Eigen::MatrixXd v = eigen.eigenvectors().rightCols(seen);
    const Eigen::VectorXd theta = v * (v.transpose() * moment).cwiseQuotient(eigen.eigenvalues().tail(seen));
    Eigen::VectorXd error = r_out - left_out * theta;
    const Eigen::MatrixXd own_of_block = fitted_to_block_alone(left_out.leftCols(q.cols()), determined);
    error -= own_of_block * (own_of_block.transpose() * error);
    result.chi_square += error.squaredNorm();
    // The covariance of the prediction is I + A D^-1 A^T with A = left_out v and D the eigenvalues of v. As
    // D + A^T A is I, its inverse is I - A A^T, and its determinant is 1 / det D.
    result.predicted_square +=
        error.squaredNorm() - (v.transpose() * (left_out.transpose() * error)).squaredNorm();
    result.predicted_log_determinant -= eigen.eigenvalues().tail(seen).array().log().sum();
    const Eigen::VectorXd part = watched_part(theta);
    if (part.size() > 0)
      result.agreement.push_back(part.dot(whole) / std::max(part.norm() * whole.norm(), 1e-300));
  }
  return result;
}

std::vector<std::vector<int>> level_blocks(const Evidence& evidence) {
  const model::States& states = evidence.measurement().states;
  const AcceptanceThresholds& thresholds = evidence.thresholds().acceptance;
  std::vector<std::vector<int>> all;
  const auto take = [&](const model::Column& column, double least_width) {
    std::vector<double> values;
    for (const std::size_t row : evidence.rows()) values.push_back(column[static_cast<Eigen::Index>(row)]);
    const std::vector<int> levels = levels_of(values, least_width, evidence.thresholds().search.folds);
    if (*std::max_element(levels.begin(), levels.end()) > 0) all.push_back(levels);
  };
  double fastest = 0;
  for (const std::size_t row : evidence.rows())
    fastest = std::max(fastest, states.feed[static_cast<Eigen::Index>(row)]);
  if (fastest > 0) take(states.feed, thresholds.same_feed * fastest);
  for (std::size_t i = 0; i < evidence.machine().inputs.size(); ++i)
    if (effects::class_of_input(evidence.machine().inputs[i]) == effects::InputClass::kTemperature)
      take(states.input[i], thresholds.least_warmth_degC);
  return all;
}

std::vector<std::vector<int>> place_blocks(const Evidence& evidence, std::optional<std::size_t> axis) {
  const std::size_t parts = evidence.thresholds().search.folds.blocks_of_one_run;
  std::vector<std::vector<int>> all;
  if (axis) {
    const std::vector<std::size_t> order = positions_in_order(evidence, *axis);
    const std::size_t count = count_of(order);
    if (count >= 2 * parts) {
      std::vector<int> stretches, targets;
      for (const std::size_t at : order) {
        // Beyond the other rows at an end, a curve would have to extrapolate: the ends are never held out.
        const std::size_t stretch = at * parts / count;
        stretches.push_back(stretch == 0 || stretch + 1 == parts ? -1 : static_cast<int>(stretch) - 1);
        targets.push_back(static_cast<int>(at % parts));
      }
      all.push_back(std::move(stretches));
      all.push_back(std::move(targets));
    }
  }
  std::vector<std::pair<std::size_t, std::vector<std::size_t>>> axes;
  for (std::size_t i = 0; i < evidence.machine().axes.size(); ++i) {
    std::vector<std::size_t> order = positions_in_order(evidence, i);
    if (count_of(order) > 1) axes.emplace_back(count_of(order), std::move(order));
  }
  std::stable_sort(axes.begin(), axes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  constexpr std::size_t kOfSpace = 3;  // axes: eight corners
  axes.resize(std::min(axes.size(), kOfSpace));
  std::vector<int> corners(evidence.rows().size());
  for (std::size_t bit = 0; bit < axes.size(); ++bit)
    for (std::size_t i = 0; i < corners.size(); ++i)
      corners[i] += (2 * axes[bit].second[i] >= axes[bit].first ? 1 : 0) << bit;
  if (!axes.empty()) all.push_back(std::move(corners));
  return all;
}

}  // namespace vernier::diagnose
