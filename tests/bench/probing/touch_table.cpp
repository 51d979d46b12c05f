// SPDX-License-Identifier: GPL-3.0-or-later
// Error of the position at contact on simulated touches in acceleration, at constant feed and in
// deceleration: latched (comp/probing/latch.h), position at the edge less feed times delay, position at the
// edge. Delay 6.16 ms, stamps of 1 us.
#include <cstdio>
#include <random>

#include "tests/support/approach.h"

using namespace vernier;

namespace {

constexpr double kDelay = 6.16e-3;
constexpr InstantNs kResolution(1000);
constexpr int kTouches = 40;

struct Worst {
  double latched = 0, constant_feed = 0, none = 0;
};

Worst worst_of(const Profile& profile, double from_s, double to_s, std::mt19937_64& random) {
  Worst worst;
  ProbeSettings probe;
  probe.delay = InstantNs(6'160'000);
  for (int i = 0; i < kTouches; ++i) {
    const double contact = std::uniform_real_distribution<double>(from_s, to_s)(random);
    TouchRig rig(profile, probe, kResolution);
    rig.run(profile, {{contact + kDelay, true}, {contact + kDelay + 0.02, false}}, kResolution);
    const auto touches = rig.touches();
    if (touches.size() != 1 || touches[0].fault != 0) std::printf("no touch\n");
    const double truth_um = profile.at(contact) * 1e3, edge_um = profile.at(contact + kDelay) * 1e3;
    worst.latched =
        std::max(worst.latched, std::abs(static_cast<double>(touches[0].position[0]) * 1e-3 - truth_um));
    worst.constant_feed =
        std::max(worst.constant_feed, std::abs(edge_um - profile.feed_mm_s * kDelay * 1e3 - truth_um));
    worst.none = std::max(worst.none, std::abs(edge_um - truth_um));
  }
  return worst;
}

}  // namespace

int main() {
  constexpr std::uint64_t kSeed = 5;
  std::mt19937_64 random(kSeed);
  std::printf("worst of %d touches, um; seed %d; acceleration 500 mm/s^2\n", kTouches,
              static_cast<int>(kSeed));
  std::printf("%8s  %-14s %10s %14s %10s %10s\n", "mm/min", "contact in", "latched", "constant feed", "none",
              "allowed");
  for (const double feed : {25.0, 100.0, 250.0, 500.0, 1270.0, 2540.0}) {
    const Profile profile{.feed_mm_s = feed / 60, .cruise_mm = 1};
    const double ramp = profile.ramp_s(), end = profile.end_s();
    const struct {
      const char* name;
      double from, to;
    } stretches[] = {{"acceleration", 0.02 * ramp, ramp},
                     {"constant feed", ramp, end - ramp},
                     {"deceleration", end - ramp, end - 0.02 * ramp}};
    for (const auto& stretch : stretches) {
      const Worst w = worst_of(profile, stretch.from, stretch.to, random);
      std::printf("%8.0f  %-14s %10.3f %14.3f %10.3f %10.3f\n", feed, stretch.name, w.latched,
                  w.constant_feed, w.none, 0.1 + profile.feed_mm_s * 1e3 * 1e-6);
    }
  }
}
