// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of a sheet that are distances between two named points.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/distances/pair_names.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// The pairs of points of a sheet. The cell of a pair has the number of its row (1, 2 …) in place of the
/// names, so that the row is a row of numbers as in any other table.
struct PairSheet {
  std::size_t column = 0;                    // column of the numbers
  std::optional<std::size_t> second;         // column of the second points, emptied; no value: no such column
  std::vector<PointPair> pairs;              // pair of the row with the number n: pairs[n - 1]
  std::map<std::size_t, std::string> units;  // unit of the columns whose cells have it: "310,73 mm"
};

/// Returns the text with lines such as "AC = 310.73 mm" or "AB: 219,6" as rows of a table with semicolons
/// ("AC;310.73 mm"); other lines are not changed. Returns an empty text if less than two lines, or less than
/// half of the lines, have this form.
std::string lines_of_pairs(const std::string& bytes, const std::vector<std::string>& known);

/// Finds the column with pairs of points, or two columns with the first and the second points, or headings
/// that are pairs (such a table is turned: a row for each pair). `known`: points that the user stated. A
/// table with a heading of an axis (X, Y, Z) has positions, and is no table of distances. Rows without a pair
/// below the first pair that have numbers are removed, with a note, if their cell has other words. nullopt:
/// the sheet has no such rows, and does not change.
std::optional<PairSheet> take_pairs(sheet::Sheet& sheet, const std::vector<std::string>& known);

/// Replaces the number of a pair in a cell by the names of its points: "A - B".
void restore_pair(std::string& cell, const PairSheet& pairs);

}  // namespace vernier::importer
