// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "firmware/core/cycle/health.h"
#include "tables/codes.h"

namespace vernier {

/// Ticks without fault before Checking becomes Ready.
constexpr std::uint32_t kCheckTicks = 100;
/// Number of ticks in which the weight goes from zero to full; the slew limits may make this time longer.
constexpr std::int32_t kRampTicks = 256;
static_assert(kFullWeight.count % kRampTicks == 0);

/// The state machine of the modes. In each tick the cycle calls before() with the faults of the readings,
/// passes the weight to the compensator, and calls after() with the result.
class ModeControl {
 public:
  /// complete: every device has answered at least once and now. Real-time safe.
  void before(Command command, Fault fault, bool complete, Health& health) noexcept;
  /// Ends the tick. at_zero: every correction in the drives is zero; settled: every correction has reached
  /// its target. Real-time safe.
  void after(Fault fault, bool at_zero, bool settled, Health& health) noexcept;

  /// Starts with a fault that was latched before the start; a command clears it. Call before the first tick.
  /// Not real-time safe.
  void restore(Fault fault) noexcept {
    if (fault != Fault::kNone) latched_ = fault, mode_ = Mode::kFaulted;
  }

  Mode mode() const noexcept { return mode_; }
  WeightQ16 weight() const noexcept { return weight_; }
  /// True if the corrections are held at their present values. Only the mode Active can hold corrections.
  bool holding() const noexcept { return holding_ && mode_ == Mode::kActive; }
  /// The first fault since the last clearing.
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
