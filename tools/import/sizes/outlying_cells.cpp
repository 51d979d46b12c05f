// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/outlying_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "tools/format/units.h"
#include "tools/maths/median.h"
#include "tools/sheet/sheet_number.h"

namespace vernier::importer {
namespace {

constexpr std::size_t kFewestValues =
    6;  // with fewer values, half of them have no two neighbours on each side
constexpr std::size_t kValuesBeside =
    2;  // values before and behind: one outlier of four widens the range only
/// Distance beyond the neighbours in median steps. Normal noise exceeds 10 median steps with a probability
/// below 1e-9; a reversal or a curve of an axis changes by a few steps.
constexpr double kFarSteps = 10;
/// Distance of a value that no lost decimal sign and no other unit explains: short runs with a reversal error
/// reach 20 steps.
constexpr double kFarUnexplained = 30;
/// Ten times too large: a tenth of the value agrees with its neighbours within three median steps. Larger
/// factors divide any value to a small one: the result must be in the range of the neighbours,
/// and the range without 0.
constexpr double kAgrees = 3;
/// More outliers than a quarter of the values are no typing errors.
constexpr std::size_t kFewestForEach = 4;

/// Ratio of two medians of one column that only another unit explains: a factor of 1000 with a curve of the
/// deviations by 3 (kApart in deviation_sizes.cpp).
constexpr double kUnitsApart = 300;
/// The largest of the small cells is smaller than the median of the large ones by this ratio.
constexpr double kUnitsGap = 100;
constexpr std::size_t kFewestCells = 3;  // fewer cells show no usual size

std::string signed_size(double value, bool angle) {
  return (value < 0 ? "-" : "") + size_text(std::abs(value), angle);
}

double median_step(const std::vector<double>& values) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) steps.push_back(std::abs(values[i] - values[i - 1]));
  return maths::median(steps);
}

struct SizedCell {
  double size = 0;
  std::size_t decimals = 0, line = 0;
};

double median_size(const std::vector<SizedCell>& cells) {
  std::vector<double> sizes;
  for (const SizedCell& one : cells) sizes.push_back(one.size);
  return maths::median(sizes);
}

/// What contradicts the single unit of a column; empty: nothing.
SizeDoubt mixed_units_of(const std::vector<SizedCell>& cells, bool angle) {
  std::set<std::size_t> decimals;
  for (const SizedCell& one : cells) decimals.insert(one.decimals);
  for (const std::size_t few : decimals) {
    std::vector<SizedCell> large, small;
    for (const SizedCell& one : cells) (one.decimals > few ? small : large).push_back(one);
    if (large.size() < kFewestCells || small.size() < kFewestCells) continue;
    const double usual = median_size(large), least = median_size(small);
    const double most =
        std::max_element(small.begin(), small.end(), [](const SizedCell& a, const SizedCell& b) {
          return a.size < b.size;
        })->size;
    if (usual < kUnitsApart * least || usual < kUnitsGap * most) continue;
    SizeDoubt doubt;
    doubt.line = small.front().line;
    doubt.text = fmt::format(
        "in this line and in {} more the deviations have more decimals and are about {}, in the other lines "
        "about {}: the lines do not have the same unit; write all cells of the column in the unit of the "
        "heading",
        std::to_string(small.size() - 1), size_text(least, angle), size_text(usual, angle));
    return doubt;
  }
  return {};
}

}  // namespace

std::vector<OutlyingValue> outlying_values(const std::vector<double>& values) {
  std::vector<OutlyingValue> found;
  if (values.size() < kFewestValues) return found;
  const double step = median_step(values);
  // Values that are mostly equal show no scatter.
  if (!(step > 0)) return found;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // At the ends, the four nearest values.
    const std::size_t first =
        std::min(i < kValuesBeside ? 0 : i - kValuesBeside, values.size() - 2 * kValuesBeside - 1);
    std::vector<double> beside;
    for (std::size_t j = first; j <= first + 2 * kValuesBeside; ++j)
      if (j != i) beside.push_back(values[j]);
    const auto [least, most] = std::minmax_element(beside.begin(), beside.end());
    const double far = std::max(*least - values[i], values[i] - *most) / step;
    if (far <= kFarSteps) continue;
    OutlyingValue one{i, *least, *most, 0};
    const double usual = maths::median(beside);
    // A decimal sign that is lost, or a cell in mm below a heading in um.
    for (const double times : {10.0, 100.0, 1000.0, 1e-3}) {
      const double value = values[i] / times;
      const bool agrees =
          times == 10 ? std::abs(value - usual) <= kAgrees * step : value >= *least && value <= *most;
      if (one.times == 0 && agrees) one.times = times;
    }
    if (one.times != 0 || far > kFarUnexplained) found.push_back(one);
  }
  if (kFewestForEach * found.size() > values.size()) found.clear();
  return found;
}

void note_outlying_cells(sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SizedColumn>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const DeviationSeries series = deviations_of(sheet, table, columns, k);
    const auto unit = sized_unit(columns[k]);
    for (const OutlyingValue& one : outlying_values(series.value)) {
      const bool angle = unit->dimension == format::Dimension::kAngle;
      const std::size_t row = series.row[one.index];
      const std::string lost =
          one.times == 0 ? ""
          : one.times < 1
              ? "; 1000 times this value agrees with them: has the cell another unit?"
              : fmt::format("; 1/{} of this value agrees with them: is a decimal sign lost?", one.times);
      sheet.notes.push_back(fmt::format(
          "line {}, \"{}\": the deviation {} of \"{}\" is far outside the deviations of the lines before and "
          "behind it ({} to {}){} The value is read; if it is wrong, correct the cell or write - into it",
          sheet.line[row], sheet.rows[row][k], signed_size(series.value[one.index], angle),
          table.headings[k].text, signed_size(one.least, angle), signed_size(one.most, angle),
          lost.empty() ? "." : lost));
    }
  }
}

std::vector<SizeDoubt> judge_mixed_units(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                         const std::vector<SizedColumn>& columns) {
  std::vector<SizeDoubt> doubts;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto unit = sized_unit(columns[k]);
    if (columns[k].use != SizedColumn::Use::kDeviation || !unit) continue;
    std::vector<SizedCell> cells;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const auto value = sheet::number_at(sheet, row, k);
      if (!value || *value == 0) continue;  // 0 has no size
      cells.push_back({std::abs(*value) * unit->factor,
                       sheet::decimals_of(sheet.rows[row][k], sheet.decimal_comma), sheet.line[row]});
    }
    SizeDoubt doubt = mixed_units_of(cells, unit->dimension == format::Dimension::kAngle);
    if (doubt.text.empty()) continue;
    if (columns[k].stated) {
      sheet.notes.push_back(
          fmt::format("\"{}\", line {}: {}", table.headings[k].text, doubt.line, doubt.text));
      continue;
    }
    doubt.column = k;
    doubt.text += fmt::format("; if all cells are in [{}], give --deviation \"{}[{}]={}\"", columns[k].unit,
                              columns[k].name, columns[k].unit, table.headings[k].text);
    doubts.push_back(std::move(doubt));
  }
  return doubts;
}

}  // namespace vernier::importer
