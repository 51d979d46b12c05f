// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace vernier::probe {

/// Conditions for a valid touch at speed. The machine must reach the surface at constant speed and keep this
/// speed until the probe has triggered. The stylus must not be deflected beyond its limit. Source of the
/// defaults: NISTIR 6415, 1999. At 2540 mm/min the following error of the axis is 1.78 mm, the approach is
/// 5.1 mm long, and the programmed end of the approach is 2.5 mm beyond the surface.
struct TouchConditions {
  double gain_per_s = 2540.0 / 60 / 1.78;  // of the position loop: following error = speed / gain
  double delay_s = 6e-3;                   // from contact to the edge that the controller sees
  double stylus_mm = 6;                    // allowed deflection of the probe
};

/// Returns speed divided by the gain of the position loop, mm. feed: mm/min.
double following_error(const TouchConditions& conditions, double feed);
/// Returns the approach after which the speed is constant to 2 %: the published 5.1 mm over 1.78
/// mm times the following error, mm.
double least_approach(const TouchConditions& conditions, double feed);
/// Returns the smallest distance from the surface to the end of the approach, mm: the following error. With
/// this distance, the commanded position still moves at the time of the contact.
double least_overtravel(const TouchConditions& conditions, double feed);
/// Returns the deflection of the stylus when the machine has stopped after a touch, mm: the path
/// during the delay, and the following error, which the axis still has to travel.
double stopping_way(const TouchConditions& conditions, double feed);

/// Returns the violated conditions of an approach at a feed, one sentence each. The approach is from
/// `clearance` (mm before the surface) to `overtravel` (mm beyond the surface; no value: the size of the
/// probe defines the target).
std::vector<std::string> broken_conditions(const TouchConditions& conditions, double feed, double clearance,
                                           std::optional<double> overtravel);

}  // namespace vernier::probe
