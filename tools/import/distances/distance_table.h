// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/import/distances/distance_columns.h"
#include "tools/import/distances/named_points.h"

namespace vernier::importer {

/// A table of distances between named points, as rows of a measurement file.
struct PointDistances {
  std::vector<std::string> points;   // names of the points of the table, in their order: A, B; P2, P10
  std::vector<std::string> missing;  // points without a position
  std::vector<MissingAxis> axes;     // axes whose positions a point needs
  text::Place place;                 // of the headings
  bool asks_positions = false;       // true: the table lacks nothing but the positions of the missing points
  ImportTable table;                 // a row for each point, then a row for each measured distance
  std::vector<std::string> notes;
  std::optional<text::InputError> refusal;  // why the table has no rows; no value: it has rows
};

/// Makes the rows of a measurement file from a table of distances: the commanded position of each point, then
/// for each measured distance (in mm, from the first to the second point of its pair) the position of the
/// second point, `distance`, and `from`, the name of the first point. Constants of the user (u, setup …) are
/// columns too. A nominal distance must agree with the distance of the stated points within
/// NamedPoints::tolerance_mm, a measured distance within a twentieth of it (1 mm at least): otherwise two
/// points are exchanged, or a unit is wrong. A column without a unit has the unit in which it agrees with the
/// stated points. `columns`: from distance_columns; `ask`: as there. The function throws nothing for a table
/// that cannot be read: PointDistances::refusal has the reason with file, line and word.
PointDistances distances_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, const PairSheet& pairs,
                            std::vector<SheetColumn>& columns, const SheetWishes& wishes,
                            const NamedPoints& named, const std::string& ask);

/// Returns the options that state the positions of points: --point "A=X,Y,Z" --point "B=X,Y,Z".
std::string options_of_points(const PointDistances& distances);

/// Returns the refusal of a table without the positions of its points. `remedy`: what to give, such as the
/// options of options_of_points.
text::InputError refusal_for_positions(const PointDistances& distances, const std::string& remedy);

}  // namespace vernier::importer
