// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"

namespace vernier::importer {

/// Columns of a list of points that are probably the measured point.
struct PointColumns {
  std::vector<std::string> words;  // of the option --column: "Name=point", "1=x[mm]"; empty: there are none
  bool decimal_comma = false;      // true: the numbers have a decimal comma
  bool by_order = false;           // true: by the order of the columns; false: the headings are X, Y and Z
};

/// Returns the columns of the point and of its name: the columns with the headings X, Y and Z, otherwise the
/// first three columns of numbers, without a first column that counts the rows. A heading without a unit is
/// in mm. Throws InputError as parse_delimited().
PointColumns point_columns(const std::string& text, const std::string& file, const DelimitedFormat& format);

/// Returns the map with the assignments of `columns`.
ColumnMap with_point_columns(ColumnMap map, const PointColumns& columns);

/// A list of points of which only a part is read: not all of x, y and z have a column, and other columns of
/// numbers have no meaning.
struct UnreadCoordinates {
  std::vector<std::string> missing;  // of x, y and z
  std::vector<std::string> columns;  // headings, or numbers, of the columns that no entry of the map reads,
                                     // or that keep the name of their heading
};

/// Returns what a map does not read of a list of points. Empty lists: nothing is missing, or the map reads
/// more than points and words (positions, uncertainties), or fewer columns of numbers remain than coordinates
/// are missing.
UnreadCoordinates unread_coordinates(const std::string& text, const std::string& file, const ColumnMap& map);

}  // namespace vernier::importer
