// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/typed_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "tools/format/columns.h"
#include "tools/maths/median.h"
#include "tools/sheet/sheet_number.h"

namespace vernier::importer {
namespace {

constexpr std::size_t kFewestTargets = 5;     // fewer targets show no order
constexpr std::size_t kFewestNeighbours = 3;  // two of them show no order
/// More turns than a quarter of the rows: the positions have no order (a grid, random positions).
constexpr std::size_t kRowsPerTurn = 4;
/// A multiple of a target agrees with an even division within a hundredth of the division.
constexpr double kEven = 0.01;
/// Ten times the second of two equal steps is four gaps of two steps away; targets in no order are nearer.
constexpr double kFarGaps = 3.5;
/// A step of a survey is at most three median steps, and a slipped cell is further away.
constexpr double kLongStep = 3;
constexpr double kPerMetre = 1000;  // mm in a metre

constexpr std::size_t kFewestTyped = 3;  // fewer cells show no usual size
/// Steps between cells with and without a decimal sign, as a share of the steps without the lost signs. Noise
/// that is written with two digits (1.8, 13) has a share of 0.27.
constexpr double kSmoother = 0.1;
/// The same, if a cell begins with 0: "-07".
constexpr double kSmootherWithZero = 0.5;
constexpr std::size_t kFewestChanges = 4;  // between cells with and without a sign

/// Ratio of two runs, from 10 or 100: the scatter of five readings is below a fifth of their size.
constexpr double kRatioSpread = 1.25;
constexpr double kResidualShare = 0.25;   // of the readings; unrelated runs have 1
constexpr std::size_t kFewestCommon = 5;  // fewer targets agree by chance
constexpr std::size_t kMostScales = 200;  // more runs are labels of the rows

struct TypedCell {
  std::size_t row = 0;
  double value = 0;
  std::size_t decimals = 0;
};

std::vector<TypedCell> typed_cells_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                      std::size_t k) {
  std::vector<TypedCell> cells;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto value = sheet::number_at(sheet, row, k))
      cells.push_back({row, *value, sheet::decimals_of(sheet.rows[row][k], sheet.decimal_comma)});
  return cells;
}

bool in_order(const std::vector<double>& list) {
  const auto up = [](double a, double b) { return a >= b; };
  const auto down = [](double a, double b) { return a <= b; };
  return std::adjacent_find(list.begin(), list.end(), up) == list.end() ||
         std::adjacent_find(list.begin(), list.end(), down) == list.end();
}

std::size_t turns_of(const std::vector<double>& values) {
  std::size_t turns = 0;
  for (std::size_t i = 2; i < values.size(); ++i)
    turns += (values[i] - values[i - 1]) * (values[i - 1] - values[i - 2]) < 0 ? 1 : 0;
  return turns;
}

/// A target between two others, whose multiple is in order.
std::optional<MisplacedTarget> misplaced_between(const std::vector<double>& values, std::size_t i) {
  std::vector<double> beside;
  for (std::size_t j = i < 2 ? 0 : i - 2; j <= i + 2 && j < values.size(); ++j)
    if (j != i) beside.push_back(values[j]);
  if (beside.size() < kFewestNeighbours || !in_order(beside)) return std::nullopt;
  const auto [least, most] = std::minmax(values[i - 1], values[i + 1]);
  const double gap = most - least, middle = least + gap / 2;
  if (values[i] >= least && values[i] <= most) return std::nullopt;
  const bool again = std::count(values.begin(), values.end(), values[i]) > 1;
  const double far = std::max(values[i] - most, least - values[i]) / gap;
  for (const double times : {0.1, 0.01, 0.001, 10.0, kPerMetre}) {
    // A value that is too small is never far from its neighbours: it needs an even division.
    const bool agrees = times < 1 ? far > kFarGaps : std::abs(values[i] * times - middle) <= kEven * gap;
    const double value = values[i] * times;
    if (!again && agrees && value > least && value < most)
      return MisplacedTarget{i, times, values[i - 1], values[i + 1]};
  }
  return std::nullopt;
}

