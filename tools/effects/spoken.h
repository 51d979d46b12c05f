// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/types.h"

namespace vernier::effects {

/// Returns the name that a workshop uses for the machine part at a location: "Z carriage", "C table", "B
/// head", "joint J3", "frame", "tool", "workpiece".
std::string part_name(const model::Machine& machine, const AxisPlaces& axes, const DofPlace& place);

/// Returns the workshop name of a candidate effect: "Z carriage: lag", "X carriage: play along Y", "X and Y:
/// unequal lag". The workshop name is composed from the choice and the terms of the candidate.
std::string spoken_name(const model::Machine& machine, const AxisPlaces& axes, const Candidate& candidate);

/// The fitted value of an unknown of a candidate, with its name in the machine file.
struct SpokenValue {
  std::string name;
  double value = 0, std = 0;  // in the unit of the machine file; std = 0: the standard uncertainty is unknown
};

/// Returns the workshop name of an effect with the number that states its size, in a unit of the workshop
/// (um, arcsec, ms, um/m). If the effect has a period, the text contains it. Examples: "Z carriage: lag 0.137
/// +- 0.007 ms", "X carriage: cyclic error 4.2 +- 0.2 um, period 10.0 +- 0.2 mm", "X carriage:
/// backlash, reversal value B 3.2 +- 0.2 um at position 0, and 40.9 +- 0.7 um/m along the axis". The size of
/// a length is that of the tool point relative to the workpiece, as in ISO 230: a term that moves the
/// workpiece has the opposite sign. If no single number states the size of the effect (a table, a curve),
/// spoken_with_size returns only the name.
std::string spoken_with_size(const Candidate& candidate, const std::vector<SpokenValue>& values);

}  // namespace vernier::effects
