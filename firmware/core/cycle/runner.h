// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "firmware/core/cycle/cycle.h"
#include "firmware/core/cycle/histogram.h"
#include "hal/clock.h"
#include "hal/tick_sync.h"

namespace vernier {

/// Limits beyond which overruns are a fault. A single late tick is not a fault, because every system has a
/// late tick from time to time. If ticks are omitted regularly, the cycle time is wrong, for any distribution
/// of the late ticks.
struct OverrunLimits {
  std::uint32_t in_a_row = 10;
  std::uint32_t lost_share_q16 = 65536 / 20;  // of the ticks, that may be left out for ever
  std::uint32_t lost_at_once = 200;           // limit: a stop of 0.2 s is accepted, two in a second are not
};

/// Times of the ticks of a runner, ns.
struct TickTimes {
  Histogram latency;    // of wake-ups, behind the moment that was asked for
  Histogram execution;  // of a tick: read, step, write
};

/// Runs a cycle tick by tick on a clock. Sleeps until the tick is due, measures how late it woke and how long
/// it computed. A tick that ends after the next tick was due is an overrun; the ticks that were due during
/// the overrun are omitted.
class Runner {
 public:
  /// Constructs a runner whose first tick is due one period from now. Not real-time safe.
  Runner(Cycle& cycle, Clock& clock, TimeUs period) noexcept;
  /// Constructs a runner that starts each tick with a signal of `sync`. A signal earlier than half a period
  /// is ignored. If no sync signal arrives within `patience` after the tick was due, the clock starts the
  /// ticks until the next signal. Not real-time safe.
  Runner(Cycle& cycle, Clock& clock, TimeUs period, TickSync* sync, TimeUs patience,
         const OverrunLimits& overruns = {}) noexcept;

  /// After this call the controller must call step() in its own cycle; step() does not wait. Each call of
  /// step() is then one tick of the controller's time, for any delay of its thread; no tick is skipped. Not
  /// real-time safe.
  void follow_caller() noexcept { follows_ = true; }
  /// Sleeps, then runs one tick. found: a fault that was found outside the tick. The time of a tick is
  /// counted from the construction or set_time(). Real-time safe.
  TickReport step(Command command, Fault found = Fault::kNone) noexcept;
  /// The machine file's t of the next tick; for a run that starts in the middle of a machine's day.
  /// Not real-time safe.
  void set_time(TimeUs time) noexcept { time_ = time; }
  /// The machine file's t of the next tick.
  TimeUs time() const noexcept { return time_; }
  /// Returns the moment at which the last tick read its axes.
  InstantNs woke() const noexcept { return last_; }
  /// True if the ticks follow the controller's sync.
  bool in_step() const noexcept { return in_step_; }
  /// Number of losses of the sync signal since the start; never decreases.
  std::uint64_t lost_syncs() const noexcept { return lost_syncs_; }
  const TickTimes& times() const noexcept { return times_; }
  /// The moment at which the next tick is due.
  InstantNs due() const noexcept { return due_; }

 private:
  TickReport step_of_caller(Command command, Fault found) noexcept;
  void schedule(InstantNs ended) noexcept;
  void count_lost(std::uint32_t ticks) noexcept;
  bool overran_too_often() const noexcept {
    return overruns_ >= limits_.in_a_row || lost_level_ > std::uint64_t{limits_.lost_at_once} << 16;
  }
  HalFault wait() noexcept;
  bool wait_for_sync() noexcept;

  Cycle& cycle_;
  Clock& clock_;
  TimeUs period_;
  TickSync* sync_ = nullptr;
  TimeUs patience_;
  bool in_step_ = false, follows_ = false;
  std::uint64_t lost_syncs_ = 0;
  InstantNs last_;  // wake-up before
  InstantNs due_;
  TimeUs time_;
  ElapsedTicks elapsed_;
  OverrunLimits limits_;
  std::uint32_t overruns_ = 0;    // in a row
  std::uint64_t lost_level_ = 0;  // ticks, Q16: rises with each that is left out, falls with each that ran
  TickTimes times_;
};

}  // namespace vernier
