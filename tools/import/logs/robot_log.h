// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/reading/sheet_import.h"
#include "tools/model/machine.h"

namespace vernier::importer {

/// The log of a robot that cannot be read without help: its joints have other names than the axes of the
/// machine, its joints or its point have no units, or it has no point.
struct RobotLog {
  /// A column and what it probably is. `unit`: empty if the heading states the unit.
  struct Column {
    std::size_t column = 0;
    std::string name, unit;
  };
  std::vector<Column> columns;      // the joints in the order of the axes, then the coordinates of the point
  std::vector<std::string> joints;  // words of the option --column for the joints that need an assignment
  std::vector<std::string> point;   // and for the point; empty: the table has no reading
  std::string missing;              // what the headings do not state
  std::string condition;            // what must be right if these columns are assigned
  std::optional<double> computed_mm;  // largest distance of the point from the nominal machine, if it is so
                                      // small that the control computed the point; otherwise no value
};

/// Returns the meaning of the columns of a robot's log, or `nullopt` for other tables: a log has a column for
/// each joint of the machine by its name, its number or its order, and either a point X, Y, Z without units
/// or no other numbers.
std::optional<RobotLog> robot_log(const model::Machine& machine, const SheetReading& reading);

/// Returns why the log is not read. `with_points`: how the log becomes the positions of the axes for the
/// points in another file. If the log has a point, the text ends with the condition of its assignment.
std::string why_not_read(const RobotLog& log, const std::string& with_points);

}  // namespace vernier::importer
