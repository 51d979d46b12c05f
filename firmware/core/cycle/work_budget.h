// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "comp/compensator.h"
#include "comp/shares.h"
#include "hal/clock.h"

namespace vernier {

constexpr std::uint64_t kAnyWork = UINT64_MAX;
/// The shares of the effects are computed outside the tick, for a display. The computation of the shares may
/// need this many times the work of a tick.
constexpr std::uint64_t kShareWorkFactor = 20;

/// Work that a board can do in the part of a tick that is reserved for the error equation.
struct WorkBudget {
  std::uint64_t work = kAnyWork;  // amount of work as defined by work_of in comp/verify.h
  std::uint64_t of_line = 0;      // work for reading a memory line that is not in a cache (lines_of)

  /// True if the board can execute a correction image: the work of the tick is within the budget, and the
  /// work with all shares is within kShareWorkFactor times the budget. Not real-time safe.
  bool covers(const Program& program, const ShareProgram& shares) const noexcept;
};

/// Measures the amount of work that this board can do in a quarter of a tick. The other three quarters of a
/// tick are for devices, the link and the other tasks of the processor. The measurement takes some
/// milliseconds. The measurement computes sums of products, and reads `memory` in random order (its words are
/// overwritten). `memory` must be larger than the caches. If `memory` is empty, reading a cache line has no
/// cost, as on a processor without caches. The best of several measurements is used, because other tasks
/// interrupted the slower measurements. If the clock does not advance during the measurement,
/// measured_work_budget() returns kAnyWork (no limit of the work). Call this function before the
/// first tick. Not real-time safe.
WorkBudget measured_work_budget(Clock& clock, TimeUs tick, std::span<std::uint32_t> memory = {}) noexcept;

/// Number of words of `memory` that exceeds the caches of usual boards: 16 MB.
constexpr std::size_t kWordsBeyondCaches = std::size_t{1} << 22;

}  // namespace vernier
