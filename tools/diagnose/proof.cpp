// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/proof.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace vernier::diagnose {

double Proof::asked(const ProofThresholds& thresholds) const {
  if (expected < thresholds.evidence) return kEvidenceOfNothing;
  return std::clamp(expected - thresholds.loss_sigmas * std::sqrt(2 * expected), 0.0, thresholds.evidence);
}

Proof proof_on_check_rows(const model::Measurement& rows, const Eigen::VectorXd& before,
                          const Eigen::VectorXd& after, const fit::NoiseModel& noise, double variance) {
  Proof proof;
  std::vector<std::size_t> check;
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    if (rows.check[rows.observations[i].row] != 0) check.push_back(i);
  if (check.empty() || before.size() != after.size()) return proof;
  Eigen::MatrixXd left(static_cast<Eigen::Index>(check.size()), 2);
  for (std::size_t i = 0; i < check.size(); ++i) {
    const double u = model::uncertainty_of(rows, rows.observations[check[i]]);
    const double weight = (u > 0 ? 1 / u : 1) / std::sqrt(variance);
    const auto from = static_cast<Eigen::Index>(check[i]), at = static_cast<Eigen::Index>(i);
    left(at, 0) = weight * before[from];
    left(at, 1) = weight * after[from];
  }
  if (!noise.independent()) fit::whiten(fit::noise_layout(rows, check), noise, left);
  proof.evidence = (left.col(0).squaredNorm() - left.col(1).squaredNorm()) / 2;
  proof.expected = (left.col(0) - left.col(1)).squaredNorm() / 2;
  std::map<std::size_t, double> of_file;
  for (std::size_t i = 0; i < check.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    of_file[rows.file[rows.observations[check[i]].row]] +=
        (left(at, 0) * left(at, 0) - left(at, 1) * left(at, 1)) / 2;
  }
  if (of_file.size() > 1)
    for (const auto& [file, evidence] : of_file)
      proof.least_of_file = std::min(proof.least_of_file, evidence);
  return proof;
}

}  // namespace vernier::diagnose