/// The last target of an even division. Only a value that is too large: a smaller one can be a return.
std::optional<MisplacedTarget> misplaced_at_the_end(const std::vector<double>& values) {
  const std::size_t last = values.size() - 1;
  const double step = values[last - 1] - values[last - 2], expected = values[last - 1] + step;
  constexpr std::size_t kSteps = 3;  // of an even division
  for (std::size_t j = 0; j < kSteps; ++j)
    if (std::abs(values[last - 1 - j] - values[last - 2 - j] - step) > kEven * std::abs(step))
      return std::nullopt;
  if (std::abs(values[last] - expected) <= std::abs(step)) return std::nullopt;
  for (const double times : {0.1, 0.01, 0.001})
    if (step != 0 && expected != 0 && std::abs(values[last] * times - expected) <= kEven * std::abs(step))
      return MisplacedTarget{last, times, values[last - 1], values[last - 1]};
  return std::nullopt;
}

std::string multiple_text(double times) {
  return times < 1 ? fmt::format("1/{:.0f} of it", 1 / times) : fmt::format("{:.0f} times this value", times);
}

SizeDoubt target_doubt(const sheet::Sheet& sheet, const std::vector<TypedCell>& cells, std::size_t k,
                       const std::vector<MisplacedTarget>& found) {
  const MisplacedTarget& one = found.front();
  const std::size_t row = cells[one.index].row;
  const std::string beside = one.before == one.behind
                                 ? fmt::format("behind {:.6g}", one.before)
                                 : fmt::format("between {:.6g} and {:.6g}", one.before, one.behind);
  return {k, sheet.line[row], sheet.rows[row][k],
          fmt::format("this position{} is out of order {}, and {} is in order: {}; correct the cell",
                      found.size() > 1 ? fmt::format(" (and {} more)", found.size() - 1) : "", beside,
                      multiple_text(one.times),
                      one.times < 1 ? "a decimal sign is probably lost"
                                    : "the cell probably has another unit or a lost digit")};
}

/// Cells of positions in m: more decimals, smaller than all others, and in order if multiplied by 1000.
std::optional<SizeDoubt> metres_doubt(const sheet::Sheet& sheet, const std::vector<TypedCell>& cells,
                                      std::size_t k) {
  std::size_t fewest = cells.front().decimals;
  for (const TypedCell& one : cells)
    if (one.value != 0) fewest = std::min(fewest, one.decimals);
  std::vector<double> as_written, in_order;
  std::vector<const TypedCell*> small;
  double largest_small = 0, least_small = 0, least_other = 0, largest_other = 0;
  for (const TypedCell& one : cells) {
    const double size = std::abs(one.value);
    const bool is_small = one.value != 0 && one.decimals > fewest + 1;
    as_written.push_back(one.value);
    in_order.push_back(one.value * (is_small ? kPerMetre : 1));
    if (is_small) {
      least_small = small.empty() ? size : std::min(least_small, size);
      small.push_back(&one);
      largest_small = std::max(largest_small, size);
    } else if (one.value != 0) {
      least_other = least_other == 0 ? size : std::min(least_other, size);
      largest_other = std::max(largest_other, size);
    }
  }
  if (small.size() < 2 || least_other == 0 || largest_small >= least_other) return std::nullopt;
  std::vector<double> steps;
  for (std::size_t i = 1; i < in_order.size(); ++i)
    if (const double step = std::abs(in_order[i] - in_order[i - 1]); step > 0) steps.push_back(step);
  if (steps.size() < kFewestTargets) return std::nullopt;
  const double usual = maths::median(steps);
  const auto jump = [&](const std::vector<double>& list) {
    for (std::size_t i = 1; i < list.size(); ++i)
      if (std::abs(list[i] - list[i - 1]) > kLongStep * usual) return true;
    return false;
  };
  const auto even = [&](const std::vector<double>& list) {
    for (std::size_t i = 1; i < list.size(); ++i)
      if (std::abs(std::abs(list[i] - list[i - 1]) - usual) > kEven * usual) return false;
    return true;
  };
  const bool alone_even = even(in_order) && !even(as_written);
  if (jump(in_order) || (!jump(as_written) && !alone_even)) return std::nullopt;
  return SizeDoubt{
      k, sheet.line[small.front()->row], sheet.rows[small.front()->row][k],
      fmt::format("in this line and in {} more the positions have more decimals and are {:.6g} to {:.6g}, in "
                  "the other lines {:.6g} to {:.6g}; 1000 times their values continue the other positions: "
                  "the lines probably do not have the same unit (m and mm); write all cells of the column in "
                  "the unit of the heading",
                  small.size() - 1, least_small, largest_small, least_other, largest_other)};
}

