// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/direction_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/format/columns.h"
#include "tools/import/order/motion_directions.h"

namespace vernier::lint {
namespace {

/// Runs of rows whose positions all go one way: those that agree with their direction, those that contradict
/// it, and the first row of the first run that does.
struct Runs {
  std::size_t agreeing = 0, against = 0, first = 0;
};

/// Two rows belong to one run of an axis: the same direction and label, and no other axis moved.
bool same_run(const std::vector<const LintColumn*>& others, std::size_t a, std::size_t b) {
  for (const LintColumn* const other : others)
    if (other->cell[a] != other->cell[b]) return false;
  return true;
}

Runs runs_of(const LintTable& table, const LintColumn& sense, const LintColumn& position,
             const std::vector<const LintColumn*>& others) {
  constexpr std::size_t kFewestSteps = 3;  // fewer steps occur by chance in poses without an order
  Runs runs;
  std::size_t begin = 0, steps = 0;
  int motion = 0;
  const auto close = [&](std::size_t next) {
    const double stated = sense.value[begin];
    if (steps >= kFewestSteps && motion != 0 && (stated == 1 || stated == -1)) {
      if (motion * stated < 0 && runs.against == 0) runs.first = begin;
      ++(motion * stated > 0 ? runs.agreeing : runs.against);
    }
    begin = next;
    steps = 0;
    motion = 0;
  };
  for (std::size_t row = 1; row < table.rows.size(); ++row) {
    const double step = position.value[row] - position.value[row - 1];
    const int way = step > 0 ? 1 : step < 0 ? -1 : 0;
    if (std::isnan(step) || !same_run(others, row - 1, row)) {
      close(row);
    } else if (way != 0) {
      if (motion != 0 && way != motion) close(row - 1);
      motion = way;
      ++steps;
    }
  }
  close(table.rows.size());
  return runs;
}

/// Number of poses that the rows reach with motions of `axis` in both directions. `axes`: all axes.
std::size_t poses_from_both_sides(const LintTable& table, const LintColumn& axis,
                                  const std::vector<const LintColumn*>& axes) {
  constexpr double kStill = 0.01;  // mm or deg: an axis stops to within some um
  const LintColumn* const run = table.find(format::columns::kRun);
  const std::vector<int> directions = importer::directions_of_last_motion(
      axis.value, run == nullptr ? std::vector<std::string>() : run->cell, kStill);
  std::map<std::vector<double>, std::set<int>> reached;
  for (std::size_t row = 1; row < table.rows.size(); ++row) {
    if (directions[row] == 0 || !(std::abs(axis.value[row] - axis.value[row - 1]) > kStill)) continue;
    std::vector<double> pose;
    for (const LintColumn* const one : axes) pose.push_back(std::round(one->value[row] / kStill));
    if (std::all_of(pose.begin(), pose.end(), [](double value) { return std::isfinite(value); }))
      reached[pose].insert(directions[row]);
  }
  return static_cast<std::size_t>(
      std::count_if(reached.begin(), reached.end(), [](const auto& one) { return one.second.size() > 1; }));
}

}  // namespace

void look_for_missing_directions(const LintTable& table, const LintNames& names, LintFindings& findings) {
  constexpr std::size_t kFewestPoses = 3;  // fewer are repeats of a start or of a check
  std::vector<const LintColumn*> axes;
  for (const LintColumn& column : table.columns)
    if (names.is_axis(column.name) && !column.label) axes.push_back(&column);
  for (const LintColumn* const axis : axes) {
    const std::string sense = format::axis_column(format::AxisQuantity::kSense, axis->name);
    if (table.find(sense) != nullptr) continue;
    const std::size_t poses = poses_from_both_sides(table, *axis, axes);
    if (poses < kFewestPoses) continue;
    findings.remark(
        table.header_line, axis->name,
        fmt::format(
            "by their order, the rows reach {} positions from both sides of {}, and the file has no {}: "
            "the model predicts no reversal error (backlash) for these rows",
            poses, axis->name, sense),
        fmt::format(
            "if the rows are in the order of the measurement, import the file again with the directions "
            "of the motion (option --directions from-order of vernier import), or add the column {}",
            sense));
  }
}

void look_at_directions(const LintTable& table, const LintColumn& sense, const LintNames& names,
                        LintFindings& findings) {
  const std::string axis = names.of_axis(sense.name)->axis;
  const LintColumn* const position = table.find(axis);
  if (position == nullptr || table.rows.empty()) return;
  std::vector<const LintColumn*> others = {&sense};
  for (const LintColumn& column : table.columns)
    if (column.name == format::columns::kRun || column.name == format::columns::kSetup ||
        (names.is_axis(column.name) && column.name != axis))
      others.push_back(&column);
  const Runs runs = runs_of(table, sense, *position, others);
  if (runs.agreeing > 0 || runs.against == 0) return;
  const bool up = sense.value[runs.first] > 0;
  findings.warn(table.rows[runs.first].line, sense.name,
                fmt::format("the directions contradict the order of the rows in all {} runs along {}: the "
                            "positions {} from row to row, and {} is {}",
                            runs.against, axis, up ? "decrease" : "increase", sense.name, up ? "1" : "-1"),
                fmt::format("are 1 and -1 exchanged in {}? If the rows are sorted, ignore this", sense.name));
}

}  // namespace vernier::lint
