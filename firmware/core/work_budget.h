// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "hal/clock.h"

namespace vernier {

constexpr std::uint64_t kAnyWork = UINT64_MAX;
/// Shares are worked out outside the tick, for a display: they may be so many times as much work as a tick.
constexpr std::uint64_t kShareWorkFactor = 20;

/// Work (comp/verify.h, work_of) that this board does in a quarter of a tick: the rest is for devices, the
/// link and what else its processor has to do. Measured on sums of products, for some milliseconds; the best
/// of several tries counts, as the others were interrupted. Where the clock does not move, kAnyWork. Before
/// the first tick. setup.
std::uint64_t measured_work_budget(Clock& clock, TimeUs tick) noexcept;

}  // namespace vernier
