// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/registry/registry.h"

namespace vernier::registry {

struct AlikeOptions {
  double every_days = 7;       // readings within one such interval count as readings at one time
  double false_alarms = 0.01;  // probability that any drift (common or individual) is reported although none
                               // exists
};

/// A machine with an individual drift, in the unit of the quantity.
struct OwnDrift {
  std::string machine;
  double per_day = 0, std = 0;
};

/// Change of one quantity over time in all machines of a fleet.
struct Drift {
  std::string quantity, unit;
  std::size_t machines = 0, times = 0, readings = 0;
  bool judged = false;      // false: there are fewer than three machines or times
  bool common = false;      // true: all machines change together
  double common_p = 1;      // p-value: probability of such a common change if the machines do not change
  double common_swing = 0;  // largest minus smallest value of the common curve
  double scatter = 1;       // scatter of the readings about the fitted model, divided by their stated
                            // uncertainty
  double wander = 0;        // individual wander of each machine, divided by the stated uncertainty; 0: no
                            // wander
  double wander_days = 0;   // correlation time of the wander, days
  std::vector<std::pair<std::int64_t, double>> curve;  // common curve: time, value (0 at the first time)
  std::vector<OwnDrift> own;                           // individual drifts, the clearest first
};

/// Separates common changes of the machines of a fleet from the change of one machine. The model is: reading
/// = level of the machine + common curve of time + individual rate x time. The model is fitted by least
/// squares, weighted by the stated uncertainties. Individual rates are added one by one, the clearest first,
/// while an F test is significant at false_alarms / (2 x machines x quantities). The common curve is accepted
/// by an F test at false_alarms / (2 x quantities). A change that most machines have is therefore a common
/// change. Scatter beyond the stated uncertainty increases all uncertainties, and so does the wander of the
/// machines (wander.h). A drift is therefore a change that is larger than the wander of the other machines.
/// The rate of a machine is not reported if the rate is no longer significant when any one of its readings
/// is omitted.
std::vector<Drift> drifts(const std::vector<FleetReading>& readings, const AlikeOptions& options);

}  // namespace vernier::registry
