// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "firmware/core/service.h"
#include "hal/sim/plant.h"
#include "hal/sim/sim_clock.h"
#include "hal/sim/sim_probe_line.h"
#include "hal/sim/sim_slot_store.h"
#include "hal/sim/trajectory.h"

namespace vernier {

/// A drive along X from rest: constant acceleration to the feed, constant feed, deceleration to rest; mm, s.
struct Profile {
  double start_mm = 10, feed_mm_s = 1, acceleration_mm_s2 = 500, cruise_mm = 5;

  double ramp_s() const { return feed_mm_s / acceleration_mm_s2; }
  double ramp_mm() const { return feed_mm_s * feed_mm_s / 2 / acceleration_mm_s2; }
  double cruise_s() const { return cruise_mm / feed_mm_s; }
  double end_s() const { return 2 * ramp_s() + cruise_s(); }
  double at(double t) const {
    const double a = acceleration_mm_s2;
    t = std::clamp(t, 0.0, end_s());
    if (t < ramp_s()) return start_mm + a * t * t / 2;
    if (t < ramp_s() + cruise_s()) return start_mm + ramp_mm() + feed_mm_s * (t - ramp_s());
    const double left = end_s() - t;
    return start_mm + 2 * ramp_mm() + cruise_mm - a * left * left / 2;
  }
};

/// The profile as a machine's motion: X moves, Y crosses at a third of it, Z stands.
class Approach : public Trajectory {
 public:
  explicit Approach(const Profile& profile) : profile_(profile) {}
  void at(std::int64_t tick, PlantState& state) noexcept override {
    const double moved = profile_.at(static_cast<double>(tick) * 1e-3) - profile_.start_mm;
    state.axis[0].position = AxisPosition(std::llround((profile_.start_mm + moved) * 1e6));
    state.axis[1].position = AxisPosition(std::llround((50 - moved / 3) * 1e6));
    state.axis[2].position = AxisPosition(-7'000'000);
    for (int i = 0; i < 3; ++i) state.axis[i].referenced = true;
  }

 private:
  Profile profile_;
};

/// A board with axes X, Y, Z and a probe that touches once at a moment of the profile. `x`: its first axis;
/// `actual`: reads the actual positions; null: the board has only those of the plant.
struct TouchRig {
  SimSlotStore store{1 << 16};
  Approach motion;
  SimClock clock;
  SimPlant plant;
  SimProbeLine line;
  std::unique_ptr<Service> service;

  TouchRig(const Profile& profile, const ProbeSettings& probe, InstantNs stamp_resolution,
           InstantNs most_late = {}, const Wiring::Axis& x = {"X"}, AxisReader* actual = nullptr)
      : motion(profile),
        clock({}, most_late),
        plant(motion, 3, 0, PlantOptions{.gives_motion = false, .faults = {}}),
        line(stamp_resolution) {
    ServiceOptions options;
    options.wiring = {{x, {"Y"}, {"Z"}}, {}};
    options.probe = probe;
    service = std::make_unique<Service>(options,
                                        Board{.clock = clock,
                                              .axes = plant,
                                              .inputs = plant,
                                              .corrections = plant,
                                              .probe = &line,
                                              .actual = actual},
                                        store);
  }
  /// Runs from standstill to the end of the profile; edges: moments of the profile, s, and what they are.
  /// Each reaches the board with the tick after it.
  void run(const Profile& profile, std::vector<std::pair<double, bool>> edges, InstantNs resolution) {
    for (int i = 0; i < 20; ++i) plant.advance(), service->tick();
    plant.release();
    const auto ticks = static_cast<std::int64_t>(profile.end_s() * 1e3) + 60;
    std::size_t next = 0;
    for (std::int64_t i = 0; i < ticks; ++i) {
      plant.advance();
      // The tick to come reads the axes as they are at its due time.
      const double due_s = static_cast<double>(plant.path_tick()) * 1e-3;
      const InstantNs due = InstantNs(21'000'000 + i * 1'000'000);
      for (; next < edges.size() && edges[next].first <= due_s; ++next) {
        const double at = static_cast<double>(due.count) + (edges[next].first - due_s) * 1e9;
        const auto step = std::max<std::int64_t>(1, resolution.count);
        line.put(InstantNs((static_cast<std::int64_t>(std::floor(at)) / step) * step + step / 2),
                 edges[next].second);
      }
      service->tick();
    }
  }
  std::vector<TouchRecord> touches() const {
    std::vector<TouchRecord> all;
    TouchRecord touch;
    for (std::uint64_t i = 0; service->exchange().touches.read(i, touch); ++i) all.push_back(touch);
    return all;
  }
};

}  // namespace vernier
