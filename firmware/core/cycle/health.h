// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Counters of the firmware. The counters never decrease; clearing a fault does not change them.
struct Health {
  std::uint64_t ticks = 0;
  std::uint64_t active_ticks = 0;
  std::uint64_t overruns = 0;          // ticks that ended after the next was due
  std::uint64_t skipped = 0;           // ticks left out to catch up
  std::uint64_t missing_readings = 0;  // of an axis or the path
  std::uint64_t missing_inputs = 0;
  std::uint64_t frozen_readings = 0;
  std::uint64_t jumps = 0;
  std::uint64_t unreferenced = 0;  // readings of an axis that lost its reference
  std::uint64_t implausible = 0;   // readings of a sensor
  std::uint64_t failed_writes = 0;
  std::uint64_t saturated = 0;     // ticks with a correction at its limit
  std::uint64_t slewing = 0;       // ticks with a correction on its way
  std::uint64_t beyond_range = 0;  // ticks with a channel beyond its declared range
  std::uint64_t faults = 0;        // latched so far
  std::uint64_t refused_commands = 0;
  std::uint64_t programs = 0;  // taken over while running
};

}  // namespace vernier
