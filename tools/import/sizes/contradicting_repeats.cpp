// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/contradicting_repeats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "tools/format/columns.h"
#include "tools/maths/median.h"
#include "tools/sheet/sheet_number.h"

namespace vernier::importer {
namespace {

constexpr std::size_t kFewestCompared = 6;  // fewer readings have no range that says what is usual
constexpr std::size_t kFewestRepeated = 4;  // fewer groups show no usual difference of repeats
/// Times the median difference of the other groups: 13 standard deviations of normal noise in groups of
/// three.
constexpr double kFarRepeats = 30;
/// Times the range of the nearer three quarters of the readings. A straight line reaches 0.7, a curve that
/// bends upwards at its end 2.
constexpr double kFarRange = 3;
constexpr double kNearer = 0.75;
/// More contradictions than a quarter of the groups are the machine's own.
constexpr std::size_t kPlacesForEach = 4;

/// Range of the readings that are nearest to the median.
double usual_range(const std::vector<double>& values) {
  const double middle = maths::median(values);
  std::vector<double> near = values;
  std::sort(near.begin(), near.end(),
            [&](double a, double b) { return std::abs(a - middle) < std::abs(b - middle); });
  near.resize(static_cast<std::size_t>(kNearer * static_cast<double>(near.size())));
  const auto [least, most] = std::minmax_element(near.begin(), near.end());
  return *most - *least;
}

struct Repeats {
  std::vector<std::size_t> readings;
  ContradictingRepeats worst;
  double apart = 0, typical = 0;
};

Repeats repeats_of(const std::vector<double>& values, const std::vector<std::size_t>& readings) {
  const double all = maths::median(values);
  Repeats result{readings, {}, -1, 0};
  std::vector<double> nearest;
  for (const std::size_t i : readings) {
    std::size_t other = i == readings.front() ? readings.back() : readings.front();
    for (const std::size_t j : readings)
      if (j != i && std::abs(values[j] - values[i]) < std::abs(values[other] - values[i])) other = j;
    const double apart = std::abs(values[other] - values[i]);
    nearest.push_back(apart);
    const bool further = std::abs(values[i] - all) > std::abs(values[result.worst.far] - all);
    if (apart > result.apart || (apart == result.apart && further)) {
      result.apart = apart;
      result.worst = {i, other};
    }
  }
  result.typical = maths::median(nearest);
  return result;
}

}  // namespace

std::vector<ContradictingRepeats> contradicting_repeats(const std::vector<double>& values,
                                                        const std::vector<std::size_t>& group) {
  std::vector<ContradictingRepeats> found;
  if (values.size() < kFewestCompared) return found;
  std::map<std::size_t, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < values.size(); ++i) groups[group[i]].push_back(i);
  std::vector<Repeats> list;
  std::vector<double> typical;
  for (const auto& [key, readings] : groups) {
    if (readings.size() < 2) continue;
    list.push_back(repeats_of(values, readings));
    typical.push_back(list.back().typical);
  }
  const double range = usual_range(values);
  if (!(range > 0) || list.empty()) return found;
  const double of_repeats = list.size() >= kFewestRepeated ? kFarRepeats * maths::median(typical)
                                                           : std::numeric_limits<double>::infinity();
  for (const Repeats& one : list)
    if (one.apart > kFarRange * range || (one.apart > range && one.apart > of_repeats))
      found.push_back(one.worst);
  if (list.size() >= kFewestRepeated && kPlacesForEach * found.size() > list.size()) found.clear();
  return found;
}

void note_contradicting_repeats(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SizedColumn>& columns) {
  std::vector<std::size_t> places;
  bool axis = false;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SizedColumn::Use::kPosition || columns[k].name == format::columns::kRun ||
        !columns[k].measures.empty())
      continue;
    places.push_back(k);
    axis |= columns[k].axis;
  }
  if (!axis) return;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    std::map<std::string, std::size_t> of_place;
    std::vector<std::size_t> group;
    const DeviationSeries series = deviations_of(sheet, table, columns, k);
    for (const std::size_t row : series.row) {
      std::string place;
      for (const std::size_t i : places) {
        const auto at = sheet::number_at(sheet, row, i);
        place += (at ? fmt::format("{:.9g}", *at) : sheet.rows[row][i]) + "|";
      }
      group.push_back(of_place.emplace(place, of_place.size()).first->second);
    }
    for (const ContradictingRepeats& one : contradicting_repeats(series.value, group)) {
      const std::size_t row = series.row[one.far], other = series.row[one.other];
      const std::string cell = fmt::format("line {}, \"{}\": ", sheet.line[row], sheet.rows[row][k]);
      if (std::any_of(sheet.notes.begin(), sheet.notes.end(),
                      [&](const std::string& note) { return note.starts_with(cell); }))
        continue;  // an outlier of its column
      sheet.notes.push_back(
          fmt::format("{}line {} has the same position and \"{}\", and the difference is far "
                      "larger than those of the other readings of \"{}\". Both rows are read; if one of them "
                      "is wrong, correct the cell or write - into it",
                      cell, sheet.line[other], sheet.rows[other][k], table.headings[k].text));
    }
  }
}

}  // namespace vernier::importer
