// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vernier::importer {

/// One deviation of a column, and where it was read. All numbers are in the units of the table.
struct PlacedReading {
  double value = 0, position = 0;  // position: of the axis that the deviation belongs to
  std::string place;               // the positions of all axes
  std::string run;                 // empty: the table has no runs
  int sense = 0;                   // approach direction: 1, -1; 0: not known
};

/// The value that other readings let expect for one reading.
struct ExpectedReading {
  double value = 0;
  double scale = 1;  // standard deviation of reading - value
};

/// The expected values of a column; nullopt: no other reading is comparable.
struct ExpectedReadings {
  std::vector<std::optional<ExpectedReading>> at;
  double scale = 0;  // standard deviation of one reading, robust
};

/// Returns the expectations of a column by several predictors, the one with the smallest scale first: the
/// other runs at the same place and direction (without the offset of each run), the other direction at the
/// same place (without the reversal error), and the straight line through the two nearest readings of the
/// same run and direction. A predictor with fewer than eight expectations has none. `digit`: the step of the
/// last decimal, the least scale.
std::vector<ExpectedReadings> expected_readings(const std::vector<PlacedReading>& readings, double digit);

}  // namespace vernier::importer
