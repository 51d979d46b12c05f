// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/proof.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "tools/model/chain/prediction.h"

namespace vernier::diagnose {

double Proof::asked(const ProofThresholds& thresholds) const {
  if (expected < thresholds.evidence) return kEvidenceOfNothing;
  return std::clamp(expected - thresholds.loss_sigmas * std::sqrt(2 * expected), 0.0, thresholds.evidence);
}

namespace {

/// Indices of the check observations.
std::vector<std::size_t> check_observations(const model::Measurement& rows) {
  std::vector<std::size_t> check;
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    if (rows.check[rows.observations[i].row] != 0) check.push_back(i);
  return check;
}

/// Columns over the check observations in units of the independent noise, with independent errors.
Eigen::MatrixXd in_units_of_noise(const model::Measurement& rows, const std::vector<std::size_t>& check,
                                  Eigen::MatrixXd columns, const fit::NoiseModel& noise, double variance) {
  for (std::size_t i = 0; i < check.size(); ++i) {
    const double u = model::uncertainty_of(rows, rows.observations[check[i]]);
    columns.row(static_cast<Eigen::Index>(i)) *= (u > 0 ? 1 / u : 1) / std::sqrt(variance);
  }
  if (!noise.independent()) fit::whiten(fit::noise_layout(rows, check), noise, columns);
  return columns;
}

/// Variance of the evidence of one file that the uncertainty of the parameters after the step adds.
double variance_by_parameters(const model::Measurement& rows, std::size_t file, const fit::FitResult& before,
                              const fit::FitResult& after, const fit::NoiseModel& noise, double variance) {
  const std::vector<std::size_t> check = check_observations(rows);
  const model::SparseRows jacobian = model::linearise(after.machine, rows, after.parameters).jacobian;
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(check.size()), jacobian.cols() + 1);
  for (std::size_t i = 0; i < check.size(); ++i)
    for (model::SparseRows::InnerIterator one(jacobian, static_cast<Eigen::Index>(check[i])); one; ++one)
      columns(static_cast<Eigen::Index>(i), one.col()) = one.value();
  columns.rightCols<1>() = (before.residual - after.residual)(check);
  columns = in_units_of_noise(rows, check, std::move(columns), noise, variance);
  Eigen::VectorXd change = columns.rightCols<1>();
  for (std::size_t i = 0; i < check.size(); ++i)
    if (rows.file[rows.observations[check[i]].row] != file) change[static_cast<Eigen::Index>(i)] = 0;
  const Eigen::VectorXd moved = columns.leftCols(jacobian.cols()).transpose() * change;
  return moved.dot(after.covariance * moved);
}

/// Mean evidence of the held-out rows of a file for the term alone, if it is true.
double evidence_of_term(const model::Measurement& rows, std::size_t file, const Eigen::VectorXd& term,
                        const fit::NoiseModel& noise, double variance) {
  const std::vector<std::size_t> check = check_observations(rows);
  const Eigen::VectorXd change = in_units_of_noise(rows, check, term(check), noise, variance);
  double sum = 0;
  for (std::size_t i = 0; i < check.size(); ++i)
    if (rows.file[rows.observations[check[i]].row] == file)
      sum += std::pow(change[static_cast<Eigen::Index>(i)], 2) / 2;
  return sum;
}

}  // namespace

std::optional<Proof::OfFile> contradicting_file(const Proof& proof, const ProofThresholds& thresholds,
                                                const model::Measurement& rows, const fit::FitResult& before,
                                                const fit::FitResult& after, const Eigen::VectorXd& term,
                                                const fit::NoiseModel& noise, double variance) {
  for (const Proof::OfFile& one : proof.files) {
    if (one.evidence >= -thresholds.contradiction) continue;
    if (evidence_of_term(rows, one.file, term, noise, variance) < -kEvidenceOfNothing) continue;
    const double std =
        std::sqrt(2 * one.expected + variance_by_parameters(rows, one.file, before, after, noise, variance));
    if (one.evidence < one.expected - thresholds.loss_sigmas * std) return one;
  }
  return std::nullopt;
}

Proof proof_on_check_rows(const model::Measurement& rows, const Eigen::VectorXd& before,
                          const Eigen::VectorXd& after, const fit::NoiseModel& noise, double variance) {
  Proof proof;
  const std::vector<std::size_t> check = check_observations(rows);
  if (check.empty() || before.size() != after.size()) return proof;
  Eigen::MatrixXd left(static_cast<Eigen::Index>(check.size()), 2);
  left << before(check), after(check);
  left = in_units_of_noise(rows, check, std::move(left), noise, variance);
  std::map<std::size_t, Proof::OfFile> of_file;
  for (std::size_t i = 0; i < check.size(); ++i) {
    const Eigen::RowVector2d of_row = left.row(static_cast<Eigen::Index>(i));
    const double evidence = (of_row[0] * of_row[0] - of_row[1] * of_row[1]) / 2,
                 expected = std::pow(of_row[0] - of_row[1], 2) / 2;
    proof.evidence += evidence;
    proof.expected += expected;
    Proof::OfFile& own = of_file[rows.file[rows.observations[check[i]].row]];
    own.evidence += evidence;
    own.expected += expected;
  }
  if (of_file.size() > 1)
    for (auto& [file, own] : of_file) {
      own.file = file;
      proof.files.push_back(own);
    }
  return proof;
}

std::vector<CheckOfFile> checks_of_files(const model::Measurement& rows, const Eigen::VectorXd& residual) {
  struct Sum {
    double squares = 0, count = 0;
  };
  std::map<std::size_t, Sum> of_file;
  for (const std::size_t i : check_observations(rows)) {
    const model::Observation& one = rows.observations[i];
    const double u = model::uncertainty_of(rows, one);
    if (!(u > 0)) return {};
    Sum& sum = of_file[rows.file[one.row]];
    sum.squares += std::pow(residual[static_cast<Eigen::Index>(i)] / u, 2);
    ++sum.count;
  }
  std::vector<CheckOfFile> list;
  for (const auto& [file, sum] : of_file)
    list.push_back({rows.files[file], std::sqrt(sum.squares / sum.count)});
  return list.size() > 1 ? list : std::vector<CheckOfFile>{};
}

}  // namespace vernier::diagnose
