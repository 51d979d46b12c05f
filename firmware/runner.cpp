// SPDX-License-Identifier: Apache-2.0
#include "firmware/runner.h"

namespace vernier {
namespace {

// Ticks that are left out one by one; a longer stop starts a new count.
constexpr int kMostSkipped = 1000;
// A wake-up so much later than asked is no late wake-up: time was set, or the machine stood still.
constexpr InstantNs kClockStep(1'000'000'000);

}  // namespace

Runner::Runner(Cycle& cycle, Clock& clock, TimeUs period) noexcept
    : cycle_(cycle), clock_(clock), period_(period), last_(clock.now()), due_(last_ + instant_ns(period)) {}

void Runner::schedule(InstantNs ended) noexcept {
  due_ = due_ + instant_ns(period_);
  time_ = time_ + period_;
  if (ended <= due_) {
    overruns_ = 0;
    return;
  }
  ++cycle_.health().overruns;
  ++overruns_;
  for (int i = 0; i < kMostSkipped && due_ < ended; ++i) {
    due_ = due_ + instant_ns(period_);
    time_ = time_ + period_;
    ++cycle_.health().skipped;
  }
  if (due_ < ended) due_ = ended + instant_ns(period_);
}

TickReport Runner::step(Command command) noexcept {
  Fault outer = overruns_ >= kMostOverruns ? Fault::kOverrun : Fault::kNone;
  if (clock_.sleep_until(due_) != HalFault::kNone) outer = Fault::kClock;
  const InstantNs woke = clock_.now();
  // A monotonic clock that runs backwards is broken, whatever the reason.
  if (woke < last_ || woke - due_ > kClockStep) outer = Fault::kClock;
  last_ = woke;
  const TickReport report = cycle_.tick(time_, command, outer);
  const InstantNs ended = clock_.now();
  cycle_.health().latency.add((woke - due_).count);
  cycle_.health().execution.add((ended - woke).count);
  schedule(ended);
  return report;
}

}  // namespace vernier
