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
/// Shares are computed outside the tick, for a display. They may need this many times the work of a tick.
constexpr std::uint64_t kShareWorkFactor = 20;

/// Work of a board in its share of a tick.
struct WorkBudget {
  std::uint64_t work = kAnyWork;  // comp/verify.h, work_of
  std::uint64_t of_line = 0;      // work that a line of memory costs which no cache holds (lines_of)

  /// Whether an image does not ask for more: its tick, and with its shares kShareWorkFactor times as much.
  /// setup.
  bool covers(const Program& program, const ShareProgram& shares) const noexcept;
};

/// Work that this board does in a quarter of a tick; the rest is for devices, the link and the other tasks of
/// its processor. Measured for some milliseconds on sums of products, and on jumps through `memory` (its
/// words are overwritten), which must be larger than the caches. Without memory, cache lines have no cost, as
/// on a processor without caches. The best of several tries counts, because the others were interrupted.
/// kAnyWork if the clock does not move. Call before the first tick. setup.
WorkBudget measured_work_budget(Clock& clock, TimeUs tick, std::span<std::uint32_t> memory = {}) noexcept;

/// Words of `memory` that exceed the caches of boards: 16 MB.
constexpr std::size_t kWordsBeyondCaches = std::size_t{1} << 22;

}  // namespace vernier
