// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/runner.h"

namespace vernier {
namespace {

// Ticks that are left out one by one; a longer stop starts a new count.
constexpr std::uint32_t kMostSkipped = 1000;
// Signs in one period that are too early to be the next cycle; more is no sync.
constexpr int kMostEarlySyncs = 64;
// A wake-up so much later than asked is no late wake-up: time was set, or the machine stood still.
constexpr InstantNs kClockStep(1'000'000'000);

}  // namespace

Runner::Runner(Cycle& cycle, Clock& clock, TimeUs period) noexcept
    : cycle_(cycle),
      clock_(clock),
      period_(period),
      last_(clock.now()),
      due_(last_ + instant_ns(period)),
      elapsed_(period) {}

Runner::Runner(Cycle& cycle, Clock& clock, TimeUs period, TickSync* sync, TimeUs patience,
               const OverrunLimits& overruns) noexcept
    : Runner(cycle, clock, period) {
  limits_ = overruns;
  sync_ = sync;
  patience_ = patience;
}

/// True: a sign has come that may start the tick.
bool Runner::wait_for_sync() noexcept {
  const InstantNs period = instant_ns(period_);
  for (int i = 0; i < kMostEarlySyncs; ++i) {
    const InstantNs latest = in_step_ ? due_ + instant_ns(patience_) : due_;
    if (sync_->wait_for_sync(latest) != HalFault::kNone) return false;
    const InstantNs now = clock_.now();
    if ((due_ - now).count <= period.count / 2) return true;
    // The first sync signal after ticks by the board's clock may follow one of them directly: it defines the
    // next due time.
    if (!in_step_) due_ = now + period;
    in_step_ = true;
  }
  return false;
}

HalFault Runner::wait() noexcept {
  if (sync_ == nullptr) return clock_.sleep_until(due_);
  if (!wait_for_sync()) {
    lost_syncs_ += in_step_ ? 1 : 0;
    in_step_ = false;
    return clock_.sleep_until(due_);
  }
  in_step_ = true;
  // The controller's cycles that brought no sign are ticks that were left out.
  const InstantNs now = clock_.now();
  if (now - due_ > kClockStep) return HalFault::kRefused;
  for (std::uint32_t i = 0; i < kMostSkipped && (now - due_).count > instant_ns(period_).count / 2; ++i) {
    due_ = due_ + instant_ns(period_);
    time_ = time_ + period_;
    ++cycle_.health().skipped;
  }
  due_ = now;
  return HalFault::kNone;
}

// A leaking bucket.
void Runner::count_lost(std::uint32_t ticks) noexcept {
  cycle_.health().skipped += ticks;
  const std::uint64_t level = lost_level_ + (std::uint64_t{ticks} << 16);
  lost_level_ = level > limits_.lost_share_q16 ? level - limits_.lost_share_q16 : 0;
}

void Runner::schedule(InstantNs ended) noexcept {
  due_ = due_ + instant_ns(period_);
  time_ = time_ + period_;
  const bool late = ended > due_;
  overruns_ = late ? overruns_ + 1 : 0;
  cycle_.health().overruns += late ? 1 : 0;
  std::uint32_t lost = 0;
  for (; lost < kMostSkipped && due_ < ended; ++lost) {
    due_ = due_ + instant_ns(period_);
    time_ = time_ + period_;
  }
  count_lost(lost);
  if (due_ < ended) due_ = ended + instant_ns(period_);
}

// The controller moves its axes by one period in every call: the delay of a late call is no motion.
TickReport Runner::step_of_caller(Command command, Fault found) noexcept {
  const InstantNs began = clock_.now();
  last_ = last_ + instant_ns(period_);
  const TickReport report =
      cycle_.tick(time_, command, overruns_ >= limits_.in_a_row ? Fault::kOverrun : found);
  const InstantNs taken = clock_.now() - began;
  times_.execution.add(taken.count);
  const bool late = taken > instant_ns(period_);
  overruns_ = late ? overruns_ + 1 : 0;
  cycle_.health().overruns += late ? 1 : 0;
  time_ = time_ + period_;
  return report;
}

TickReport Runner::step(Command command, Fault found) noexcept {
  if (follows_) return step_of_caller(command, found);
  Fault outer = overran_too_often() ? Fault::kOverrun : found;
  if (wait() != HalFault::kNone) outer = Fault::kClock;
  const InstantNs woke = clock_.now();
  // A monotonic clock that runs backwards is broken, for any reason.
  if (woke < last_ || woke - due_ > kClockStep) outer = Fault::kClock;
  const TicksQ8 elapsed = elapsed_.of(woke - last_);
  last_ = woke;
  const TickReport report = cycle_.tick(time_, command, outer, elapsed);
  const InstantNs ended = clock_.now();
  times_.latency.add((woke - due_).count);
  times_.execution.add((ended - woke).count);
  schedule(ended);
  return report;
}

}  // namespace vernier
