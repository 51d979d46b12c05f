// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/odd_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tools/format/columns.h"
#include "tools/import/order/motion_directions.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"

namespace vernier::importer {
namespace {

constexpr std::size_t kFewestPlaces = 8;        // fewer places agree by chance
constexpr std::size_t kFewestTargetsOfRun = 5;  // fewer targets show no pattern
constexpr std::size_t kMostComparedRuns = 200;  // more runs are labels of the rows
/// Share of the readings that the comparison with the opposite sign leaves: unrelated runs leave 1.
constexpr double kResidualOfRun = 0.3;
/// The size of both runs agrees within this factor: the scatter of readings is below a fifth of their size.
constexpr double kSpreadOfRatios = 1.25;

enum class Relation { kUnclear, kSame, kOpposite };

Relation relation_of(const RunDeviations& one, const RunDeviations& other) {
  double xx = 0, xy = 0, yy = 0;
  std::size_t common = 0;
  for (const auto& [place, x] : one) {
    const auto found = other.find(place);
    if (found == other.end()) continue;
    const double y = found->second;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    ++common;
  }
  if (common < kFewestPlaces || !(xx > 0) || !(yy > 0)) return Relation::kUnclear;
  const double ratio = xy / xx, residual = std::sqrt(std::max(0.0, yy - ratio * xy) / yy);
  if (residual > kResidualOfRun || std::abs(ratio) > kSpreadOfRatios || std::abs(ratio) < 1 / kSpreadOfRatios)
    return Relation::kUnclear;
  return ratio > 0 ? Relation::kSame : Relation::kOpposite;
}

/// Columns that belong to the positions of one axis; nullopt: the table does not have the column.
struct BesideInRun {
  std::optional<std::size_t> run, sense, position;
};

BesideInRun beside_of(const std::vector<SizedColumn>& columns, const std::string& axis,
                      const std::string& positions) {
  const std::string sense = format::entry_of(format::AxisQuantity::kSense).prefix + axis;
  BesideInRun beside;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].use != SizedColumn::Use::kPosition) continue;
    if (columns[i].name == format::columns::kRun) beside.run = i;
    if (columns[i].name == sense) beside.sense = i;
    if (columns[i].name == positions) beside.position = i;
  }
  return beside;
}

void note_opposite_run(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SizedColumn>& columns, std::size_t k) {
  const BesideInRun beside = beside_of(columns, columns[k].name, columns[k].positions);
  if (!beside.run || !beside.position) return;
  std::map<std::string, RunDeviations> runs;
  std::map<std::string, std::size_t> first_row;
  std::vector<double> positions, values;
  std::vector<std::string> names;
  std::vector<int> stated;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto at = sheet::number_at(sheet, row, *beside.position), value = sheet::number_at(sheet, row, k);
    if (!at || !value) continue;
    positions.push_back(*at);
    values.push_back(*value);
    names.push_back(sheet.rows[row][*beside.run]);
    if (beside.sense) stated.push_back(sense_said(sheet.rows[row][*beside.sense]));
    first_row.emplace(names.back(), row);
  }
  const std::vector<int> direction = beside.sense ? stated : directions_by_motion(positions, names);
  for (std::size_t i = 0; i < values.size(); ++i)
    runs[names[i]].emplace(std::pair{positions[i], direction[i]}, values[i]);
  const auto found = opposite_run(runs);
  if (!found) return;
  const std::size_t row = first_row.at(found->first);
  sheet.notes.push_back(fmt::format("line {}, \"{}\": {}", sheet.line[row], sheet.rows[row][k],
                                    opposite_run_text("run " + found->first, "run " + found->second)));
}

/// The targets of one run and direction, in ascending order.
using Targets = std::vector<double>;

/// The only target of `a` that `b` does not have; nullopt: none, or more.
std::optional<double> only_in(const Targets& a, const Targets& b) {
  Targets rest;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
  return rest.size() == 1 ? std::optional(rest.front()) : std::nullopt;
}

