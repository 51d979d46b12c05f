// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/import/logs/nominal_columns.h"
#include "tools/model/machine.h"

namespace vernier::importer {

/// Points of an instrument with the nominal axis positions of a separate list.
struct NominalTable {
  ImportTable table;
  ImportTable list;               // the positions of the axes of all rows of the list
  std::vector<std::size_t> rows;  // the row of the list for each row of the table
  std::string names;              // column of point names that joined both; empty: they have none
  bool by_distances = false;      // joined by the order and the distances: points were missing, without names
                                  // (false and no names: joined by row number)
  std::vector<std::size_t> unused_lines;  // lines of the list whose position has no point
  std::string note;                       // what was assumed about the list; empty: nothing
  std::optional<double> rms_mm;  // rms distance of the points from the nominal tool points, after the best
                                 // rigid motion; nullopt: too few points, or no x y z
};

/// Returns the tolerance of the points for with_nominal(), mm: 2; 5 for a machine whose axes all turn. The
/// errors of a robot before its calibration are a few mm.
double nominal_tolerance_mm(const model::Machine& machine);

/// Returns how the points were joined with the list: "joined by row number".
std::string joined_by(const NominalTable& table);

/// Adds the axis positions of a list to the points of an instrument. The list is a spreadsheet with a heading
/// and a unit for each axis of the machine ("Punkt;X [mm];Y [mm]"). If both have a column with the names of
/// the points, the rows are joined by name; of a name "A::Vol::P1" the last part is compared. Otherwise row n
/// belongs to point n; if there are fewer points than rows, order and distances show which rows have none.
/// `tolerance_mm`: permitted difference of a distance, machine against nominal machine, mm. The joints of a
/// robot may have their usual names (A1, J1, q1); without any unit they are in degrees if a value is more
/// than a turn in radians. Throws InputError with file, line and word for: missing axes or units (all of
/// them, with the assignment of the columns that probably are the axes), a name that is missing or occurs
/// twice in the list, missing points that the distances do not show, and a point that is farther than 3
/// tolerances from its nominal tool point after the best rigid motion (a list in another order, or points or
/// joints in another unit, which is then named).
NominalTable with_nominal(const ImportTable& points, const NominalList& nominal,
                          const model::Machine& machine, double tolerance_mm);

/// A named point of a list of nominal positions.
struct ListedPosition {
  std::string name;
  std::vector<double> values;  // one for each axis that was asked for, mm or deg
};

/// Returns the named points of a list of nominal positions (as above) with their positions of the axes `axes`
/// of the machine. Throws InputError with file, line and word for: missing axes or units, a cell that is not
/// a number, a name that occurs twice, a list without a column of names.
std::vector<ListedPosition> listed_positions(const NominalList& nominal, const model::Machine& machine,
                                             const std::vector<std::string>& axes);

}  // namespace vernier::importer
