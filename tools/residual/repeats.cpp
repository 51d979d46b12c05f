// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/repeats.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/chance.h"
#include "tools/maths/factors.h"

namespace vernier::residual {
namespace {

constexpr std::size_t kLeastFreedom = 5;  // as noise_um

struct PoseGroup {
  double weight = 0, mean = 0, squares = 0, plain_mean = 0, plain_squares = 0;
  std::size_t count = 0;

  /// Running means lose fewer digits. value: weighted residual; w: 1/u.
  void add(double value, double w, double plain) {
    ++count;
    const double before = value / w - mean, share = w * w / (weight + w * w);
    weight += w * w;
    mean += share * before;
    squares += w * w * before * (value / w - mean);
    const double step = plain - plain_mean;
    plain_mean += step / static_cast<double>(count);
    plain_squares += step * (plain - plain_mean);
  }
};

/// Sums of the lengths that one instrument (one file) read.
struct Lengths {
  std::size_t freedom = 0, conditions = 0;
  double plain = 0, total = 0, readings = 0;
};

/// Sums of one kind of reading of one instrument.
struct OneKind {
  std::map<std::vector<double>, PoseGroup> groups;
  double total = 0, readings = 0;
};

}  // namespace

Repeats compare_repeats(const std::vector<KindSample>& samples, const model::Measurement& m) {
  Repeats result;
  double within = 0, between = 0, within_freedom = 0, between_freedom = 0;
  std::map<std::size_t, Lengths> lengths;  // of each instrument: its scatter is no other one's
  std::vector<std::vector<double>> of_row(m.rows());
  for (const KindSample& sample : samples) {
    std::map<std::size_t, OneKind> of_file;
    for (std::size_t i = 0; i < sample.rows.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const std::size_t row = sample.rows[i];
      std::vector<double>& key = of_row[row];
      if (key.empty()) key = fit::row_conditions(m, row);
      OneKind& own = of_file[row < m.file.size() ? m.file[row] : 0];
      own.groups[key].add(sample.held[at], sample.weight[at], sample.residual[at]);
      own.total += sample.residual[at] * sample.residual[at];
      own.readings += 1;
    }
    for (const auto& [file, one] : of_file) {
      double own = 0, own_between = 0, plain = 0;
      std::size_t freedom = 0;
      for (const auto& [key, group] : one.groups) {
        own += group.squares;
        own_between += group.weight * group.mean * group.mean;
        freedom += group.count - 1;
        plain += group.plain_squares;
      }
      if (freedom == 0) continue;
      if (!model::is_rotation(sample.kind)) {
        Lengths& sums = lengths[file];
        sums.freedom += freedom;
        sums.conditions += one.groups.size();
        sums.plain += plain;
        sums.total += one.total;
        sums.readings += one.readings;
      }
      // Each kind of each instrument in units of its own pure error.
      const double variance = own / static_cast<double>(freedom);
      if (freedom < kLeastFreedom || variance <= 0) continue;
      within += own / variance;
      between += own_between / variance;
      within_freedom = within_freedom == 0 ? static_cast<double>(freedom)
                                           : std::min(within_freedom, static_cast<double>(freedom));
      between_freedom += static_cast<double>(one.groups.size());
    }
  }
  if (within > 0 && between_freedom > 0)
    result.log_p = maths::log_f_tail(between / between_freedom, between_freedom, within_freedom);
  double plain = 0, rest = 0, readings = 0;
  for (const auto& [file, one] : lengths) {
    if (one.freedom < kLeastFreedom) continue;
    result.freedom += one.freedom;
    const double pure = one.plain / static_cast<double>(one.freedom);
    plain += one.plain;
    rest += one.total - one.plain - static_cast<double>(one.conditions) * pure;
    readings += one.readings;
    result.files.push_back(file);
  }
  if (result.freedom >= kLeastFreedom) {
    result.pure_error_um = maths::kUmPerMm * std::sqrt(plain / static_cast<double>(result.freedom));
    result.lack_of_fit_um = maths::kUmPerMm * std::sqrt(std::max(0.0, rest / readings));
  }
  return result;
}

std::optional<double> neighbour_error_um(const std::vector<KindSample>& samples,
                                         const std::vector<RecordedColumn>& columns) {
  std::vector<const RecordedColumn*> place;
  for (const RecordedColumn& column : columns)
    if (column.kind != ColumnKind::kTime && column.kind != ColumnKind::kVisit &&
        column.kind != ColumnKind::kRun)
      place.push_back(&column);
  if (place.empty()) return std::nullopt;
  double squares = 0, count = 0;
  std::map<std::vector<std::size_t>, std::vector<std::pair<std::size_t, std::size_t>>> pairs_of;
  for (const KindSample& sample : samples) {
    if (model::is_rotation(sample.kind)) continue;
    auto found = pairs_of.find(sample.rows);
    if (found == pairs_of.end()) found = pairs_of.emplace(sample.rows, neighbour_pairs(sample, place)).first;
    // The closer half: the other pairs of a greedy pairing are far apart.
    const std::size_t half = found->second.size() / 2;
    for (std::size_t i = 0; i < half; ++i) {
      const auto& [a, b] = found->second[i];
      squares += std::pow(sample.residual[static_cast<Eigen::Index>(a)] -
                              sample.residual[static_cast<Eigen::Index>(b)],
                          2) /
                 2;
      count += 1;
    }
  }
  // The standard deviation from ten pairs has an uncertainty of 1 / sqrt(2 * 10), 22 %.
  constexpr double kLeastPairs = 10;
  if (count < kLeastPairs) return std::nullopt;
  return maths::kUmPerMm * std::sqrt(squares / count);
}

}  // namespace vernier::residual
