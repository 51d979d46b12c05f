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
/// Shares are computed outside the tick, for a display. Shares may need this many times the work of a tick.
constexpr std::uint64_t kShareWorkFactor = 20;

/// Work that a board can do in the part of a tick that is reserved for the equation.
struct WorkBudget {
  std::uint64_t work = kAnyWork;  // comp/verify.h, work_of
  std::uint64_t of_line = 0;      // work that a line of memory costs which no cache holds (lines_of)

  /// True if the board can execute a correction image: the tick is within the budget, and the tick with its
  /// shares is within kShareWorkFactor times the budget. Not real-time safe.
  bool covers(const Program& program, const ShareProgram& shares) const noexcept;
};

/// Measures the work that this board does in a quarter of a tick. The other three quarters are for devices,
/// the link and the other tasks of the processor. The measurement takes some milliseconds: sums of products,
/// and jumps through `memory` (its words are overwritten). `memory` must be larger than the caches. If
/// `memory` is empty, reading a cache line has no cost, as on a processor without caches. The best of several
/// measurements counts, because other tasks interrupted the slower ones. Returns kAnyWork if the clock does
/// not move. Call before the first tick. Not real-time safe.
WorkBudget measured_work_budget(Clock& clock, TimeUs tick, std::span<std::uint32_t> memory = {}) noexcept;

/// Words of `memory` that exceed the caches of boards: 16 MB.
constexpr std::size_t kWordsBeyondCaches = std::size_t{1} << 22;

}  // namespace vernier
