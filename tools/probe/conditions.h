// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace vernier::probe {

/// Conditions under which a touch at constant speed is valid. The machine must reach the surface at constant
/// speed, and must keep this speed until the probe has triggered. The stylus must not be deflected beyond its
/// limit. The default values are from NISTIR 6415, 1999. In this source, the following error of the axis at
/// 2540 mm/min is 1.78 mm, the approach is 5.1 mm long, and the programmed end of the approach is 2.5 mm
/// beyond the surface.
struct TouchConditions {
  double gain_per_s = 2540.0 / 60 / 1.78;  // gain of the position loop: following error = speed / gain
  double delay_s = 6e-3;                   // delay from the contact to the edge that the controller receives
  double stylus_mm = 6;                    // permitted deflection of the stylus
};

/// Returns the following error of the axis: speed divided by the gain of the position loop, mm. `feed`: speed
/// of the approach, mm/min.
double following_error(const TouchConditions& conditions, double feed);
/// Returns the length of approach after which the speed is constant within 2 %, mm. The length of approach is
/// the following error times the published ratio 5.1 mm / 1.78 mm.
double least_approach(const TouchConditions& conditions, double feed);
/// Returns the smallest distance from the surface to the programmed end of the approach, mm. The smallest
/// distance beyond the surface equals the following error of the axis. With a distance equal to the
/// following error, the commanded position is still moving when the contact occurs.
double least_overtravel(const TouchConditions& conditions, double feed);
/// Returns the deflection of the stylus when the machine has stopped after a touch, mm. The deflection is the
/// path during the delay plus the following error, which the axis still has to travel.
double stopping_way(const TouchConditions& conditions, double feed);

/// Returns the conditions that an approach at a given feed violates, one sentence for each. The approach
/// begins at `clearance` (mm before the surface) and ends at `overtravel` (mm beyond the surface). If
/// `overtravel` has no value, the size of the probe defines the end.
std::vector<std::string> broken_conditions(const TouchConditions& conditions, double feed, double clearance,
                                           std::optional<double> overtravel);

}  // namespace vernier::probe