/// A doubt of a column that the user stated becomes a note.
void add_doubt(sheet::Sheet& sheet, const sheet::SheetTable& table, const SizedColumn& column,
               SizeDoubt doubt, std::vector<SizeDoubt>& doubts) {
  const std::string& heading = table.headings[doubt.column].text;
  if (column.stated && !column.profile) {
    sheet.notes.push_back(fmt::format("line {}, \"{}\": {}", doubt.line, doubt.word, doubt.text));
    return;
  }
  doubt.text += fmt::format("; if all cells are right, give --{} \"{}[{}]={}\"",
                            column.use == SizedColumn::Use::kDeviation ? "deviation" : "column", column.name,
                            column.unit, heading);
  doubts.push_back(std::move(doubt));
}

/// The deviations of one run and approach direction, by their target.
using RunReadings = std::map<double, double>;

/// Columns that belong to a column of deviations; nullopt: the table does not have the column.
struct Beside {
  std::optional<std::size_t> run, sense, position;
};

std::map<std::string, RunReadings> readings_by_run(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                                   const Beside& beside, std::size_t k,
                                                   std::map<std::string, std::size_t>& first_row) {
  std::map<std::string, RunReadings> runs;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto at = sheet::number_at(sheet, row, *beside.position), value = sheet::number_at(sheet, row, k);
    if (!at || !value) continue;
    const std::string run = beside.run ? fmt::format("run {}", sheet.rows[row][*beside.run]) : "",
                      sense = beside.sense ? fmt::format("direction {}", sheet.rows[row][*beside.sense]) : "",
                      name = run + (run.empty() || sense.empty() ? "" : ", ") + sense;
    first_row.emplace(name, row);
    runs[name].emplace(*at, *value);
  }
  return runs;
}

/// The factor 10 or 100 that all readings of `large` are larger by than those of `small`; 0: none.
double factor_between(const RunReadings& small, const RunReadings& large) {
  double xx = 0, xy = 0, yy = 0;
  std::size_t common = 0;
  for (const auto& [at, x] : small) {
    const auto other = large.find(at);
    if (other == large.end()) continue;
    xx += x * x;
    xy += x * other->second;
    yy += other->second * other->second;
    ++common;
  }
  if (common < kFewestCommon || !(xx > 0) || !(yy > 0)) return 0;
  const double ratio = xy / xx, residual = std::sqrt(std::max(0.0, yy - ratio * xy) / yy);
  if (residual > kResidualShare) return 0;
  for (const double factor : {10.0, 100.0})
    if (ratio > factor / kRatioSpread && ratio < factor * kRatioSpread) return factor;
  return 0;
}

void note_run_of_other_scale(sheet::Sheet& sheet, const sheet::SheetTable& table,
                             const std::vector<SizedColumn>& columns, std::size_t k) {
  const std::string sense = format::entry_of(format::AxisQuantity::kSense).prefix + columns[k].name;
  Beside beside;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].use != SizedColumn::Use::kPosition) continue;
    if (columns[i].name == format::columns::kRun) beside.run = i;
    if (columns[i].name == sense) beside.sense = i;
    if (columns[i].name == columns[k].positions) beside.position = i;
  }
  if ((!beside.run && !beside.sense) || !beside.position) return;
  std::map<std::string, std::size_t> first_row;
  const auto runs = readings_by_run(sheet, table, beside, k, first_row);
  if (runs.size() > kMostScales) return;
  // The run that differs from most others has the wrong scale.
  std::map<std::string, std::size_t> apart;
  for (const auto& [name, large] : runs)
    for (const auto& [other, small] : runs)
      if (factor_between(small, large) != 0) ++apart[name], ++apart[other];
  for (const auto& [name, large] : runs)
    for (const auto& [other, small] : runs) {
      const double factor = factor_between(small, large);
      if (factor == 0) continue;
      const bool too_large = apart[name] >= apart[other];
      const std::string &wrong = too_large ? name : other, &usual = too_large ? other : name;
      const std::size_t row = first_row.at(wrong);
      sheet.notes.push_back(fmt::format(
          "line {}, \"{}\": the deviations of {} are about {} those of {} at all common positions: is a "
          "decimal sign lost, or is the unit another one? The values are read; if they are wrong, correct "
          "the "
          "cells of {}",
          sheet.line[row], sheet.rows[row][k], wrong,
          too_large ? fmt::format("{} times", factor) : fmt::format("1/{} of", factor), usual, wrong));
      return;
    }
}

/// Does a cell begin with 0 and another digit ("-07")?
bool begins_with_zero(const std::string& cell) {
  const auto first = cell.find_first_of("0123456789");
  return first != std::string::npos && first + 1 < cell.size() && cell[first] == '0' &&
         cell[first + 1] >= '0' && cell[first + 1] <= '9';
}

