// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/positions.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/kinematics/inverse.h"
#include "tools/kinematics/rotations.h"
#include "tools/text/csv.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::offline {
namespace {

using Eigen::Index;

/// Decimals of the output: a tenth of a nanometre, a ten-millionth of a degree.
constexpr int kDigits = 7;

/// The columns of one file as numbers.
class PositionTable {
 public:
  PositionTable(const std::string& text, const std::string& file) : csv_(format::parse_csv(text, file)) {}

  const format::CsvFile& csv() const { return csv_; }
  std::optional<std::size_t> find(const std::string& name) const {
    for (std::size_t i = 0; i < csv_.columns.size(); ++i)
      if (csv_.columns[i].name == name) return i;
    return std::nullopt;
  }
  model::Column numbers(std::size_t column, format::Dimension dimension) const {
    const format::CsvColumn& head = csv_.columns[column];
    const format::Unit unit = *format::find_unit(head.unit);
    if (unit.dimension != dimension)
      throw text::InputError(
          {csv_.file, csv_.header_line}, head.name,
          std::string("this column needs a unit, for example ") + format::base_unit(dimension));
    model::Column result(static_cast<Index>(csv_.rows.size()));
    for (std::size_t row = 0; row < csv_.rows.size(); ++row) {
      const auto number = text::parse_number(csv_.rows[row][column]);
      if (!number)
        throw text::InputError({csv_.file, csv_.line[row]}, csv_.rows[row][column],
                               "not a number, in column " + head.name);
      result[static_cast<Index>(row)] = unit.factor * *number + unit.offset;
    }
    return result;
  }

 private:
  format::CsvFile csv_;
};

void read_column(const PositionTable& table, const std::string& name, format::Dimension dimension,
                 model::Column& target, double factor = 1) {
  if (const auto column = table.find(name)) target = factor * table.numbers(*column, dimension);
}

/// All known values of each row besides the positions: from `at` and from the columns.
model::States states_of(const PositionTable& table, const model::Machine& machine, const model::States& at) {
  const std::size_t rows = table.csv().rows.size();
  model::States states = model::select_states(at, std::vector<std::size_t>(rows, 0));
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const model::Axis& axis = machine.axes[i];
    using format::AxisQuantity;
    const auto read = [&](AxisQuantity quantity, model::Column& target) {
      read_column(table, format::axis_column(quantity, axis.name),
                  format::dimension_of(quantity, axis.rotary), target);
    };
    read(AxisQuantity::kPosition, states.axis[i]);
    read(AxisQuantity::kSpeed, states.velocity[i]);
    read(AxisQuantity::kAcceleration, states.acceleration[i]);
    read(AxisQuantity::kSense, states.direction[i]);
    read(AxisQuantity::kSince, states.since[i]);
  }
  namespace columns = format::columns;
  read_column(table, columns::kFeed, format::Dimension::kSpeed, states.feed, 60);
  read_column(table, columns::kCurvature, format::Dimension::kCurvature, states.curvature);
  read_column(table, columns::kTime, format::Dimension::kTime, states.time);
  for (std::size_t i = 0; i < machine.inputs.size(); ++i) {
    const model::Input& input = machine.inputs[i];
    const auto column = table.find(input.name);
    const auto unit = format::find_unit(input.unit);
    if (!column || !unit) continue;
    states.input[i] = (table.numbers(*column, unit->dimension) - unit->offset) / unit->factor;
  }
  return states;
}

model::Poses targets_of(const PositionTable& table, bool& with_direction) {
  model::Poses target;
  const std::size_t rows = table.csv().rows.size();
  target.position = Eigen::Matrix3Xd::Zero(3, static_cast<Index>(rows));
  target.rotation.assign(rows, Eigen::Matrix3d::Identity());
  const auto three = [&](const std::array<const char*, 3>& names, format::Dimension dimension) {
    Eigen::Matrix3Xd values(3, static_cast<Index>(rows));
    for (Index k = 0; k < 3; ++k) {
      const std::string name = names[static_cast<std::size_t>(k)];
      const auto column = table.find(name);
      if (!column)
        throw text::InputError({table.csv().file, table.csv().header_line}, name, "this column is missing");
      values.row(k) = table.numbers(*column, dimension).matrix().transpose();
    }
    return values;
  };
  target.position = three(format::columns::kPoint, format::Dimension::kLength);
  with_direction = table.find(format::columns::kRotation.front()) || table.find("i");
  if (!with_direction) return target;
  const bool vector = table.find(format::columns::kRotation.front()).has_value();
  const Eigen::Matrix3Xd turn = vector ? three(format::columns::kRotation, format::Dimension::kAngle)
                                       : three({"i", "j", "k"}, format::Dimension::kNone);
  for (std::size_t row = 0; row < rows; ++row) {
    const Eigen::Vector3d one = turn.col(static_cast<Index>(row));
    if (vector) {
      target.rotation[row] = kinematics::rotation_of(one);
      continue;
    }
    if (std::abs(one.norm() - 1) > 0.01)
      throw text::InputError({table.csv().file, table.csv().line[row]}, "i", "i, j, k must be a unit vector");
    target.rotation[row] =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), one).toRotationMatrix();
  }
  return target;
}

