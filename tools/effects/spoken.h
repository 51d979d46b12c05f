// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/types.h"

namespace vernier::effects {

/// Returns the shop name of the machine part at a location: "Z carriage", "C table", "B head",
/// "joint J3", "frame", "tool", "workpiece". tool.
std::string part_name(const model::Machine& machine, const AxisPlaces& axes, const DofPlace& place);

/// Returns the shop name of a candidate: "Z carriage: lag", "X carriage: play along Y", "X and Y:
/// unequal lag". It is made from the candidate's choice and terms. tool.
std::string spoken_name(const model::Machine& machine, const AxisPlaces& axes, const Candidate& candidate);

/// A fitted unknown of a candidate, by its name in the machine file.
struct SpokenValue {
  std::string name;
  double value = 0, std = 0;  // in the unit of the machine file; std 0: unknown
};

/// Returns the shop name with the one number that states the size, in a unit of the shop (um,
/// arcsec, ms, um/m). A period is added if the effect has one: "Z carriage: lag 0.137 +- 0.007
/// ms", "X carriage: cyclic error 4.2 +- 0.2 um, period 10.0 +- 0.2 mm". Without such a number (a
/// table, a curve) it returns the name alone. tool.
std::string spoken_with_size(const Candidate& candidate, const std::vector<SpokenValue>& values);

}  // namespace vernier::effects