std::optional<SizeDoubt> lost_signs_doubt(const sheet::Sheet& sheet, const std::vector<TypedCell>& cells,
                                          std::size_t k) {
  std::size_t decimals = 0, changes = 0;
  for (const TypedCell& one : cells) decimals = std::max(decimals, one.decimals);
  if (decimals == 0) return std::nullopt;
  std::vector<std::size_t> without;
  double as_written = 0, with_signs = 0;  // sums of the steps between cells with and without a sign
  bool zero = false, padded = false;      // cells without and with a sign that begin with 0 and a digit
  const TypedCell* before = nullptr;
  const auto is_lost = [](const TypedCell& one) { return one.decimals == 0 && one.value != 0; };
  const double scale = std::pow(10, decimals);
  for (const TypedCell& one : cells) {
    if (one.value != 0 && one.decimals != 0 && one.decimals != decimals) return std::nullopt;
    if (is_lost(one)) {
      without.push_back(one.row);
      zero |= begins_with_zero(sheet.rows[one.row][k]);
    } else {
      padded |= begins_with_zero(sheet.rows[one.row][k]);
    }
    if (before != nullptr && is_lost(*before) != is_lost(one)) {
      ++changes;
      as_written += std::abs(one.value - before->value);
      with_signs +=
          std::abs(one.value / (is_lost(one) ? scale : 1) - before->value / (is_lost(*before) ? scale : 1));
    }
    before = &one;
  }
  if (without.empty() || cells.size() < without.size() + kFewestTyped) return std::nullopt;
  const bool many = without.size() >= kFewestTyped && changes >= kFewestChanges;
  if (!(zero && !padded) && !many) return std::nullopt;
  if (!(with_signs < (zero ? kSmootherWithZero : kSmoother) * as_written)) return std::nullopt;
  return SizeDoubt{
      k, sheet.line[without.front()], sheet.rows[without.front()][k],
      fmt::format("this cell and {} more of the column have no decimal sign, and 1/{:.0f} of their values "
                  "agrees with the cells before and behind them: the decimal signs are probably lost; write "
                  "the decimal sign into these cells",
                  without.size() - 1, scale)};
}

}  // namespace

std::vector<MisplacedTarget> misplaced_targets(const std::vector<double>& values) {
  std::vector<MisplacedTarget> found;
  if (values.size() < kFewestTargets) return found;
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    if (const auto one = misplaced_between(values, i)) found.push_back(*one);
  if (const auto one = misplaced_at_the_end(values)) found.push_back(*one);
  std::vector<double> corrected = values;
  for (const MisplacedTarget& one : found) corrected[one.index] *= one.times;
  if (kRowsPerTurn * turns_of(corrected) > values.size()) found.clear();
  return found;
}

std::vector<SizeDoubt> judge_targets(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                     const std::vector<SizedColumn>& columns) {
  std::vector<SizeDoubt> doubts;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto unit = sized_unit(columns[k]);
    if (columns[k].use != SizedColumn::Use::kPosition || !columns[k].axis || !unit) continue;
    const std::vector<TypedCell> cells = typed_cells_of(sheet, table, k);
    if (cells.size() < kFewestTargets) continue;
    std::vector<double> values;
    for (const TypedCell& one : cells) values.push_back(one.value);
    const std::vector<MisplacedTarget> found = misplaced_targets(values);
    const auto metres =
        unit->dimension == format::Dimension::kLength ? metres_doubt(sheet, cells, k) : std::nullopt;
    if (metres)
      add_doubt(sheet, table, columns[k], *metres, doubts);
    else if (!found.empty())
      add_doubt(sheet, table, columns[k], target_doubt(sheet, cells, k, found), doubts);
  }
  return doubts;
}

std::vector<SizeDoubt> judge_lost_signs(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                        const std::vector<SizedColumn>& columns) {
  std::vector<SizeDoubt> doubts;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SizedColumn::Use::kDeviation || !sized_unit(columns[k])) continue;
    if (auto doubt = lost_signs_doubt(sheet, typed_cells_of(sheet, table, k), k))
      add_doubt(sheet, table, columns[k], std::move(*doubt), doubts);
  }
  return doubts;
}

void note_other_scales(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SizedColumn>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SizedColumn::Use::kDeviation || !sized_unit(columns[k])) continue;
    note_run_of_other_scale(sheet, table, columns, k);
  }
}

}  // namespace vernier::importer
