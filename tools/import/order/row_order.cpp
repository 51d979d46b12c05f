// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/order/row_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

namespace vernier::importer {
namespace {

/// One step of a motion shows no order: the way back to the next line of points is one step.
constexpr std::size_t kFewestSteps = 2;

/// A row to which the axis moved, from the row before it.
struct Step {
  std::size_t line = 0;
  double position = 0;
  int motion = 0, direction = 0;
};

/// Steps in one direction, one after the other. Rows at the same position belong to the stretch and are no
/// steps.
using Stretch = std::vector<Step>;

struct Path {
  std::vector<Stretch> stretches;
  std::set<int> directions;
  bool others_move = false;
};

bool same_others(const sheet::Sheet& sheet, const std::vector<std::size_t>& others, std::size_t a,
                 std::size_t b) {
  return std::all_of(others.begin(), others.end(),
                     [&](std::size_t k) { return sheet.rows[a][k] == sheet.rows[b][k]; });
}

Path path_of(const sheet::Sheet& sheet, const RowOrder& order,
             const std::function<int(const std::string&)>& direction_of) {
  std::set<double> targets;
  for (std::size_t row = order.first_data; row < sheet.rows.size(); ++row)
    if (const auto at = sheet::number_at(sheet, row, order.position)) targets.insert(*at);
  Path path;
  std::optional<std::size_t> before;
  bool joined = false;  // false: the next step begins a stretch
  for (std::size_t row = order.first_data; row < sheet.rows.size(); ++row) {
    const auto here = sheet::number_at(sheet, row, order.position);
    if (sheet::is_blank(sheet.rows[row]) || !here) continue;
    const int direction = direction_of(sheet.rows[row][order.direction]);
    path.directions.insert(direction);
    if (before) {
      const double there = *sheet::number_at(sheet, *before, order.position);
      const bool same = same_others(sheet, order.others, *before, row);
      path.others_move |= !same;
      const auto a = targets.find(std::min(there, *here)), b = targets.find(std::max(there, *here));
      // A step over other targets is the way back to the begin of a run.
      const bool next = std::distance(a, b) <= 1;
      if (!same || !next) {
        joined = false;
      } else if (there != *here) {
        const Step step{sheet.line[row], *here, *here > there ? 1 : -1, direction};
        if (!joined || path.stretches.back().back().motion != step.motion) path.stretches.emplace_back();
        path.stretches.back().push_back(step);
        joined = true;
      }
    }
    before = row;
  }
  return path;
}

/// One direction in all rows: the rows of the stretches against it, if their positions occur on the other
/// way too.
std::vector<std::size_t> copied_rows(const Path& path, int direction) {
  std::set<double> with;
  for (const Stretch& stretch : path.stretches)
    if (stretch.front().motion == direction)
      for (const Step& step : stretch) with.insert(step.position);
  std::vector<std::size_t> lines;
  for (const Stretch& stretch : path.stretches) {
    if (stretch.front().motion == direction || stretch.size() < kFewestSteps) continue;
    const auto both = std::count_if(stretch.begin(), stretch.end(),
                                    [&](const Step& step) { return with.contains(step.position); });
    if (static_cast<std::size_t>(both) + 1 < stretch.size()) continue;
    for (const Step& step : stretch) lines.push_back(step.line);
  }
  return lines;
}

/// The rows of a stretch whose direction contradicts the motion, if they are at one end of the stretch and
/// the other rows agree.
std::vector<std::size_t> shifted_rows(const Stretch& stretch) {
  std::vector<std::size_t> against;
  std::size_t changes = 0;
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    if (stretch[i].direction == -stretch[i].motion) against.push_back(stretch[i].line);
    changes += i > 0 && stretch[i].direction != stretch[i - 1].direction ? 1 : 0;
  }
  const bool shifted =
      changes == 1 && against.size() >= kFewestSteps && stretch.size() - against.size() >= kFewestSteps;
  return shifted ? against : std::vector<std::size_t>{};
}

}  // namespace

DirectionDoubt doubt_of_directions(const sheet::Sheet& sheet, const RowOrder& order,
                                   const std::function<int(const std::string&)>& direction_of) {
  const Path path = path_of(sheet, order, direction_of);
  DirectionDoubt doubt;
  doubt.certain = !path.others_move;
  if (path.directions.contains(0)) return doubt;
  if (path.directions.size() == 1) {
    doubt.lines = copied_rows(path, *path.directions.begin());
    if (!doubt.lines.empty()) doubt.kind = DirectionDoubt::Kind::kSame;
    return doubt;
  }
  for (const Stretch& stretch : path.stretches)
    for (const std::size_t line : shifted_rows(stretch)) doubt.lines.push_back(line);
  if (!doubt.lines.empty()) doubt.kind = DirectionDoubt::Kind::kShifted;
  return doubt;
}

std::string lines_text(const std::vector<std::size_t>& lines) {
  constexpr std::size_t kMost = 6;  // lines that a reader compares at a glance
  std::string text = lines.size() == 1 ? "line " : "lines ";
  for (std::size_t i = 0; i < std::min(kMost, lines.size()); ++i)
    text += (i > 0 ? ", " : "") + std::to_string(lines[i]);
  return lines.size() > kMost ? fmt::format("{} and {} more", text, lines.size() - kMost) : text;
}

}  // namespace vernier::importer