void note_odd_target(sheet::Sheet& sheet, const sheet::SheetTable& table,
                     const std::vector<SizedColumn>& columns, std::size_t k) {
  const BesideInRun beside = beside_of(columns, columns[k].name, columns[k].name);
  if (!beside.run) return;
  std::map<std::string, Targets> groups;
  std::map<std::string, std::map<double, std::size_t>> rows;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto at = sheet::number_at(sheet, row, k);
    if (!at) continue;
    const std::string name =
        sheet.rows[row][*beside.run] + (beside.sense ? ", " + sheet.rows[row][*beside.sense] : "");
    groups[name].push_back(*at);
    rows[name].emplace(*at, row);
  }
  constexpr std::size_t kFewestGroups = 3;  // of two, each may be the odd one
  if (groups.size() < kFewestGroups || groups.size() > kMostComparedRuns) return;
  std::map<Targets, std::vector<std::string>> same;
  for (auto& [name, targets] : groups) {
    std::sort(targets.begin(), targets.end());
    same[targets].push_back(name);
  }
  if (same.size() != 2) return;
  const auto usual = same.begin()->second.size() > 1 ? same.begin() : std::next(same.begin());
  const auto odd = usual == same.begin() ? std::next(usual) : same.begin();
  if (odd->second.size() != 1 || usual->first.size() < kFewestTargetsOfRun) return;
  const auto target = only_in(odd->first, usual->first), missing = only_in(usual->first, odd->first);
  if (!target || !missing || odd->first.size() != usual->first.size()) return;
  const std::size_t row = rows.at(odd->second.front()).at(*target);
  sheet.notes.push_back(fmt::format(
      "line {}, \"{}\": no other run has this target of {}, and all other runs have {:.6g}, which "
      "this run does not have: is the target mistyped? The value is read; if it is wrong, correct "
      "the cell",
      sheet.line[row], sheet.rows[row][k], columns[k].name, *missing));
}

/// Notes a run of which every deviation is exactly 0, beside runs that have other values.
void note_zero_run(sheet::Sheet& sheet, const sheet::SheetTable& table,
                   const std::vector<SizedColumn>& columns, std::size_t k) {
  const BesideInRun beside = beside_of(columns, columns[k].name, columns[k].positions);
  if (!beside.run) return;
  struct Run {
    std::size_t readings = 0, zeros = 0, row = 0;
  };
  std::map<std::string, Run> runs;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, k);
    if (!value) continue;
    Run& run = runs.try_emplace(sheet.rows[row][*beside.run], Run{0, 0, row}).first->second;
    ++run.readings;
    run.zeros += *value == 0 ? 1 : 0;
  }
  const bool others = std::any_of(runs.begin(), runs.end(),
                                  [](const auto& one) { return 2 * one.second.zeros < one.second.readings; });
  if (!others || runs.size() > kMostComparedRuns) return;
  for (const auto& [name, run] : runs)
    if (run.readings >= kFewestTargetsOfRun && run.zeros == run.readings)
      sheet.notes.push_back(fmt::format(
          "line {}: all {} deviations of run {} are 0, and those of other runs are not: was this run not "
          "measured? The values are read; if they are wrong, delete them",
          sheet.line[run.row], run.readings, name));
}

/// Notes a line of the file with the same position and the same readings of three runs or more as a line
/// before it.
void note_repeated_line(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  constexpr std::size_t kFewestReadings = 3;              // fewer readings are equal by chance
  std::map<std::size_t, std::vector<std::string>> cells;  // of each line of the file
  std::map<std::size_t, std::size_t> readings;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    std::vector<std::string>& all = cells[sheet.line[row]];
    all.insert(all.end(), sheet.rows[row].begin(), sheet.rows[row].end());
    ++readings[sheet.line[row]];
  }
  std::map<std::vector<std::string>, std::size_t> first;
  for (const auto& [line, all] : cells) {
    const auto [place, is_new] = first.emplace(all, line);
    if (is_new || readings[line] < kFewestReadings) continue;
    sheet.notes.push_back(fmt::format(
        "line {}: the position and all {} readings are those of line {}: is the line a copy? The values are "
        "read; if the line is a copy, delete it",
        line, readings[line], place->second));
  }
}

}  // namespace

std::optional<std::pair<std::string, std::string>> opposite_run(
    const std::map<std::string, RunDeviations>& runs) {
  if (runs.size() < 2 || runs.size() > kMostComparedRuns) return std::nullopt;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    std::size_t opposite = 0, others = 0;
    std::string other;
    for (const auto& [name, deviations] : runs) {
      if (name == run->first) continue;
      ++others;
      if (relation_of(deviations, run->second) != Relation::kOpposite) continue;
      ++opposite;
      if (other.empty()) other = name;
    }
    if (opposite == others) return std::pair{run->first, other};
  }
  return std::nullopt;
}

std::string opposite_run_text(const std::string& run, const std::string& other) {
  return fmt::format(
      "the deviations of {0} have the sizes of those of {1} at all common positions, and the opposite sign: "
      "is the sign of {0} reversed (nominal - actual)? The values are read; if they are wrong, correct the "
      "signs of one of the two runs",
      run, other);
}

void note_odd_runs(sheet::Sheet& sheet, const sheet::SheetTable& table,
                   const std::vector<SizedColumn>& columns) {
  note_repeated_line(sheet, table);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (!sized_unit(columns[k])) continue;
    if (columns[k].use == SizedColumn::Use::kDeviation) {
      note_opposite_run(sheet, table, columns, k);
      note_zero_run(sheet, table, columns, k);
    } else if (columns[k].use == SizedColumn::Use::kPosition && columns[k].axis) {
      note_odd_target(sheet, table, columns, k);
    }
  }
}

}  // namespace vernier::importer
