// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace vernier::probe {

/// What a touch at speed takes to be a valid one: the machine comes to the surface at constant speed and
/// stays there until the probe has triggered, and the stylus is not bent further than it bears. Defaults:
/// NISTIR 6415, 1999, where at 2540 mm/min the axis follows 1.78 mm behind, the approach is 5.1 mm and the
/// probe is driven 2.5 mm beyond the surface.
struct TouchConditions {
  double gain_per_s = 2540.0 / 60 / 1.78;  // of the position loop: following error = speed / gain
  double delay_s = 6e-3;                   // from contact to the edge that the controller sees
  double stylus_mm = 6;                    // deflection that the probe bears
};

/// Speed over the gain of the position loop, mm. feed: mm/min. Any of these: tool.
double following_error(const TouchConditions& conditions, double feed);
/// Approach after which the speed is constant to 2 %: the published 5.1 mm over 1.78 mm times the following
/// error, mm.
double least_approach(const TouchConditions& conditions, double feed);
/// How far beyond the surface the end of the approach has to lie, so that the command has not stopped before
/// the contact, mm: the following error.
double least_overtravel(const TouchConditions& conditions, double feed);
/// Deflection of the stylus by the time the machine stands after a touch, mm: the delay's way and the
/// following error, which the axis still has to run.
double stopping_way(const TouchConditions& conditions, double feed);

/// What is wrong with an approach of `clearance` (mm before the surface) to `overtravel` (mm beyond it; none:
/// the surface is aimed at by the probe's own size) at a feed, a sentence each. tool.
std::vector<std::string> broken_conditions(const TouchConditions& conditions, double feed, double clearance,
                                           std::optional<double> overtravel);

}  // namespace vernier::probe
