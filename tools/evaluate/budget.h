// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vernier::evaluate {

/// Components of the uncertainty of a positioning test by ISO 230-2. A component given as a range has a
/// rectangular distribution: u = range / (2 sqrt 3), and U = 2 u, which is 0.58 of the range (GUM 4.3.7). An
/// uncertainty component that the user does not give is 0.
struct PositioningBudget {
  double device_um_m = 0;         // expanded uncertainty of the calibrated measuring instrument, um/m, k = 2
  double misalignment_mm_m = 0;   // largest misalignment between the measuring line and the axis, mm/m
  double thermometer_K = 0;       // range of the uncertainty of the machine's temperature, K
  double expansion_um_mK = 11.5;  // expansion coefficient that was used for the correction, um/(m K);
                                  // default: steel
  double expansion_range = 0;     // range of the uncertainty of the expansion coefficient, um/(m K)
  double away_from_20_K = 0;      // difference between the machine's temperature and 20 degC, K
  double drift_um = 0;            // range of the readings during the time of a test while the machine stands
                                  // still, um
  bool given = false;
};

/// Adds a component from a text "device=0.8" (also misalignment, thermometer, expansion, expansion-range,
/// away, drift), in the units of PositioningBudget. Throws InputError if the text is not a component
/// with its value.
void add_to_budget(PositioningBudget& budget, const std::string& words);

struct BudgetPart {
  std::string name;
  double expanded_um = 0;  // expanded uncertainty, k = 2
};

/// Returns the components of a budget over a length: the components that are proportional to the distance,
/// and the drift.
std::vector<BudgetPart> budget_parts(const PositioningBudget& budget, double length_mm);

/// Returns the expanded uncertainty U (k = 2) of A, E, M, R, B in mm, for a test with `runs` readings in each
/// approach direction. The parameters A, E and M are differences over the length, so that all components
/// contribute to their uncertainty. A component that is proportional to the distance is equal for both
/// approach directions of a target and for all runs. Only the drift contributes to the uncertainty of B and
/// R: for B between two means of `runs` readings, for R at both ends of the repeatability range. The
/// components are those in public descriptions of ISO/TR 230-9. The components of the uncertainty are
/// combined by the GUM.
std::map<std::string, double> budget_uncertainty(const PositioningBudget& budget, double length_mm,
                                                 double runs);

}  // namespace vernier::evaluate
