// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tools/import/logs/axis_counting.h"
#include "tools/import/logs/open_axes.h"
#include "tools/import/reading/sheet_import.h"
#include "tools/model/machine.h"
#include "tools/text/error.h"

namespace vernier::importer {

/// A list of nominal positions, as the user gives it.
struct NominalList {
  std::string bytes, file;
  /// Assignments in the words of `import table --column`: "J1[deg]=A1". A joint that the list counts in the
  /// other direction or from another zero has a sign or an addend: "J3[deg]=-A3+90".
  std::vector<std::string> columns = {};
  std::string option = "--column";  // the option of these assignments, for refusals
  /// Returns the call of the user with these assignments, for a refusal. Empty: a refusal has the options
  /// alone.
  std::function<std::string(const std::vector<std::string>& columns)> call = {};
  /// Returns the call of the user with the points in another unit, for a refusal. Empty, or an empty text: a
  /// refusal names the unit alone.
  std::function<std::string(const std::string& unit)> call_in_unit = {};
};

/// The rows of a list of nominal positions, and the columns of the axes as far as they are clear.
struct ListedRows {
  SheetReading reading;
  std::vector<std::size_t> rows;                 // rows that are not blank
  std::string note;                              // what was assumed; empty: nothing
  OpenAxes open;                                 // axes whose column or unit the list does not state clearly
  std::map<std::string, AxisCounting> counting;  // of the axes that the user assigns with a sign or an addend

  const std::string& cell(std::size_t i, std::size_t column) const {
    return reading.sheet.rows[rows[i]][column];
  }
  text::Place place(std::size_t i) const { return {reading.sheet.file, reading.sheet.line[rows[i]]}; }
  text::Place heading() const { return {reading.sheet.file, reading.sheet.line[reading.table.heading_row]}; }
};

/// Reads a list. The joints of a robot may have their usual names (A1, J1, q1), as in the import of a table.
/// Joints of which no heading has a unit are in degrees if one of them must be, with a note: the distances of
/// the points show a mistake. `needed`: the axes whose positions the list must have.
ListedRows read_nominal_list(const NominalList& nominal, const model::Machine& machine,
                             const std::function<bool(const std::string& axis)>& needed);

/// Gives the open columns that were found the names and the units of the axes.
void assign_open_axes(ListedRows& list);

/// True if all open axes have a column, none of the columns has a unit, and one of the axes turns: the points
/// can show the unit.
bool asks_for_unit_of_angles(const ListedRows& list);

/// Returns the column of an axis. Throws InputError if no column is the axis, or if the column has no unit.
std::size_t column_of_axis(const ListedRows& list, const model::Axis& axis);

/// Returns the call that goes on with these assignments beside those of the user, or the options alone.
std::string way_on(const NominalList& nominal, const ListedRows& list, const std::vector<std::string>& words);

/// Throws InputError: all that is missing, and the call that goes on. `units`: what the points say about the
/// unit of the joints; may be empty.
[[noreturn]] void refuse_open_axes(const NominalList& nominal, const ListedRows& list,
                                   const model::Machine& machine, const std::string& units);

}  // namespace vernier::importer
