// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/registry/registry.h"

namespace vernier::registry {

struct AlikeOptions {
  double every_days = 7;       // readings of one such span count as of one time
  double false_alarms = 0.01;  // probability of reporting any drift, common or individual, if none exists
};

/// A machine with an individual drift; the quantity's unit.
struct OwnDrift {
  std::string machine;
  double per_day = 0, std = 0;
};

/// Change of one quantity over the fleet.
struct Drift {
  std::string quantity, unit;
  std::size_t machines = 0, times = 0, readings = 0;
  bool judged = false;      // false: fewer than three machines or times
  bool common = false;      // all move together
  double common_p = 1;      // chance of such a common movement of quiet machines
  double common_swing = 0;  // largest less smallest of the common curve
  double scatter = 1;       // of the readings about the answer, over their stated uncertainty
  double wander = 0;        // individual wander of each machine, divided by the same; 0: no wander
  double wander_days = 0;   // ... and for how long
  std::vector<std::pair<std::int64_t, double>> curve;  // of the common part: time, value (0 at the first)
  std::vector<OwnDrift> own;                           // the clearest first
};

/// Separates the common changes of the machines of a fleet from the change of one machine. Reading = level of
/// the machine + common curve of time + individual rate x time, by least squares weighted by the stated
/// uncertainties. Individual rates are added one by one, the clearest first, while an F test is significant
/// at false_alarms / (2 x machines x quantities); the common curve by an F test at false_alarms / (2 x
/// quantities). A change of most machines is therefore common. Scatter beyond the stated uncertainty
/// increases all uncertainties, as does the wander of the machines (wander.h): a drift is a change larger
/// than the wander of the others. A rate that is not significant without one of its readings is not reported.
std::vector<Drift> drifts(const std::vector<FleetReading>& readings, const AlikeOptions& options);

}  // namespace vernier::registry
