// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/outliers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/median.h"

namespace vernier::diagnose {
namespace {

/// Returns rows with a reading more than `far` standard deviations from the fit. The standard
/// deviation is that of most rows, and at least u.
std::vector<std::size_t> far_rows(const model::Measurement& rows, const Eigen::VectorXd& residual,
                                  double far) {
  const Eigen::VectorXd weights = fit::fit_weights(rows);
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (weights[i] > 0) sizes.push_back(std::abs(weights[i] * residual[i]));
  if (sizes.empty()) return {};
  double spread = maths::robust_spread(std::move(sizes));
  if (fit::has_uncertainty(rows)) spread = std::max(spread, 1.0);
  std::vector<std::size_t> found;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (std::abs(weights[i] * residual[i]) > far * spread) {
      const std::size_t row = rows.observations[static_cast<std::size_t>(i)].row;
      if (found.empty() || found.back() != row) found.push_back(row);
    }
  return found;
}

struct Peeled {
  model::Measurement rows;         // the remaining rows
  std::vector<std::size_t> lines;  // lines of the excluded rows, in order
  std::vector<std::size_t> kept;   // indices of the remaining rows
  fit::FitResult fit;              // to the remaining rows
};

/// Excludes outlying rows and fits again until there are no more. Returns nullopt if there were no
/// outliers, or more than `most`.
std::optional<Peeled> peel(const model::Machine& machine, const model::Measurement& all,
                           const Eigen::VectorXd& of_all, double far, double most) {
  Peeled peeled{all, {}, {}, {}};
  peeled.kept.resize(all.rows());
  std::iota(peeled.kept.begin(), peeled.kept.end(), std::size_t{0});
  peeled.fit.residual = of_all;
  constexpr int kMostRounds = 5;  // rounds of excluding outliers, at most
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<std::size_t> found = far_rows(peeled.rows, peeled.fit.residual, far);
    if (found.empty()) break;
    std::vector<std::size_t> keep;
    for (std::size_t row = 0; row < peeled.rows.rows(); ++row)
      if (std::find(found.begin(), found.end(), row) == found.end()) keep.push_back(row);
    for (const std::size_t row : found) peeled.lines.push_back(peeled.rows.line[row]);
    if (static_cast<double>(peeled.lines.size()) > most) return std::nullopt;
    peeled.rows = model::select_rows(peeled.rows, keep);
    for (std::size_t i = 0; i < keep.size(); ++i) peeled.kept[i] = peeled.kept[keep[i]];
    peeled.kept.resize(keep.size());
    peeled.fit = fit::fit(machine, peeled.rows);
  }
  if (peeled.lines.empty()) return std::nullopt;
  std::sort(peeled.lines.begin(), peeled.lines.end());
  return peeled;
}

/// Returns "12 of 400 rows (line 14, 142, ...)"
std::string rows_in_words(const Peeled& peeled, const model::Measurement& all) {
  constexpr std::ptrdiff_t kNamed = 8;
  const auto count = static_cast<std::ptrdiff_t>(peeled.lines.size());
  return fmt::format("{} of {} rows (line {}{})", count, all.rows(),
                     fmt::join(peeled.lines.begin(), peeled.lines.begin() + std::min(kNamed, count), ", "),
                     count > kNamed ? ", ..." : "");
}

}  // namespace

std::optional<std::string> outliers_to_blame(const model::Machine& machine,
                                             const model::Measurement& measurement,
                                             const Eigen::VectorXd& of_all,
                                             const VerdictThresholds& thresholds) {
  if (!fit::has_uncertainty(measurement)) return std::nullopt;  // the expected residual is unknown
  const auto peeled = peel(machine, measurement, of_all, thresholds.outlier_spreads,
                           thresholds.outliers_alone * static_cast<double>(measurement.rows()));
  if (!peeled || peeled->fit.freedom <= 0) return std::nullopt;
  const double freedom = peeled->fit.freedom;
  if (peeled->fit.chi_square / freedom > 1 + thresholds.noise_sigmas * std::sqrt(2 / freedom))
    return std::nullopt;
  return fmt::format(
      "Outliers: without {} the residual is noise. A lost beam or a bumped target is likelier than the "
      "machine.",
      rows_in_words(*peeled, measurement));
}

std::optional<WithoutOutliers> without_gross_outliers(const model::Machine& machine,
                                                      const model::Measurement& measurement,
                                                      const Eigen::VectorXd& of_all,
                                                      const VerdictThresholds& thresholds) {
  const bool with_u = fit::has_uncertainty(measurement);
  const double far = with_u ? thresholds.outlier_spreads : thresholds.outlier_spreads_without_u;
  const double share = with_u ? thresholds.outliers_beside : thresholds.outliers_alone;
  auto peeled =
      peel(machine, measurement, of_all, far, std::max(1.0, share * static_cast<double>(measurement.rows())));
  if (!peeled) return std::nullopt;
  return WithoutOutliers{
      std::move(peeled->kept),
      fmt::format("Left out: {}, off by more than {:.0f} times the spread of the others, as a lost "
                  "beam or a bumped target is.",
                  rows_in_words(*peeled, measurement), far)};
}

}  // namespace vernier::diagnose
