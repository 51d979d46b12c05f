#include "tools/diagnose/outliers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/finder.h"
#include "tools/fit/fit.h"
#include "tools/fit/statistics.h"

namespace vernier {
namespace {

/// Rows with a reading far from all others of a fit, by line number; `spread` of the others.
std::vector<std::size_t> far_rows(const Measurement& rows, const Eigen::VectorXd& residual,
                                  bool noise_known) {
  const Eigen::VectorXd weights = fit_weights(rows);
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (weights[i] > 0) sizes.push_back(std::abs(weights[i] * residual[i]));
  if (sizes.empty()) return {};
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  // The median of |x| of a normal variable is 0.6745 of its standard deviation.
  double spread = sizes[sizes.size() / 2] / 0.6745;
  if (noise_known) spread = std::max(spread, 1.0);
  constexpr double kFar = 6;
  std::vector<std::size_t> far;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (std::abs(weights[i] * residual[i]) > kFar * spread) {
      const std::size_t row = rows.observations[static_cast<std::size_t>(i)].row;
      if (far.empty() || far.back() != row) far.push_back(row);
    }
  return far;
}

}  // namespace

std::optional<std::string> outliers_to_blame(const Machine& machine, const Measurement& measurement,
                                             const Eigen::VectorXd& of_all) {
  if (!has_uncertainty(measurement)) return std::nullopt;  // nothing says what the rest should be
  Measurement rows = measurement;
  Eigen::VectorXd residual = of_all;
  constexpr double kMostOfThem = 0.03;
  constexpr int kMostRounds = 5;
  const double most = kMostOfThem * static_cast<double>(rows.rows());
  std::vector<std::size_t> lines;
  FitResult rest;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<std::size_t> far = far_rows(rows, residual, true);
    if (far.empty()) break;
    std::vector<std::size_t> keep;
    for (std::size_t row = 0; row < rows.rows(); ++row)
      if (std::find(far.begin(), far.end(), row) == far.end()) keep.push_back(row);
    for (const std::size_t row : far) lines.push_back(rows.line[row]);
    if (static_cast<double>(lines.size()) > most) return std::nullopt;
    rows = select_rows(rows, keep);
    rest = fit(machine, rows);
    residual = rest.residual;
  }
  if (lines.empty() || rest.freedom <= 0) return std::nullopt;
  const double freedom = static_cast<double>(rest.freedom);
  if (rest.chi_square / freedom > 1 + kNoiseSigmas * std::sqrt(2 / freedom)) return std::nullopt;
  std::sort(lines.begin(), lines.end());
  return fmt::format(
      "Outliers: without {} of {} rows (line {}{}) the residual is noise. A lost beam or a bumped target "
      "is "
      "likelier than the machine.",
      lines.size(), measurement.rows(),
      fmt::join(lines.begin(),
                lines.begin() + std::min<std::ptrdiff_t>(8, static_cast<std::ptrdiff_t>(lines.size())), ", "),
      lines.size() > 8 ? ", ..." : "");
}

}  // namespace vernier
