// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/outliers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/median.h"

namespace vernier::diagnose {
namespace {

/// Returns 1 for a reading of a check row, 0 for one of a fit row.
std::size_t role_of(const model::Measurement& rows, const model::Observation& one) {
  return rows.check[one.row] != 0 ? 1 : 0;
}

/// Returns the absolute value of each weighted residual of the check rows.
std::vector<double> check_sizes(const model::Measurement& rows, const Eigen::VectorXd& residual) {
  const bool with_u = fit::has_uncertainty(rows);
  std::vector<double> sizes;
  for (std::size_t i = 0; i < rows.observations.size(); ++i) {
    const model::Observation& one = rows.observations[i];
    if (role_of(rows, one) == 0) continue;
    const double u = with_u ? model::uncertainty_of(rows, one) : 1;
    sizes.push_back(u > 0 ? std::abs(residual[static_cast<Eigen::Index>(i)]) / u : 0);
  }
  return sizes;
}

/// Returns rows with a reading more than `far` standard deviations from the fit. The standard
/// deviation is that of most readings of the same role (fit or check row), and at least u. Check
/// rows that fail as a whole are therefore no outliers.
std::vector<std::size_t> far_rows(const model::Measurement& rows, const Eigen::VectorXd& residual,
                                  double far) {
  const bool with_u = fit::has_uncertainty(rows);
  std::array<std::vector<double>, 2> sizes;  // of fit rows and of check rows
  std::vector<double> all;
  for (std::size_t i = 0; i < rows.observations.size(); ++i) {
    const model::Observation& one = rows.observations[i];
    const double u = with_u ? model::uncertainty_of(rows, one) : 1;
    all.push_back(u > 0 ? std::abs(residual[static_cast<Eigen::Index>(i)]) / u : 0);
    sizes.at(role_of(rows, one)).push_back(all.back());
  }
  std::array<double, 2> spread{};
  for (std::size_t role = 0; role < sizes.size(); ++role)
    if (!sizes[role].empty())
      spread[role] = std::max(maths::robust_spread(std::move(sizes[role])), with_u ? 1.0 : 0.0);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const model::Observation& one = rows.observations[i];
    if (all[i] > far * spread.at(role_of(rows, one)) && (found.empty() || found.back() != one.row))
      found.push_back(one.row);
  }
  return found;
}

struct Peeled {
  model::Measurement rows;         // the remaining rows
  std::vector<std::size_t> lines;  // lines of the excluded rows, in order
  std::vector<std::size_t> kept;   // indices of the remaining rows
  fit::FitResult fit;              // to the remaining rows
};

/// Excludes outlying rows and fits again, until there are no more or the next round would exceed `most`
/// rows. Returns nullopt if no row was excluded.
std::optional<Peeled> peel(const model::Machine& machine, const model::Measurement& all,
                           const Eigen::VectorXd& of_all, double far, double most) {
  Peeled peeled{all, {}, {}, {}};
  peeled.kept.resize(all.rows());
  std::iota(peeled.kept.begin(), peeled.kept.end(), std::size_t{0});
  peeled.fit.residual = of_all;
  constexpr int kMostRounds = 5;  // rounds of excluding outliers, at most
  for (int round = 0; round < kMostRounds; ++round) {
    // Too many rows are the tails of an effect that is not yet found: only the farthest are outliers.
    std::vector<std::size_t> found = far_rows(peeled.rows, peeled.fit.residual, far);
    const double left = most - static_cast<double>(peeled.lines.size());
    for (double farther = 2 * far; peeled.lines.empty() && static_cast<double>(found.size()) > left;
         farther *= 2)
      found = far_rows(peeled.rows, peeled.fit.residual, farther);
    if (found.empty() || static_cast<double>(found.size()) > left) break;
    std::vector<std::size_t> keep;
    for (std::size_t row = 0; row < peeled.rows.rows(); ++row)
      if (std::find(found.begin(), found.end(), row) == found.end()) keep.push_back(row);
    for (const std::size_t row : found) peeled.lines.push_back(peeled.rows.line[row]);
    peeled.rows = model::select_rows(peeled.rows, keep);
    for (std::size_t i = 0; i < keep.size(); ++i) peeled.kept[i] = peeled.kept[keep[i]];
    peeled.kept.resize(keep.size());
    peeled.fit = fit::fit(machine, peeled.rows);
  }
  if (peeled.lines.empty()) return std::nullopt;
  std::sort(peeled.lines.begin(), peeled.lines.end());
  return peeled;
}

/// Successive excluded rows, by index: the first one, and the first row after them.
struct ExcludedGroup {
  std::size_t begin = 0, end = 0;
};

std::vector<ExcludedGroup> excluded_groups(const std::vector<std::size_t>& kept, std::size_t rows) {
  std::vector<ExcludedGroup> groups;
  std::size_t next = 0;
  const auto take = [&](std::size_t until) {
    if (next < until) groups.push_back({next, until});
    next = until + 1;
  };
  for (const std::size_t row : kept) take(row);
  take(rows);
  return groups;
}

/// Joins groups with a single row between them: one reading of a step may be near the model by chance.
std::vector<ExcludedGroup> joined(const std::vector<ExcludedGroup>& groups) {
  std::vector<ExcludedGroup> all;
  for (const ExcludedGroup& one : groups) {
    if (!all.empty() && one.begin - all.back().end <= 1)
      all.back().end = one.end;
    else
      all.push_back(one);
  }
  return all;
}

/// Returns the sentence about the largest group of excluded rows if the groups are too few for chance; else
/// empty. The machine or the target moved at the first row of the group. If the group begins a run and ends
/// within the run, the rest of the run is as the model states, and the motion was after the group.
std::string step_in_words(const model::Measurement& all, const std::vector<std::size_t>& kept,
                          double log_chance) {
  const std::vector<ExcludedGroup> groups = excluded_groups(kept, all.rows());
  const std::size_t out = all.rows() - kept.size();
  if (kept.empty() || log_p_of_groups(all.rows(), out, groups.size()) >= log_chance) return {};
  const std::vector<ExcludedGroup> longer = joined(groups);
  const ExcludedGroup longest = *std::max_element(
      longer.begin(), longer.end(),
      [](const ExcludedGroup& a, const ExcludedGroup& b) { return a.end - a.begin < b.end - b.begin; });
  const std::vector<std::size_t>& run = all.states.run;
  const auto changes_before = [&](std::size_t row) {
    return row == 0 || row == all.rows() || run[row - 1] != run[row];
  };
  const bool after = changes_before(longest.begin) && !changes_before(longest.end);
  return fmt::format(
      "The rows of lines {} to {} differ from the model together: a step at line {}, not outliers. Begin a "
      "new run at this line.",
      all.line[longest.begin], all.line[longest.end - 1], all.line[after ? longest.end : longest.begin]);
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

double log_p_of_groups(std::size_t all, std::size_t out, std::size_t groups) {
  const auto log_choose = [](double n, double k) {
    return k < 0 || k > n ? -std::numeric_limits<double>::infinity()
                          : std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
  };
  const auto n = static_cast<double>(all), m = static_cast<double>(out);
  double p = 0;
  for (std::size_t i = 1; i <= groups; ++i) {
    const auto g = static_cast<double>(i);
    p += std::exp(log_choose(m - 1, g - 1) + log_choose(n - m + 1, g) - log_choose(n, m));
  }
  return std::log(std::min(p, 1.0));
}

std::optional<OutliersToBlame> outliers_to_blame(const model::Machine& machine,
                                                 const model::Measurement& measurement,
                                                 const Eigen::VectorXd& of_all,
                                                 const VerdictThresholds& thresholds) {
  if (!fit::has_uncertainty(measurement)) return std::nullopt;  // the expected residual is unknown
  const auto peeled = peel(machine, measurement, of_all, thresholds.outlier_spreads,
                           thresholds.most_outliers * static_cast<double>(measurement.rows()));
  if (!peeled || peeled->fit.freedom <= 0) return std::nullopt;
  const double freedom = peeled->fit.freedom;
  if (peeled->fit.chi_square / freedom > 1 + thresholds.noise_sigmas * std::sqrt(2 / freedom))
    return std::nullopt;
  const std::string rows = rows_in_words(*peeled, measurement);
  if (const std::string step = step_in_words(measurement, peeled->kept, std::log(thresholds.structure));
      !step.empty())
    return OutliersToBlame{fmt::format("Without {} the residual is noise. {}", rows, step), true};
  return OutliersToBlame{fmt::format("Outliers: without {} the residual is noise. A lost beam or a displaced "
                                     "target is more likely than an error of the machine.",
                                     rows),
                         false};
}

std::optional<WithoutOutliers> without_gross_outliers(const model::Machine& machine,
                                                      const model::Measurement& measurement,
                                                      const Eigen::VectorXd& of_all,
                                                      const VerdictThresholds& thresholds) {
  const bool with_u = fit::has_uncertainty(measurement);
  const double far = with_u ? thresholds.outlier_spreads : thresholds.outlier_spreads_without_u;
  auto peeled = peel(machine, measurement, of_all, far,
                     std::max(1.0, thresholds.most_outliers * static_cast<double>(measurement.rows())));
  if (!peeled) return std::nullopt;
  std::string step = step_in_words(measurement, peeled->kept, std::log(thresholds.structure));
  return WithoutOutliers{
      std::move(peeled->kept),
      fmt::format("Excluded as outliers: {}, with a residual of more than {:.0f} standard deviations of the "
                  "other rows (as after a lost beam or a displaced target).",
                  rows_in_words(*peeled, measurement), far),
      std::move(step)};
}

bool is_worse_on_check_rows(const model::Measurement& rows_before, const Eigen::VectorXd& before,
                            const model::Measurement& rows_after, const Eigen::VectorXd& after,
                            const VerdictThresholds& thresholds) {
  const bool with_u = fit::has_uncertainty(rows_after);
  const std::vector<double> sizes_before = check_sizes(rows_before, before),
                            sizes_after = check_sizes(rows_after, after);
  const double spread = std::max(maths::robust_spread(sizes_after), with_u ? 1.0 : 0.0);
  const double far = spread * (with_u ? thresholds.outlier_spreads : thresholds.outlier_spreads_without_u);
  const auto square = [far](const std::vector<double>& sizes) {
    return std::accumulate(sizes.begin(), sizes.end(), 0.0, [far](double sum, double size) {
      return sum + std::min(size, far) * std::min(size, far);
    });
  };
  return square(sizes_after) > square(sizes_before);
}

}  // namespace vernier::diagnose
