// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/machine_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/model/artefact.h"
#include "tools/model/expression.h"
#include "tools/model/measurement_names.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::create {
namespace {

/// No direction is given and the name has none; an axis of a robot needs no direction.
constexpr char kNoDirection = '?';

char direction_in(const std::string& name) {
  switch (name.front()) {
    case 'X':
    case 'U':
      return 'X';
    case 'Y':
    case 'V':
      return 'Y';
    case 'Z':
    case 'W':
      return 'Z';
    case 'A':
    case 'B':
    case 'C':
      return name.front();
    default:
      return kNoDirection;
  }
}

double end_of(const std::string& text, const std::string& words) {
  const auto number = text::parse_number(text);
  if (number) return *number;
  const bool comma = text.find(',') != std::string::npos;
  throw text::InputError("--axis " + words + ": \"" + text + "\": not a number" +
                         (comma ? "; a decimal sign is a point" : ""));
}

void check_name(const std::string& name) {
  if (!text::is_name(name))
    throw text::InputError(
        fmt::format("\"{}\": a name is letters, digits and _, and begins with a letter or _", name));
  if (model::is_reserved_word(name) || model::is_no_axis_name({}, name))
    throw text::InputError(fmt::format(
        "\"{}\": the file formats reserve this name; use an axis name such as X, Y, B or J1", name));
}

void check_names(const std::vector<PlannedAxis>& axes) {
  std::set<std::string> seen;
  model::Machine machine;
  for (const PlannedAxis& axis : axes) {
    if (!seen.insert(axis.name).second)
      throw text::InputError(fmt::format("\"{}\": this axis is given twice; give each axis once", axis.name));
    machine.axes.emplace_back().name = axis.name;
  }
  for (const PlannedAxis& axis : axes)
    if (model::is_no_axis_name(machine, axis.name))
      throw text::InputError("\"" + axis.name + "\": " + model::kMeasuredName);
}

const MachineType& type_of(const std::string& name) {
  std::string known;
  for (const MachineType& type : machine_types()) {
    if (name == type.name) return type;
    known += (known.empty() ? "" : " ") + std::string(type.name);
  }
  if (name == "delta" || name == "hexapod" || name == "parallel")
    throw text::InputError(
        fmt::format("\"{}\": a machine file describes one open chain from the bed to the tool; a parallel "
                    "machine has closed loops, which a machine file cannot describe",
                    name));
  throw text::InputError(
      fmt::format("\"{}\": this type of machine is unknown; known types are {}", name, known));
}

std::vector<std::size_t> by_names(const std::vector<PlannedAxis>& axes,
                                  const std::vector<std::string>& names) {
  std::vector<std::size_t> side;
  for (const std::string& name : names) {
    if (name.empty()) continue;
    const auto found =
        std::find_if(axes.begin(), axes.end(), [&](const auto& axis) { return axis.name == name; });
    if (found == axes.end())
      throw text::InputError(fmt::format("\"{}\": no option --axis declares an axis of this name", name));
    side.push_back(static_cast<std::size_t>(found - axes.begin()));
  }
  return side;
}

/// Axes by their directions, in the order that `directions` names them.
std::vector<std::size_t> by_directions(const std::vector<PlannedAxis>& axes, const std::string& directions) {
  std::vector<std::size_t> side;
  for (const char direction : directions)
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (axes[i].direction == direction) side.push_back(i);
  return side;
}

/// A machine with one rotary axis each on head and table: the axis of the table is C, else the last one.
void share_rotaries(MachinePlan& plan) {
  std::vector<std::size_t> rotary;
  for (std::size_t i = 0; i < plan.axes.size(); ++i)
    if (plan.axes[i].rotary()) rotary.push_back(i);
  if (rotary.empty()) return;
  std::size_t table = rotary.back();
  for (const std::size_t i : rotary)
    if (plan.axes[i].direction == 'C') table = i;
  for (const std::size_t i : rotary) (i == table ? plan.work_side : plan.tool_side).push_back(i);
}

bool holds(const std::vector<std::size_t>& side, std::size_t axis) {
  return std::find(side.begin(), side.end(), axis) != side.end();
}

void place_all(MachinePlan& plan, bool tool_given, bool work_given) {
  for (std::size_t i = 0; i < plan.axes.size(); ++i) {
    const bool tool = holds(plan.tool_side, i), work = holds(plan.work_side, i);
    if (tool && work)
      throw text::InputError(fmt::format(
          "\"{}\": this axis is both on the tool side and on the workpiece side", plan.axes[i].name));
    if (tool || work) continue;
    if (tool_given && work_given)
      throw text::InputError(
          fmt::format("\"{}\": neither --tool-side nor --work-side has this axis", plan.axes[i].name));
    // Axes that are not assigned to one side belong to the other. A rotary axis that a type does not know is
    // a table.
    (work_given ? plan.tool_side : plan.work_side).push_back(i);
  }
  for (const auto* side : {&plan.tool_side, &plan.work_side})
    for (std::size_t k = 0; k < side->size(); ++k)
      if (std::count(side->begin(), side->end(), (*side)[k]) > 1)
        throw text::InputError(
            fmt::format("\"{}\": this axis is given twice on the same side", plan.axes[(*side)[k]].name));
}

}  // namespace

