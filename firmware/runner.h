// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "firmware/cycle.h"
#include "hal/clock.h"

namespace vernier {

/// Overruns in a row that are a fault.
constexpr std::uint32_t kMostOverruns = 10;

/// Runs a cycle tick by tick on a clock: sleeps until the tick is due, measures how late it woke and how long
/// it computed. A tick that ends after the next was due is an overrun; the ticks that it covered are left
/// out.
class Runner {
 public:
  /// The first tick is due one period from now. setup.
  Runner(Cycle& cycle, Clock& clock, TimeUs period) noexcept;

  /// Sleeps, then one tick; its time is counted from the construction or set_time(). realtime.
  TickReport step(Command command) noexcept;
  /// The machine file's t of the next tick; for a run that starts in the middle of a machine's day. setup.
  void set_time(TimeUs time) noexcept { time_ = time; }
  /// The machine file's t of the next tick.
  TimeUs time() const noexcept { return time_; }
  /// The moment at which the last tick read its axes.
  InstantNs woke() const noexcept { return last_; }
  /// The moment at which the next tick is due.
  InstantNs due() const noexcept { return due_; }

 private:
  void schedule(InstantNs ended) noexcept;

  Cycle& cycle_;
  Clock& clock_;
  TimeUs period_;
  InstantNs last_;  // wake-up before
  InstantNs due_;
  TimeUs time_;
  std::uint32_t overruns_ = 0;  // in a row
};

}  // namespace vernier