/// Axis positions at which the nominal chain has the tool at the targets.
model::States solved(const PositionTable& table, const model::Machine& machine, model::States states,
                     const Eigen::Isometry3d& place) {
  bool with_direction = false;
  model::Poses target = targets_of(table, with_direction);
  target.position = place * target.position;
  for (Eigen::Matrix3d& rotation : target.rotation) rotation = place.linear() * rotation;
  kinematics::InverseOptions options;
  options.match = with_direction ? kinematics::Match::kDirection : kinematics::Match::kPosition;
  if (!with_direction && !kinematics::linear_axes(machine).empty())
    options.axes = kinematics::linear_axes(machine);
  const model::Machine nominal = model::nominal_machine(machine);
  for (std::size_t row = 0; row < states.count; ++row) {
    const auto at = static_cast<Index>(row);
    const model::Poses one{target.position.col(at), {target.rotation[row]}};
    // From the position of the previous row: the nearest of several solutions.
    model::States start = model::select_states(states, {row > 0 ? row - 1 : row});
    constexpr int kRestarts = 48;  // as tolerance/placed_part.cpp
    const kinematics::InverseResult result =
        kinematics::solve_anywhere(nominal, one, start, options, kRestarts);
    if (!result.each[0].converged)
      throw text::LimitNotMet(fmt::format("{}:{}: the target cannot be reached: {}", table.csv().file,
                                          table.csv().line[row], kinematics::name_of(result.each[0].fault)));
    for (std::size_t i = 0; i < machine.axes.size(); ++i) states.axis[i][at] = result.states.axis[i][0];
  }
  return states;
}

}  // namespace

std::string corrected_positions(const std::string& text, const std::string& file, const model::States& at,
                                Corrector& corrector, const std::optional<Eigen::Isometry3d>& place) {
  refuse_done(text, file, corrector.back());
  const PositionTable table(text, file);
  const model::Machine& machine = corrector.machine();
  std::vector<std::optional<std::size_t>> column_of(machine.axes.size());
  std::size_t found = 0;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    column_of[i] = table.find(machine.axes[i].name);
    found += column_of[i] ? 1 : 0;
  }
  model::States states = states_of(table, machine, at);
  if (place && found > 0)
    throw text::InputError({file, table.csv().header_line}, "--place",
                           "this option requires targets x y z, not positions of axes");
  if (found == 0 && table.find(format::columns::kPoint.front()))
    states = solved(table, machine, states, place.value_or(Eigen::Isometry3d::Identity()));
  else
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      if (!column_of[i])
        throw text::InputError({file, table.csv().header_line}, machine.axes[i].name,
                               "the column of this axis is missing");
  const Eigen::MatrixXd commands = corrector.commands(states);
  corrector.count(states, commands, table.csv().line);

  const auto written = [&](std::size_t axis, std::size_t row) {
    double value = commands(static_cast<Index>(axis), static_cast<Index>(row));
    if (const auto column = column_of[axis]) {
      const format::Unit unit = *format::find_unit(table.csv().columns[*column].unit);
      value = (value - unit.offset) / unit.factor;
    }
    return fmt::format("{:.{}f}", value, kDigits);
  };
  const char *mark = corrector.back() ? kBackMark : kCorrectedMark,
             *undone = corrector.back() ? kCorrectedMark : kBackMark;
  std::string result = fmt::format("# {}: machine {}\n", mark, machine.name);
  std::istringstream lines(text);
  std::size_t row = 0, number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const bool head = number == table.csv().header_line;
    const bool data = row < table.csv().line.size() && number == table.csv().line[row];
    if (!head && !data) {
      if (line.find(undone) == std::string::npos) result += line + "\n";
      continue;
    }
    std::vector<std::string> cells;
    if (found == 0)
      for (std::size_t i = 0; i < machine.axes.size(); ++i)
        cells.push_back(head ? machine.axes[i].name + (machine.axes[i].rotary ? "[deg]" : "[mm]")
                             : written(i, row));
    std::vector<std::string> own = text::fields_of(line, {}, {file, number});
    if (data)
      for (std::size_t i = 0; i < machine.axes.size(); ++i)
        if (column_of[i]) own[*column_of[i]] = written(i, row);
    cells.insert(cells.end(), own.begin(), own.end());
    for (std::size_t i = 0; i < cells.size(); ++i) result += (i > 0 ? "," : "") + text::csv_cell(cells[i]);
    result += "\n";
    row += data ? 1 : 0;
  }
  return result;
}

}  // namespace vernier::offline