const std::vector<MachineType>& machine_types() {
  static const std::vector<MachineType> kTypes = {
      {"gantry",
       "Gantry: the workpiece does not move, and a beam moves above it",
       "YXZ",
       "",
       {"carriage", "beam", "ram"}},
      {"bridge",
       "Moving bridge: the workpiece does not move, and a bridge moves above it",
       "YXZ",
       "",
       {"carriage", "bridge", "ram"}},
      {"column",
       "Column machine: table on a saddle, the column carries the spindle",
       "Z",
       "YX",
       {"table", "saddle", "column"}},
      {"c-frame",
       "C-frame: table on a saddle, the head slides on the column",
       "Z",
       "YX",
       {"table", "saddle", "head"}},
      {"head-head", "Five axes, both rotary axes in the head", "YXZCAB", "", {"carriage", "beam", "ram"}},
      {"head-table",
       "Five axes, one rotary axis in the head and one rotary axis under the workpiece",
       "XZ",
       "Y",
       {"carriage", "table slide", "ram"}},
      {"table-table",
       "Five axes, both rotary axes under the workpiece",
       "YXZ",
       "ABC",
       {"carriage", "beam", "ram"}},
      {"arm",
       "Horizontal arm: a column moves along the plate, and a carriage on the column carries the arm",
       "XZY",
       "",
       {"column", "arm", "carriage"}},
      {"robot", "Robot: one row of Denavit and Hartenberg for each joint", "", "", {"", "", ""}},
  };
  return kTypes;
}

PlannedAxis parse_planned_axis(const std::string& words) {
  const std::vector<std::string> parts = text::parts_of(words, ':');
  if (parts.size() < 3 || parts[0].empty())
    throw text::InputError(
        fmt::format("--axis {}: an axis is NAME:MIN:MAX, in mm or deg, such as X:0:600 or B:-90:90", words));
  PlannedAxis axis;
  axis.name = parts[0];
  check_name(axis.name);
  axis.min = end_of(parts[1], words);
  axis.max = end_of(parts[2], words);
  if (axis.min >= axis.max)
    throw text::InputError(fmt::format("--axis {}: MAX must be greater than MIN", words));
  axis.direction = direction_in(axis.name);
  for (std::size_t i = 3; i < parts.size(); ++i) {
    if (parts[i] == "wrap")
      axis.rollover = true;
    else if (parts[i].size() == 1 && std::string("XYZABC").find(parts[i]) != std::string::npos)
      axis.direction = parts[i].front();
    else
      throw text::InputError(
          fmt::format("--axis {}: \"{}\": must be X, Y, Z (motion along X, Y, Z), A, B, C (rotation about X, "
                      "Y, Z), or the word wrap (a rotary axis of one turn)",
                      words, parts[i]));
  }
  if (axis.rollover && !axis.rotary())
    throw text::InputError(fmt::format("--axis {}: only a rotary axis can wrap", words));
  if (axis.rollover && std::abs(axis.max - axis.min - 360) > 1e-9)
    throw text::InputError(
        fmt::format("--axis {}: an axis that wraps has a range of one turn, 360 deg", words));
  return axis;
}

PlannedAxis& plan_stations(std::vector<PlannedAxis>& axes, const std::string& words) {
  constexpr std::size_t kMost = 2000;  // stations: a table of a longer travel needs another model
  const auto refuse = [&](const std::string& why) {
    throw text::InputError(fmt::format(
        "--stations {}: {}; give NAME=STEP or NAME=POSITION,POSITION,..., such as X=25 or X=0,50,600", words,
        why));
  };
  const auto equals = words.find('=');
  if (equals == std::string::npos) refuse("the sign = is missing");
  const std::string name = words.substr(0, equals);
  const auto axis =
      std::find_if(axes.begin(), axes.end(), [&](const PlannedAxis& one) { return one.name == name; });
  if (axis == axes.end()) refuse(fmt::format("the machine has no axis {}", name));
  std::vector<double> numbers;
  for (const std::string& part : text::parts_of(words.substr(equals + 1), ',')) {
    const auto number = text::parse_number(part);
    if (!number) refuse(fmt::format("\"{}\" is not a number", part));
    numbers.push_back(*number);
  }
  std::vector<double> stations = {axis->min};
  const auto add = [&](double at) {
    if (at > stations.back() + 1e-6 && at < axis->max - 1e-6) stations.push_back(std::round(at * 1e6) / 1e6);
  };
  if (numbers.size() == 1) {
    const double step = numbers.front(), travel = axis->max - axis->min;
    if (!(step > 0)) refuse("a step is greater than 0");
    if (travel / step > kMost) refuse(fmt::format("a table has at most {} stations", kMost));
    // Multiples of the step; a last part below a third of it joins its neighbour, as in round_stations.
    for (double at = std::ceil(axis->min / step + 0.35) * step; at < axis->max - 0.35 * step; at += step)
      add(at);
  } else {
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (k > 0 && numbers[k] <= numbers[k - 1]) refuse("the positions must increase");
      if (numbers[k] < axis->min - 1e-6 || numbers[k] > axis->max + 1e-6)
        refuse(fmt::format("{} is outside the travel {} to {}", text::number_text(numbers[k]),
                           text::number_text(axis->min), text::number_text(axis->max)));
      add(numbers[k]);
    }
    if (numbers.size() > kMost) refuse(fmt::format("a table has at most {} stations", kMost));
  }
  stations.push_back(axis->max);
  axis->stations = std::move(stations);
  return *axis;
}

