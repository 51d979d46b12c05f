// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "firmware/health.h"

namespace vernier {

/// Where the firmware stands. Correction is zero in Boot, Checking, Faulted and, until told to activate,
/// Ready.
///
///   Boot -> Checking -> Ready -> Active -> RampOut -> Ready
///                ^        |         |          |
///                |        +--fault--+--------> RampOut -> Faulted
///                +---------------- clear ------------------+
enum class Mode : std::uint8_t {
  kBoot = 0,      // nothing has been read
  kChecking = 1,  // waits until all devices have answered without fault for a while
  kReady = 2,     // may be activated; while it brings the correction in it is still Ready
  kActive = 3,    // the whole correction is in
  kRampOut = 4,   // takes the correction out
  kFaulted = 5,   // correction is out, the fault is latched
};

/// One line for people: "ramp-out".
const char* name_of(Mode mode) noexcept;

/// What an operator may ask for. A command that does not fit the mode is refused and counted.
enum class Command : std::uint8_t {
  kNone = 0,
  kActivate = 1,
  kDeactivate = 2,
  kClearFault = 3,
  kHold = 4,     // Active only: every correction stays as it is
  kRelease = 5,  // ends a hold
};
constexpr std::uint8_t kCommandCount = static_cast<std::uint8_t>(Command::kRelease) + 1;

/// Ticks without fault before Checking becomes Ready.
constexpr std::uint32_t kCheckTicks = 100;
/// Ticks in which the weight goes from zero to full; the slew limits may make it longer.
constexpr std::int32_t kRampTicks = 256;
static_assert(kFullWeight.count % kRampTicks == 0);

/// The state machine of the modes. Each tick: before() with the faults of reading, the weight for the
/// compensator, after() with what came out.
class ModeControl {
 public:
  /// complete: every device has answered at least once and now. realtime.
  void before(Command command, Fault fault, bool complete, Health& health) noexcept;
  /// at_zero: every correction in the drives is zero; settled: every correction has reached its target.
  /// realtime.
  void after(Fault fault, bool at_zero, bool settled, Health& health) noexcept;

  Mode mode() const noexcept { return mode_; }
  WeightQ16 weight() const noexcept { return weight_; }
  /// Are the corrections held as they are? Only in Active.
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
