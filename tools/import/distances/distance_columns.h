// SPDX-License-Identifier: GPL-3.0-or-later
// The meaning of the columns in a table of distances between named points.
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"
#include "tools/import/distances/pair_sheet.h"

namespace vernier::importer {

/// Names that a column of such a table may have beside those of the measurement file (distance, u): the pair
/// of points, the nominal distance, the deviation actual - nominal, the mean of the measured distances.
inline constexpr const char* kPairName = "pair";
inline constexpr const char* kNominalName = "nominal";
inline constexpr const char* kDeviationName = "deviation";

/// Returns the meaning of each column by the assignments of the user, otherwise by its heading: "Soll" is
/// nominal, "Ist 1" and "Ist 2" are both distance (repeated measurements), "Abweichung" is deviation. A mean
/// and a deviation are left out if the table also has the measured distances. `ask`: for several columns that
/// may be the measured distances, or none, the reason why the table cannot be read; empty otherwise.
std::vector<SheetColumn> distance_columns(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const PairSheet& pairs, const SheetWishes& wishes,
                                          std::string& ask);

}  // namespace vernier::importer
