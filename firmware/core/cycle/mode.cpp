// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/mode.h"

#include "comp/fixed.h"

namespace vernier {

void ModeControl::latch(Fault fault, Health& health) noexcept {
  // While checking (check() has ended Boot), no correction is in the drives, and a missing device is not a
  // fault yet. A lost image does not return by waiting.
  if (fault == Fault::kNone || (mode_ == Mode::kChecking && fault != Fault::kImageLost)) return;
  if (latched_ != Fault::kNone) return;
  latched_ = fault;
  ++health.faults;
  mode_ = Mode::kRampOut;
  engaging_ = false;
}

void ModeControl::obey(Command command, Health& health) noexcept {
  if (command == Command::kNone) return;
  const bool in = mode_ == Mode::kActive || (mode_ == Mode::kReady && engaging_);
  if (command == Command::kActivate && mode_ == Mode::kReady) {
    engaging_ = true;
    holding_ = false;
  } else if (command == Command::kDeactivate && in) {
    engaging_ = false;
    mode_ = Mode::kRampOut;
  } else if (command == Command::kClearFault && mode_ == Mode::kFaulted) {
    latched_ = Fault::kNone;
    mode_ = Mode::kChecking;
    good_ticks_ = 0;
  } else if (command == Command::kHold && mode_ == Mode::kActive) {
    holding_ = true;
  } else if (command == Command::kRelease && holding()) {
    holding_ = false;
  } else {
    ++health.refused_commands;
  }
}

void ModeControl::check(Fault fault, bool complete) noexcept {
  if (mode_ == Mode::kBoot) mode_ = Mode::kChecking;
  if (mode_ != Mode::kChecking) return;
  good_ticks_ = complete && fault == Fault::kNone ? good_ticks_ + 1 : 0;
  if (good_ticks_ >= kCheckTicks) mode_ = Mode::kReady;
}

void ModeControl::move_weight() noexcept {
  constexpr std::int32_t kStep = kFullWeight.count / kRampTicks;
  const bool in = mode_ == Mode::kActive || (mode_ == Mode::kReady && engaging_);
  const std::int32_t target = in ? kFullWeight.count : 0;
  weight_ = WeightQ16(clamp(target, weight_.count - kStep, weight_.count + kStep));
}

void ModeControl::before(Command command, Fault fault, bool complete, Health& health) noexcept {
  check(fault, complete);
  obey(command, health);
  latch(fault, health);
  move_weight();
}

void ModeControl::after(Fault fault, bool at_zero, bool settled, Health& health) noexcept {
  latch(fault, health);
  if (mode_ == Mode::kReady && engaging_ && settled && weight_ == kFullWeight) {
    mode_ = Mode::kActive;
    engaging_ = false;
  } else if (mode_ == Mode::kRampOut && at_zero && weight_ == WeightQ16{}) {
    mode_ = latched_ == Fault::kNone ? Mode::kReady : Mode::kFaulted;
  }
}

}  // namespace vernier
