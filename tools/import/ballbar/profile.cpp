// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/profile.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/maths/decompositions.h"

namespace vernier::importer {
namespace {

using Index = Eigen::Index;

constexpr double kStepDeg = 360.0 / static_cast<double>(kProfilePoints);  // from point to point

Index wrapped(Index k) { return ((k % kProfilePoints) + kProfilePoints) % kProfilePoints; }

void fill_gaps(Eigen::VectorXd& values, const Eigen::VectorXd& counts) {
  for (Index k = 0; k < kProfilePoints; ++k) {
    if (counts[k] > 0) continue;
    Index before = k - 1, after = k + 1;
    while (before > k - kProfilePoints && counts[wrapped(before)] == 0) --before;
    while (after < k + kProfilePoints && counts[wrapped(after)] == 0) ++after;
    const double part = static_cast<double>(k - before) / static_cast<double>(after - before);
    values[k] = (1 - part) * values[wrapped(before)] + part * values[wrapped(after)];
  }
}

void take_off_circle(Eigen::VectorXd& values) {
  Eigen::MatrixXd basis(kProfilePoints, 3);
  for (Index k = 0; k < kProfilePoints; ++k) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(kProfilePoints);
    basis.row(k) << 1, std::cos(angle), std::sin(angle);
  }
  values -= basis * maths::solve_symmetric(basis.transpose() * basis, basis.transpose() * values);
}

Eigen::VectorXd smoothed(const Eigen::VectorXd& values, Index half) {
  Eigen::VectorXd result(kProfilePoints);
  for (Index k = 0; k < kProfilePoints; ++k) {
    double sum = 0;
    for (Index j = -half; j <= half; ++j) sum += values[wrapped(k + j)];
    result[k] = sum / static_cast<double>(2 * half + 1);
  }
  return result;
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Index shift) {
  double sum = 0;
  for (Index k = 0; k < kProfilePoints; ++k) sum += a[k] * b[wrapped(k + shift)];
  const double size = a.norm() * b.norm();
  return size > 0 ? sum / size : 0;
}

}  // namespace

Eigen::VectorXd angle_profile(const BallbarRun& run) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(kProfilePoints), counts = sums;
  for (std::size_t i = 0; i < run.reading_mm.size(); ++i) {
    if (!run.clock->on_circle[i]) continue;
    const double angle = run.direction * run.clock->turned_deg[i];
    const Index k = wrapped(static_cast<Index>(std::floor(angle / kStepDeg)));
    sums[k] += 1000 * run.reading_mm[i];
    counts[k] += 1;
  }
  Eigen::VectorXd profile = sums.cwiseQuotient(counts.cwiseMax(1));
  fill_gaps(profile, counts);
  take_off_circle(profile);
  return profile;
}

ProfileShift profile_shift(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
  // Features narrower than 10 deg (ringing after a reversal) are on the other side in the other direction.
  constexpr double kWindowDeg = 10;
  constexpr Index kQuarter = kProfilePoints / 4;
  const auto half = static_cast<Index>(kWindowDeg / kStepDeg / 2);
  const Eigen::VectorXd a = smoothed(first, half), b = smoothed(second, half);
  std::vector<double> r;
  for (Index shift = -kQuarter; shift <= kQuarter; ++shift) r.push_back(correlation(a, b, shift));
  const auto best = std::max_element(r.begin(), r.end());
  ProfileShift result;
  result.correlation = *best;
  result.deg = static_cast<double>(best - r.begin() - kQuarter) * kStepDeg;
  // As many windows as there are independent values; one standard deviation of Fisher's z.
  const double spread = 1 / std::sqrt(360 / kWindowDeg - 3);
  const double limit = std::tanh(std::atanh(std::min(*best, 1 - 1e-9)) - spread);
  auto from = best, to = best;
  while (from != r.begin() && *from > limit) --from;
  while (to + 1 != r.end() && *to > limit) ++to;
  result.uncertainty_deg = static_cast<double>(to - from) / 2 * kStepDeg;
  return result;
}

}  // namespace vernier::importer
