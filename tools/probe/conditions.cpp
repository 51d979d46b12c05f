// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/conditions.h"

#include <fmt/format.h>

#include "tools/maths/factors.h"

namespace vernier::probe {
namespace {

// mm per mm, of the published touches (NISTIR 6415, see conditions.h).
constexpr double kApproachPerFollowing = 5.1 / 1.78;

}  // namespace

double following_error(const TouchConditions& conditions, double feed) {
  return feed / maths::kSecondsPerMinute / conditions.gain_per_s;
}

double least_approach(const TouchConditions& conditions, double feed) {
  return kApproachPerFollowing * following_error(conditions, feed);
}

double least_overtravel(const TouchConditions& conditions, double feed) {
  return following_error(conditions, feed);
}

double stopping_way(const TouchConditions& conditions, double feed) {
  return feed / maths::kSecondsPerMinute * conditions.delay_s + following_error(conditions, feed);
}

std::vector<std::string> broken_conditions(const TouchConditions& conditions, double feed, double clearance,
                                           std::optional<double> overtravel) {
  std::vector<std::string> broken;
  constexpr double kRounding = 1 + 1e-9;  // a limit that a user typed is valid
  const double following = following_error(conditions, feed);
  if (clearance * kRounding < least_approach(conditions, feed))
    broken.push_back(
        fmt::format("an approach of {:.4g} mm at {:.4g} mm/min touches before the speed is constant: the "
                    "approach must be at least {:.3g} mm (following error of the axis {:.3g} mm)",
                    clearance, feed, least_approach(conditions, feed), following));
  if (overtravel && *overtravel * kRounding < least_overtravel(conditions, feed))
    broken.push_back(
        fmt::format("an approach that ends {:.4g} mm beyond the surface at {:.4g} mm/min has stopped before "
                    "the contact: the following error of the axis is {:.3g} mm",
                    *overtravel, feed, following));
  if (overtravel && *overtravel > conditions.stylus_mm * kRounding)
    broken.push_back(
        fmt::format("an approach that ends {:.4g} mm beyond the surface bends the stylus by this distance if "
                    "the probe does not trigger: the stylus permits {:.4g} mm",
                    *overtravel, conditions.stylus_mm));
  if (stopping_way(conditions, feed) > conditions.stylus_mm * kRounding)
    broken.push_back(fmt::format(
        "at {:.4g} mm/min the machine stops {:.3g} mm behind the contact: the stylus permits {:.4g} mm", feed,
        stopping_way(conditions, feed), conditions.stylus_mm));
  return broken;
}

}  // namespace vernier::probe
