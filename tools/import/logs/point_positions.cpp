// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/point_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "tools/format/units.h"
#include "tools/model/chain/chain.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

constexpr const char* kOption = "--point";

/// The constants of the user by their name, mm or deg.
std::map<std::string, double> constants_by_name(const std::vector<std::string>& words) {
  std::map<std::string, double> values;
  for (const std::string& one : words) {
    ColumnMap map;
    add_constant(map, one);
    const MappedColumn& column = map.columns.front();
    const auto unit = column.unit.empty() ? std::nullopt : format::find_unit(column.unit);
    const auto number = unit ? text::parse_number(constant_cell(column, true)) : std::nullopt;
    if (number) values[column.name] = *number * unit->factor;
  }
  return values;
}

std::vector<MissingAxis> axes_of(const model::Machine* machine) {
  std::vector<MissingAxis> axes;
  if (machine == nullptr) return NamedPoints().axes;
  for (const model::Axis& axis : machine->axes) axes.push_back({axis.name, axis.rotary});
  return axes;
}

/// The tool point of the nominal machine where its axes have these positions.
void place_points(NamedPoints& points, const std::map<std::string, double>& constants,
                  const model::Machine* machine) {
  const std::vector<MissingAxis> all = axes_of(machine);
  const auto position = [&](const NamedPoint& point, const std::string& axis) {
    if (const auto constant = constants.find(axis); constant != constants.end()) return constant->second;
    for (std::size_t a = 0; a < points.axes.size(); ++a)
      if (points.axes[a].name == axis) return point.values[a];
    return 0.0;
  };
  if (machine == nullptr) {
    for (NamedPoint& point : points.points)
      for (std::size_t a = 0; a < all.size(); ++a) point.at_mm[a] = position(point, all[a].name);
    return;
  }
  if (points.points.empty()) return;
  model::States states = model::make_states(points.points.size(), *machine);
  model::make_one_run(states, "points");
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t i = 0; i < points.points.size(); ++i)
      states.axis[a][static_cast<Eigen::Index>(i)] = position(points.points[i], all[a].name);
  const Eigen::Matrix3Xd at = model::forward(model::nominal_machine(*machine), states).position;
  for (std::size_t i = 0; i < points.points.size(); ++i)
    for (std::size_t k = 0; k < points.points[i].at_mm.size(); ++k)
      points.points[i].at_mm[k] = at(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i));
}

NamedPoint stated_point(const std::string& words, const std::vector<MissingAxis>& axes) {
  const std::size_t sign = words.rfind('=');
  const std::string form = fmt::format("NAME={} (mm or deg, in the order of the axes)", axis_names(axes));
  if (sign == std::string::npos || text::trimmed(words.substr(0, sign)).empty())
    throw text::InputError({}, kOption, fmt::format("\"{}\" has not the form {}", words, form));
  NamedPoint point;
  point.name = text::trimmed(words.substr(0, sign));
  const std::string list = words.substr(sign + 1);
  const bool semicolons = list.find(';') != std::string::npos;
  for (const std::string& part : text::parts_of(list, semicolons ? ';' : ',')) {
    const auto number = sheet::plain_number(part, semicolons && part.find(',') != std::string::npos);
    if (!number)
      throw text::InputError(
          {}, kOption,
          fmt::format("\"{}\": the position \"{}\" of the point {} is not a number; write the "
                      "point as {}",
                      words, part, point.name, form));
    point.values.push_back(*text::parse_number(*number));
  }
  if (point.values.size() != axes.size())
    throw text::InputError(
        {}, kOption,
        fmt::format(
            "\"{}\" has {} positions, and the point needs {}: {}; an axis that is at one position for "
            "all points can have it by --set \"{}=0\"",
            words, point.values.size(), axes.size(), form,
            axes.empty() ? "Z[mm]" : axes.back().name + (axes.back().rotary ? "[deg]" : "[mm]")));
  return point;
}

}  // namespace

NamedPoints stated_points(const std::vector<std::string>& words, const std::vector<std::string>& constants,
                          const model::Machine* machine) {
  NamedPoints points;
  points.axes.clear();
  const auto known = constants_by_name(constants);
  for (const MissingAxis& axis : axes_of(machine))
    if (!known.contains(axis.name)) points.axes.push_back(axis);
  for (const std::string& one : words) {
    NamedPoint point = stated_point(one, points.axes);
    for (const NamedPoint& other : points.points)
      if (other.name == point.name)
        throw text::InputError({}, kOption,
                               fmt::format("the point {} has two positions: omit one", point.name));
    points.points.push_back(std::move(point));
  }
  place_points(points, known, machine);
  return points;
}

void add_listed_points(NamedPoints& points, const std::vector<std::string>& constants,
                       const NominalList& nominal, const model::Machine& machine) {
  const auto known = constants_by_name(constants);
  std::vector<std::string> axes;
  for (const MissingAxis& axis : points.axes) axes.push_back(axis.name);
  for (ListedPosition& one : listed_positions(nominal, machine, axes)) {
    if (std::any_of(points.points.begin(), points.points.end(),
                    [&](const NamedPoint& point) { return point.name == one.name; }))
      continue;
    points.points.push_back({one.name, std::move(one.values), {}});
  }
  points.list = nominal.file;
  place_points(points, known, &machine);
}

}  // namespace vernier::importer
