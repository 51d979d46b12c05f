// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/core/cycle/histogram.h"
#include "firmware/core/cycle/mode.h"
#include "hal/sim/trajectory.h"
#include "tables/image_view.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::simulate {

/// Deviations of the simulated hardware from a perfect machine.
struct LoopOptions {
  std::optional<unsigned> dac_bits;  // analogue output; no value: one count of the image
  double noise_um = 0;               // of the position readings, standard deviation
  std::int64_t delay_ticks = 0;      // age of the readings
  std::uint64_t seed = 1;            // of the noise
};

/// A path of the machine's axes, one state per tick.
class TickPath {
 public:
  virtual ~TickPath() = default;
  virtual std::size_t count() const noexcept = 0;
  virtual void at(std::size_t tick, PlantState& state) const noexcept = 0;
  virtual TimeUs time(std::size_t tick) const noexcept = 0;
  /// True if the correction of this tick is stored in LoopResult::correction.
  virtual bool kept(std::size_t tick) const noexcept = 0;
};

/// Sets row `k` of states to the values that the controller of the simulated machine reports.
void tell_state(const model::Machine& machine, const model::States& states, Eigen::Index k,
                PlantState& state) noexcept;

/// Results of the firmware along a path.
struct LoopResult {
  /// Correction that acts on the machine at each stored tick; one column per axis of the image, mm or deg.
  std::vector<model::Column> correction;
  std::size_t pre_roll = 0;     // ticks during which the machine was at rest until the firmware was Active
  std::uint64_t saturated = 0;  // ticks of the path with a correction at a limit, or beyond the converter
  std::uint64_t slewing = 0, beyond_range = 0, not_active = 0;  // ticks of the path
  Mode mode = Mode::kBoot;
  Fault fault = Fault::kNone;
  Health health;        // of the whole run, pre-roll included, in simulated time
  Histogram execution;  // of a tick of the path on this host
};

/// Runs the firmware cycle on the simulated machine, without sleeping. The machine is at rest at the path's
/// first point until the firmware is Active. Then the machine follows `states` tick by tick (machine: the
/// machine of these states, which is that of the image). At rest, the motion state of the machine is the
/// motion state of the first tick of the path. A path from the middle of a longer motion therefore starts
/// without a transient. Plausibility limits of readings are off, because the path is recorded motion. Throws
/// LimitNotMet if the firmware never becomes Active.
LoopResult run_loop(const ImageView& image, const model::Machine& machine, const model::States& states,
                    const LoopOptions& options);
/// Runs the firmware cycle like run_loop() with states, along a path that is computed during the run.
LoopResult run_loop(const ImageView& image, const model::Machine& machine, const TickPath& path,
                    const LoopOptions& options);

}  // namespace vernier::simulate
