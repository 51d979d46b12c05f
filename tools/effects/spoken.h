// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/types.h"

namespace vernier::effects {

/// Returns the shop name of the machine part at a location: "Z carriage", "C table", "B head",
/// "joint J3", "frame", "tool", "workpiece".
std::string part_name(const model::Machine& machine, const AxisPlaces& axes, const DofPlace& place);

/// Returns the shop name of a candidate: "Z carriage: lag", "X carriage: play along Y", "X and Y: unequal
/// lag". The shop name is made from the choice and terms of the candidate.
std::string spoken_name(const model::Machine& machine, const AxisPlaces& axes, const Candidate& candidate);

/// A fitted unknown of a candidate; the name is that of the machine file.
struct SpokenValue {
  std::string name;
  double value = 0, std = 0;  // in the unit of the machine file; std 0: unknown
};

/// Returns the shop name with the one number that states the size of the effect, in a unit of the shop (um,
/// arcsec, ms, um/m). The text includes the period if the effect has one: "Z carriage: lag 0.137 +- 0.007
/// ms", "X carriage: cyclic error 4.2 +- 0.2 um, period 10.0 +- 0.2 mm", "X carriage: backlash 3.2 +- 0.2 um
/// at position 0, and 40.9 +- 0.7 um/m along the axis". For an effect without a single size (a table, a
/// curve), spoken_with_size returns only the name.
std::string spoken_with_size(const Candidate& candidate, const std::vector<SpokenValue>& values);

}  // namespace vernier::effects
