// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "firmware/core/cycle/health.h"
#include "tables/codes.h"

namespace vernier {

/// Number of ticks without a fault after which the mode changes from Checking to Ready.
constexpr std::uint32_t kCheckTicks = 100;
/// Number of ticks in which the weight of the correction increases from zero to full. The slew limits may
/// make the increase of the weight longer.
constexpr std::int32_t kRampTicks = 256;
static_assert(kFullWeight.count % kRampTicks == 0);

/// The state machine of the board's modes (Boot, Checking, Ready, Active, Faulted and others). In each tick
/// the cycle calls before() with the faults of the readings, gives the weight to the compensator, and calls
/// after() with the result.
class ModeControl {
 public:
  /// `complete`: true if every device has given at least one reading and gives a reading in this tick.
  /// Real-time safe.
  void before(Command command, Fault fault, bool complete, Health& health) noexcept;
  /// Updates the mode at the end of a tick. `at_zero`: true if every correction in the drives is zero;
  /// `settled`: true if every correction has reached its target. Real-time safe.
  void after(Fault fault, bool at_zero, bool settled, Health& health) noexcept;

  /// Starts the state machine with a fault that was latched before the start of the board. A
  /// command clears this fault. Call before the first tick. Not real-time safe.
  void restore(Fault fault) noexcept {
    if (fault != Fault::kNone) latched_ = fault, mode_ = Mode::kFaulted;
  }

  Mode mode() const noexcept { return mode_; }
  WeightQ16 weight() const noexcept { return weight_; }
  /// True if the corrections are held at their present values. Only the mode Active can hold corrections.
  bool holding() const noexcept { return holding_ && mode_ == Mode::kActive; }
  /// Returns the first fault since the last clearing.
  Fault latched() const noexcept { return latched_; }

 private:
  void obey(Command command, Health& health) noexcept;
  void latch(Fault fault, Health& health) noexcept;
  void check(Fault fault, bool complete) noexcept;
  void move_weight() noexcept;

  Mode mode_ = Mode::kBoot;
  Fault latched_ = Fault::kNone;
  WeightQ16 weight_;
  bool engaging_ = false, holding_ = false;
  std::uint32_t good_ticks_ = 0;
};

}  // namespace vernier
