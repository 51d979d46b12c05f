// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/expected_readings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tools/maths/median.h"

namespace vernier::importer {
namespace {

/// With fewer differences, their median is no measure of the scatter.
constexpr std::size_t kFewestExpected = 8;
/// A median of n sizes scatters by about 1.2 / sqrt(n): the scale of few readings is made larger.
constexpr double kFewReadings = 5;

/// The scale of each value is here that of readings with the standard deviation 1.
using ExpectedList = std::vector<std::optional<ExpectedReading>>;

double middle_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

ExpectedReadings judged(const std::vector<PlacedReading>& readings, ExpectedList list, double digit) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i]) sizes.push_back((readings[i].value - list[i]->value) / list[i]->scale);
  if (sizes.size() < kFewestExpected) return {};
  const double few = 1 + kFewReadings / static_cast<double>(sizes.size());
  ExpectedReadings result{std::move(list), std::max(digit, maths::robust_spread(sizes) * few)};
  for (auto& one : result.at)
    if (one) one->scale *= result.scale;
  return result;
}

/// The median of the other readings of the same place and direction, after the offset of each run.
ExpectedList by_other_runs(const std::vector<PlacedReading>& readings) {
  using Key = std::pair<std::string, int>;
  std::map<Key, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < readings.size(); ++i)
    groups[{readings[i].place, readings[i].sense}].push_back(i);
  const auto median_of = [&](const std::vector<std::size_t>& group, std::size_t without, const auto& value) {
    std::vector<double> others;
    for (const std::size_t i : group)
      if (i != without) others.push_back(value(i));
    return middle_of(std::move(others));
  };
  const auto written = [&](std::size_t i) { return readings[i].value; };
  std::map<std::string, std::vector<double>> apart;
  for (const auto& [key, group] : groups)
    for (const std::size_t i : group)
      if (group.size() > 1)
        apart[readings[i].run].push_back(readings[i].value - median_of(group, readings.size(), written));
  std::map<std::string, double> offset;
  for (const auto& [run, list] : apart) offset[run] = middle_of(list);
  ExpectedList result(readings.size());
  for (const auto& [key, group] : groups)
    for (const std::size_t i : group) {
      if (group.size() < 2) continue;
      const double others =
          median_of(group, i, [&](std::size_t j) { return readings[j].value - offset[readings[j].run]; });
      result[i] = ExpectedReading{others + offset[readings[i].run],
                                  std::sqrt(1 + 1 / static_cast<double>(group.size() - 1))};
    }
  return result;
}

/// The readings of the other direction at the same place, in the same run, and the median reversal error.
ExpectedList by_other_direction(const std::vector<PlacedReading>& readings) {
  using Key = std::pair<std::string, std::string>;
  std::map<Key, std::map<int, double>> places;
  for (const PlacedReading& one : readings)
    if (one.sense != 0) places[{one.place, one.run}].emplace(one.sense, one.value);
  std::vector<double> reversal;
  for (const auto& [key, both] : places)
    if (both.size() == 2) reversal.push_back(both.at(1) - both.at(-1));
  ExpectedList result(readings.size());
  if (reversal.empty()) return result;
  const double usual = middle_of(reversal);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto place = places.find({readings[i].place, readings[i].run});
    if (place == places.end() || place->second.size() < 2) continue;
    result[i] =
        ExpectedReading{place->second.at(-readings[i].sense) + readings[i].sense * usual, std::sqrt(2.0)};
  }
  return result;
}

/// The straight line through two readings of the same run and direction: beside the reading, or at an end the
/// two next ones.
ExpectedList by_neighbours(const std::vector<PlacedReading>& readings) {
  std::map<std::pair<std::string, int>, std::vector<std::size_t>> sequences;
  for (std::size_t i = 0; i < readings.size(); ++i)
    sequences[{readings[i].run, readings[i].sense}].push_back(i);
  ExpectedList result(readings.size());
  for (const auto& [key, sequence] : sequences) {
    if (sequence.size() < 3) continue;
    for (std::size_t k = 0; k < sequence.size(); ++k) {
      const std::size_t last = sequence.size() - 1;
      const PlacedReading &at = readings[sequence[k]], &one = readings[sequence[k == 0 ? 1 : k - 1]],
                          &other = readings[sequence[k == 0      ? 2
                                                     : k == last ? last - 2
                                                                 : k + 1]];
      const double span = other.position - one.position;
      if (span == 0) continue;
      const double share = (at.position - one.position) / span;
      const bool inside = k > 0 && k < last;
      constexpr double kFarthest = 1.5;  // distances of the two readings: a line further out is no prediction
      if (inside ? share <= 0 || share >= 1 : std::abs(share) > kFarthest) continue;
      result[sequence[k]] = ExpectedReading{one.value + share * (other.value - one.value),
                                            std::sqrt(1 + (1 - share) * (1 - share) + share * share)};
    }
  }
  return result;
}

}  // namespace

std::vector<ExpectedReadings> expected_readings(const std::vector<PlacedReading>& readings, double digit) {
  std::vector<ExpectedReadings> list;
  for (const ExpectedList& one :
       {by_other_runs(readings), by_other_direction(readings), by_neighbours(readings)})
    if (ExpectedReadings expected = judged(readings, one, digit); expected.scale > 0)
      list.push_back(std::move(expected));
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.scale < b.scale; });
  return list;
}

}  // namespace vernier::importer
