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
  std::optional<unsigned> dac_bits;  // resolution of the analogue output in bits; no value: one count of the
                                     // image
  double noise_um = 0;               // standard deviation of the noise of the position readings
  std::int64_t delay_ticks = 0;      // delay of the readings
  std::uint64_t seed = 1;            // seed of the noise
};

/// A path of the machine's axes, one state per tick.
class TickPath {
 public:
  virtual ~TickPath() = default;
  virtual std::size_t count() const noexcept = 0;
  virtual void at(std::size_t tick, PlantState& state) const noexcept = 0;
  virtual TimeUs time(std::size_t tick) const noexcept = 0;
  /// True if the correction in this tick is stored in LoopResult::correction.
  virtual bool kept(std::size_t tick) const noexcept = 0;
};

/// Sets `state` to the values that the controller of the simulated machine reports for row `k` of the states.
void tell_state(const model::Machine& machine, const model::States& states, Eigen::Index k,
                PlantState& state) noexcept;

/// Results of a simulation of the firmware along a path.
struct LoopResult {
  /// Correction that acts on the machine at each stored tick; one column per axis of the image, mm or deg.
  std::vector<model::Column> correction;
  std::size_t pre_roll = 0;     // number of ticks for which the machine was at rest, until the firmware was
                                // in the mode Active
  std::uint64_t saturated = 0;  // number of path ticks in which a correction was at a limit or beyond the
                                // range of the converter
  std::uint64_t slewing = 0, beyond_range = 0, not_active = 0;  // numbers of path ticks
  Mode mode = Mode::kBoot;
  Fault fault = Fault::kNone;
  Health health;        // counters of the whole simulation, including the ticks at rest, in simulated time
  Histogram execution;  // execution time of a path tick on this computer
};

/// Runs the firmware cycle with a simulated machine, without waiting for real time. The machine is at rest at
/// the first point of the path until the firmware is in the mode Active. After the firmware has become
/// Active, the machine follows `states` tick by tick. `machine`: the machine of these states, which is that
/// of the image. While the machine is at rest, its motion state is that of the first tick of the path. A path
/// from the middle of a longer motion therefore starts without a transient. The plausibility limits of
/// readings are off, because the path is a recorded motion. Throws LimitNotMet if the firmware does not reach
/// the mode Active.
LoopResult run_loop(const ImageView& image, const model::Machine& machine, const model::States& states,
                    const LoopOptions& options);
/// Runs the firmware cycle like the other run_loop(), along a path that is computed during the simulation.
LoopResult run_loop(const ImageView& image, const model::Machine& machine, const TickPath& path,
                    const LoopOptions& options);

}  // namespace vernier::simulate