std::vector<double> stations_of(const PlannedAxis& axis) {
  return axis.stations.empty() ? round_stations(axis.min, axis.max, axis.rotary()) : axis.stations;
}

PlannedArtefact parse_planned_artefact(const std::string& words) {
  const auto colon = words.rfind(':');
  if (colon == std::string::npos || colon == 0 || !model::artefact_type_named(words.substr(colon + 1)))
    throw text::InputError(
        "--artefact " + words +
        ": NAME:TYPE with the type point, line, plane, sphere or cylinder, such as bed:plane");
  return {words.substr(0, colon), words.substr(colon + 1)};
}

MachinePlan plan_machine(const std::string& type_name, std::vector<PlannedAxis> axes,
                         const std::optional<std::vector<std::string>>& tool_order,
                         const std::optional<std::vector<std::string>>& work_order) {
  const MachineType& type = type_of(type_name);
  if (axes.empty())
    throw text::InputError(
        "no axis is given: give --axis NAME:MIN:MAX for each axis, for example --axis X:0:600");
  check_names(axes);
  for (const PlannedAxis& axis : axes)
    if (axis.direction == kNoDirection)
      throw text::InputError(
          fmt::format("\"{}\": the direction of this axis is missing; add it, for example {}:MIN:MAX:X (X Y "
                      "Z along it, A B C about X Y Z)",
                      axis.name, axis.name));
  MachinePlan plan;
  plan.type = plan.name = type.name;
  plan.axes = std::move(axes);
  if (tool_order) plan.tool_side = by_names(plan.axes, *tool_order);
  if (work_order) plan.work_side = by_names(plan.axes, *work_order);
  if (!tool_order && !work_order) {
    plan.tool_side = by_directions(plan.axes, type.tool_side);
    plan.work_side = by_directions(plan.axes, type.work_side);
    if (type_name == "head-table") share_rotaries(plan);
  }
  place_all(plan, tool_order.has_value(), work_order.has_value());
  return plan;
}

MachinePlan plan_robot(std::vector<PlannedAxis> axes, const std::vector<DhRow>& rows) {
  if (axes.empty())
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool slides = rows[i].prismatic;
      axes.push_back(
          {"J" + std::to_string(i + 1), slides ? 0.0 : -180.0, slides ? 500.0 : 180.0, 'C', false, {}});
    }
  check_names(axes);
  if (axes.size() != rows.size())
    throw text::InputError(
        fmt::format("{} axes, but {} rows of the arm: give a row of Denavit and Hartenberg for each joint "
                    "(--dh FILE, or --joint theta,d,a,alpha for each)",
                    axes.size(), rows.size()));
  MachinePlan plan;
  plan.type = plan.name = "robot";
  plan.arm = rows;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].direction = rows[i].prismatic ? 'Z' : 'C';
    plan.tool_side.push_back(i);
  }
  plan.axes = std::move(axes);
  return plan;
}

std::vector<double> round_stations(double min, double max, bool rotary) {
  constexpr double kMostParts = 7;  // of a range, at most: eight stations to begin with
  static const std::vector<double> kTurns = {0.5, 1, 2, 5, 10, 15, 30, 45, 60, 90, 180, 360};
  double step = 0;
  if (rotary) {
    for (const double turn : kTurns)
      if (step == 0 && (max - min) / turn <= 1.3 * kMostParts) step = turn;
  }
  // 1, 2, 2.5, 5 times a power of ten: the first that leaves few enough parts.
  for (double decade = 1e-6; step == 0; decade *= 10)
    for (const double lead : {1.0, 2.0, 2.5, 5.0})
      if (step == 0 && (max - min) / (lead * decade) <= kMostParts) step = lead * decade;
  std::vector<double> stations = {min};
  // A short last part would be measured by too few readings: it joins its neighbour.
  for (double at = std::ceil(min / step + 0.35) * step; at < max - 0.35 * step; at += step)
    stations.push_back(std::round(at * 1e6) / 1e6);
  stations.push_back(max);
  return stations;
}

}  // namespace vernier::create
