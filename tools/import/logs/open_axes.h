// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/import/reading/sheet_import.h"
#include "tools/import/words/joint_names.h"
#include "tools/model/machine.h"

namespace vernier::importer {

/// The axes of a machine without a column in a table, the columns of numbers that have no other meaning, and
/// which of them are these axes.
struct OpenAxes {
  std::vector<MissingAxis> axes;
  std::vector<FreeColumn> columns;
  std::vector<std::size_t> at;  // of each of `columns`, the index in the table
  JointColumns found;

  /// True if each of the axes has a column.
  bool complete() const { return found.pairs.size() == axes.size(); }
  /// Headings of the columns that were found.
  std::vector<std::string> headings() const;
  /// Words of the option --column for the columns that were found.
  std::vector<std::string> words() const;
};

/// Returns the axes for which no column has their name and no constant is their position.
OpenAxes open_axes(const model::Machine& machine, const SheetReading& reading);

/// The same for a table whose headings may have no units. An axis whose column has its name, but no unit, is
/// open too, and is found by its name. Joints without units have the unit rad in FreeColumn::assumed if no
/// value is more than a turn and not all values are whole numbers, otherwise deg. `sure` states that the
/// names or the numbers agree; the units remain an assumption.
OpenAxes open_axes_without_units(const model::Machine& machine, const SheetReading& reading);

/// True if a value of these columns is more than a turn in rad: such joints without a unit are in degrees.
bool exceeds_a_turn(const SheetReading& reading, const std::vector<std::size_t>& columns);

/// True if the values of these columns can be angles in rad: none is more than a turn, and not all are whole
/// numbers.
bool may_be_radians(const SheetReading& reading, const std::vector<std::size_t>& columns);

}  // namespace vernier::importer
