// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/shares.h"

/// Records that the tick gives to the other threads of the board, and that the board gives to its tools
/// (tables/link_format.h).
namespace vernier {

/// Data of one tick for other threads. The axes and inputs are in the order of the board. The values are in
/// counts.
struct TickRecord {
  std::int64_t time_us = 0;
  std::int64_t position[kMaxAxes] = {};
  std::int32_t correction[kMaxAxes] = {};
  std::int64_t input[kMaxInputs] = {};
  std::int64_t feed_nm_per_min = 0;
  std::int8_t sense[kMaxAxes] = {};
  std::uint8_t mode = 0, fault = 0, holding = 0, saturated = 0, reserved[4] = {};
};
static_assert(sizeof(TickRecord) % 8 == 0);

/// The corrections at the drives and their limits, for other threads. The axes are in the order of the board.
/// The values are in counts.
struct StateRecord {
  std::int64_t since_us = 0;  // time t of the machine file when the tick started the program
  std::uint32_t programs = 0, weight = 0;
  std::int32_t wanted[kMaxAxes] = {}, achieved[kMaxAxes] = {}, axis_weight[kMaxAxes] = {};
  std::uint8_t limits[kMaxAxes] = {};
};
static_assert(sizeof(StateRecord) % 8 == 0);

/// Counters and measured values of the firmware for other threads.
struct HealthRecord {
  std::uint64_t ticks = 0, active_ticks = 0, overruns = 0, skipped = 0;
  std::uint64_t missing_readings = 0, missing_inputs = 0, frozen_readings = 0, jumps = 0;
  std::uint64_t unreferenced = 0, implausible = 0, failed_writes = 0;
  std::uint64_t saturated = 0, slewing = 0, beyond_range = 0;
  std::uint64_t faults = 0, refused_commands = 0, programs = 0;
  // 50 %, 99 % and 99.9 % percentiles and maximum: of the wake-up latency, and of the execution time of a
  // tick, ns
  std::int64_t latency_ns[4] = {}, execution_ns[4] = {};
};
// Counter n of LinkOp::kHealth is the 64-bit word n of this record.
static_assert(sizeof(HealthRecord) == 200);
static_assert(offsetof(HealthRecord, ticks) == 0 && offsetof(HealthRecord, active_ticks) == 8 &&
              offsetof(HealthRecord, overruns) == 16 && offsetof(HealthRecord, skipped) == 24 &&
              offsetof(HealthRecord, missing_readings) == 32 &&
              offsetof(HealthRecord, missing_inputs) == 40 && offsetof(HealthRecord, frozen_readings) == 48 &&
              offsetof(HealthRecord, jumps) == 56 && offsetof(HealthRecord, unreferenced) == 64 &&
              offsetof(HealthRecord, implausible) == 72 && offsetof(HealthRecord, failed_writes) == 80 &&
              offsetof(HealthRecord, saturated) == 88 && offsetof(HealthRecord, slewing) == 96 &&
              offsetof(HealthRecord, beyond_range) == 104 && offsetof(HealthRecord, faults) == 112 &&
              offsetof(HealthRecord, refused_commands) == 120 && offsetof(HealthRecord, programs) == 128 &&
              offsetof(HealthRecord, latency_ns) == 136 && offsetof(HealthRecord, execution_ns) == 168);

/// Flags for the data of a touch.
enum TouchFlag : std::uint8_t {
  kTouchUncompensated = 1u << 0,  // no program ran, so that `compensated` equals `position`
  kTouchWhileFaulted = 1u << 1,   // a fault was latched during the touch
  kTouchInWorkpiece = 1u << 2,    // the board has axes X, Y, Z, so that `workpiece_nm` has values
};

/// Data of one touch of the probe for other threads. The axes are in the order of the board. The values are
/// in counts. The counters state the losses up to this touch. With these counters a reader detects
/// whether touches are missing.
struct TouchRecord {
  std::int64_t time_ns = 0;              // time of the contact, as t of the machine file
  std::int64_t position[kMaxAxes] = {};  // position in the counts of the controller
  std::int64_t compensated[kMaxAxes] =
      {};  // position of the axis with its whole correction applied, which is the position of the tool
  std::int64_t uncertainty[kMaxAxes] =
      /// Standard uncertainty from the time of the contact and from the interpolation
      {};
  std::int64_t workpiece_nm[3] = {};  // coordinates X, Y, Z in the workpiece frame
  std::uint32_t lost_edges = 0, lost_touches = 0, spikes = 0, missing = 0;
  std::uint8_t kind = 0, fault = 0, flags = 0, bounces = 0;  // TouchKind, LatchFault, TouchFlag
  std::uint8_t reserved[4] = {};
};
static_assert(sizeof(TouchRecord) % 8 == 0);

}  // namespace vernier
