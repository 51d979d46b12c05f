// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/core/histogram.h"
#include "firmware/core/mode.h"
#include "hal/sim/trajectory.h"
#include "tables/image_view.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::simulate {

/// What stands between the firmware and a perfect machine.
struct LoopOptions {
  std::optional<unsigned> dac_bits;  // analogue chain; none: one count of the image
  double noise_um = 0;               // of the position readings, standard deviation
  std::int64_t delay_ticks = 0;      // age of the readings
  std::uint64_t seed = 1;            // of the noise
};

/// A path of the machine's axes, a state a tick.
class TickPath {
 public:
  virtual ~TickPath() = default;
  virtual std::size_t count() const noexcept = 0;
  virtual void at(std::size_t tick, PlantState& state) const noexcept = 0;
  virtual TimeUs time(std::size_t tick) const noexcept = 0;
  /// Is the correction of this tick wanted in LoopResult::correction?
  virtual bool kept(std::size_t tick) const noexcept = 0;
};

/// Row `k` of states as the controller of the simulated machine tells it.
void tell_state(const model::Machine& machine, const model::States& states, Eigen::Index k,
                PlantState& state) noexcept;

/// What the firmware did along a path.
struct LoopResult {
  /// As the machine moves by it; per axis of the image, mm or deg, of each tick that is kept.
  std::vector<model::Column> correction;
  std::size_t pre_roll = 0;     // ticks that the machine stood until the firmware was Active
  std::uint64_t saturated = 0;  // ticks of the path with a correction at a limit, or beyond the converter
  std::uint64_t slewing = 0, beyond_range = 0, not_active = 0;  // ticks of the path
  Mode mode = Mode::kBoot;
  Fault fault = Fault::kNone;
  Health health;        // of the whole run, pre-roll included, in simulated time
  Histogram execution;  // of a tick of the path on this host
};

/// Runs the firmware cycle on the simulated machine, without sleeping: the machine stands at the path's first
/// point until the firmware is Active, then follows `states` tick by tick (machine: whose states these are,
/// the image's own). While it stands, its motion state is that of the first tick, as if it had come there on
/// the path: a path cut out of a longer motion starts without a transient. Plausibility limits of readings
/// are off: the path is what happened. Throws LimitNotMet where the firmware never becomes Active. tool.
LoopResult run_loop(const ImageView& image, const model::Machine& machine, const model::States& states,
                    const LoopOptions& options);
/// The same along a path that is made as it goes.
LoopResult run_loop(const ImageView& image, const model::Machine& machine, const TickPath& path,
                    const LoopOptions& options);

}  // namespace vernier::simulate
