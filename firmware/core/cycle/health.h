// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Counters of the firmware. The health counters of the firmware never decrease; clearing a fault
/// does not change these counters.
struct Health {
  std::uint64_t ticks = 0;
  std::uint64_t active_ticks = 0;
  std::uint64_t overruns = 0;          // ticks that ended after the next tick was due
  std::uint64_t skipped = 0;           // ticks that were omitted after an overrun
  std::uint64_t missing_readings = 0;  // missing readings of an axis or of the path
  std::uint64_t missing_inputs = 0;
  std::uint64_t frozen_readings = 0;
  std::uint64_t jumps = 0;
  std::uint64_t unreferenced = 0;  // readings of an axis without reference
  std::uint64_t implausible = 0;   // readings of a sensor beyond its limits
  std::uint64_t failed_writes = 0;
  std::uint64_t saturated = 0;     // ticks in which a correction was at its limit
  std::uint64_t slewing = 0;       // ticks in which a correction was still moving to its target
  std::uint64_t beyond_range = 0;  // ticks in which a channel was beyond its declared range
  std::uint64_t faults = 0;        // number of faults that were latched
  std::uint64_t refused_commands = 0;
  std::uint64_t programs = 0;  // number of programs that replaced another program while the board was running
};

}  // namespace vernier
