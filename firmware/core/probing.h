// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/probing/latch.h"
#include "comp/probing/touch_filter.h"
#include "comp/probing/workpiece_frame.h"
#include "firmware/core/cycle/cycle.h"
#include "firmware/core/cycle/exchange.h"
#include "hal/probe_line.h"

namespace vernier {

/// Wiring and delay of a probe.
struct ProbeSettings {
  InstantNs delay;         // from contact to edge: trigger, filter, radio; 0 .. 50 ms
  InstantNs delay_spread;  // its standard deviation from touch to touch
  InstantNs position_age;  // how old a reading of the axes is when a tick gets it; 0 .. 50 ms
  InstantNs age_spread;    // its standard deviation
  InstantNs settle{1'000'000};
  std::uint32_t axes = 0;                                // of the board
  bool rollover[kMaxAxes] = {};                          // whole turns of the axis do not count
  std::uint8_t xyz[3] = {kMaxAxes, kMaxAxes, kMaxAxes};  // board's axes X, Y, Z; kMaxAxes: no such axis

  /// Returns the standard uncertainty of the instant of a touch. resolution: resolution of the time stamp of
  /// the edge. Not real-time safe.
  InstantNs time_uncertainty(InstantNs resolution) const noexcept;
};

/// Converts edges of the probe to positions. After each tick new edges become touches. Each touch becomes the
/// position of the axes at the moment of contact, twice: as the controller counts, and compensated. A touch
/// is published after its settling time and at most two ticks after that time.
class Probing {
 public:
  static constexpr std::uint32_t kMostEdges = 16;  // taken in one tick
  static constexpr std::uint32_t kMostWaiting = 8;

  /// line: outlives this object. actual: gives the positions of the axes in a tick, and outlives this object;
  /// null: the positions that the cycle read. Not real-time safe.
  Probing(ProbeLine& line, const ProbeSettings& settings, AxisReader* actual = nullptr) noexcept;

  /// Sets the delay from contact to edge, for later edges: 0 .. 50 ms. Real-time safe.
  void set_delay(InstantNs delay) noexcept { settings_.delay = delay; }

  /// Call after a tick that has read its axes at `woke` and written its corrections. time: the t of the
  /// machine file in this tick. Real-time safe.
  void after_tick(const Cycle& cycle, const TickReport& report, InstantNs woke, TimeUs time,
                  Exchange& exchange) noexcept;

 private:
  void sample(const Cycle& cycle, const TickReport& report, InstantNs woke) noexcept;
  void take_edges(InstantNs woke) noexcept;
  void wait_for(const Touch& touch) noexcept;
  bool publish(const Touch& touch, InstantNs zero, const WorkpieceFrame& frame, Exchange& exchange) noexcept;

  ProbeLine& line_;
  ProbeSettings settings_;
  AxisReader* actual_;
  InstantNs time_uncertainty_;
  LatchRing ring_;
  TouchFilter filter_;
  Touch waiting_[kMostWaiting];
  std::uint32_t first_ = 0, waiting_count_ = 0;
  std::uint32_t lost_edges_ = 0, lost_touches_ = 0;
  std::uint8_t state_ = 0;  // TouchFlag bits that hold for the sample ring
};

}  // namespace vernier
