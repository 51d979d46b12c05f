// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vernier::evaluate {

/// Components of the uncertainty of a positioning test by ISO 230-2. A range counts as a rectangular
/// distribution: u = range / (2 sqrt 3), and U = 2 u, which is 0.58 of the range (GUM 4.3.7). Absent
/// components are 0.
struct PositioningBudget {
  double device_um_m = 0;         // expanded uncertainty of the calibrated instrument, um/m, k = 2
  double misalignment_mm_m = 0;   // of its line to the axis, largest, mm/m
  double thermometer_K = 0;       // range within which the machine's temperature is known, K
  double expansion_um_mK = 11.5;  // coefficient that was corrected with, um/(m K); steel
  double expansion_range = 0;     // range within which that is known, um/(m K)
  double away_from_20_K = 0;      // how far the machine was from 20 degC, K
  double drift_um = 0;            // range of the readings of a standing machine over the time of a test, um
  bool given = false;
};

/// Adds "device=0.8" (also misalignment, thermometer, expansion, expansion-range, away, drift), in the units
/// above. Throws InputError.
void add_to_budget(PositioningBudget& budget, const std::string& words);

struct BudgetPart {
  std::string name;
  double expanded_um = 0;  // k = 2
};

/// Returns the components of a budget over a length: the component in proportion to the distance, and the
/// drift.
std::vector<BudgetPart> budget_parts(const PositioningBudget& budget, double length_mm);

/// U (k = 2) of A, E, M, R, B in mm, of tests with `runs` readings in each approach direction. A, E and M are
/// differences over the length: all components count. Components proportional to the distance are equal for
/// both approach directions of a target and for all runs. For B and R only the drift contributes: for B
/// between two means of `runs`, for R between both ends of a range. Components as in public descriptions of
/// ISO/TR 230-9; combined by the GUM.
std::map<std::string, double> budget_uncertainty(const PositioningBudget& budget, double length_mm,
                                                 double runs);

}  // namespace vernier::evaluate
