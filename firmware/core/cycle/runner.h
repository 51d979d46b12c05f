// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "firmware/core/cycle/cycle.h"
#include "firmware/core/cycle/histogram.h"
#include "hal/clock.h"
#include "hal/tick_sync.h"

namespace vernier {

/// Limits for overruns of ticks. A number of overruns (ticks that end late) beyond a limit is a
/// fault. A single late tick is not a fault, because a late tick occurs on every system from time
/// to time. If ticks are omitted regularly, the cycle time is wrong, also if the omitted ticks are
/// distributed evenly.
struct OverrunLimits {
  std::uint32_t in_a_row = 10;
  std::uint32_t lost_share_q16 = 65536 / 20;  // share of the ticks (Q16) that may be omitted permanently
  std::uint32_t lost_at_once = 200;           // limit for omitted ticks in a short time: a stop of 0.2 s is
                                              // accepted, two such stops in a second are not
};

/// Histograms of the times of a runner's ticks, ns.
struct TickTimes {
  Histogram latency;    // delay of wake-ups after the requested moment
  Histogram execution;  // duration of a tick: read, step, write
};

/// Runs a cycle on a clock, tick by tick. The runner sleeps until a tick is due. The runner measures how late
/// the tick starts and how long the tick takes. An overrun is a tick that ends after the next tick was due.
/// Ticks that were due during the overrun are omitted.
class Runner {
 public:
  /// Constructs a runner whose first tick is due one period from now. Not real-time safe.
  Runner(Cycle& cycle, Clock& clock, TimeUs period) noexcept;
  /// Constructs a runner in which each tick starts with a signal of `sync`. A signal that comes earlier than
  /// half a period after the previous tick is ignored. If no signal arrives within `patience` after the due
  /// time, the clock starts the ticks until the next signal. Not real-time safe.
  Runner(Cycle& cycle, Clock& clock, TimeUs period, TickSync* sync, TimeUs patience,
         const OverrunLimits& overruns = {}) noexcept;

  /// After this call, the controller calls step() in its own cycle, and step() does not wait. Each call of
  /// step() is then one tick of the controller's time, also if its thread is delayed. No tick is omitted. Not
  /// real-time safe.
  void follow_caller() noexcept { follows_ = true; }
  /// Sleeps until the next tick is due, and then runs one tick. `found`: a fault that was found outside the
  /// tick. The time of a tick is counted from the construction of the runner or from set_time(). Real-time
  /// safe.
  TickReport step(Command command, Fault found = Fault::kNone) noexcept;
  /// Sets the time t (machine file) of the next tick, for a run that does not begin at t = 0. Not real-time
  /// safe.
  void set_time(TimeUs time) noexcept { time_ = time; }
  /// Returns the time t (machine file) of the next tick.
  TimeUs time() const noexcept { return time_; }
  /// Returns the moment at which the last tick read its axes.
  InstantNs woke() const noexcept { return last_; }
  /// True if the sync signal of the controller starts the ticks.
  bool in_step() const noexcept { return in_step_; }
  /// Returns how often the sync signal was lost since the start. The number never decreases.
  std::uint64_t lost_syncs() const noexcept { return lost_syncs_; }
  const TickTimes& times() const noexcept { return times_; }
  /// Returns the moment at which the next tick is due.
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
  InstantNs last_;  // time of the previous wake-up
  InstantNs due_;
  TimeUs time_;
  ElapsedTicks elapsed_;
  OverrunLimits limits_;
  std::uint32_t overruns_ = 0;    // number of successive overruns
  std::uint64_t lost_level_ = 0;  // level in ticks, Q16: increases with each omitted tick, decreases with
                                  // each executed tick
  TickTimes times_;
};

}  // namespace vernier
