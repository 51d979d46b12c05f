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

/// Connections and delays of a touch probe.
struct ProbeSettings {
  InstantNs delay;         // delay from contact to edge (trigger, filter, radio), 0 to 50 ms
  InstantNs delay_spread;  // standard deviation of this delay from touch to touch
  InstantNs position_age;  // age of an axis reading when the tick receives it, 0 to 50 ms
  InstantNs age_spread;    // standard deviation of this age
  InstantNs settle{1'000'000};
  std::uint32_t axes = 0;        // number of axes of the board
  bool rollover[kMaxAxes] = {};  // true: whole turns of the axis do not count
  /// Indices of the board's axes X, Y, Z; kMaxAxes: there is no such axis
  std::uint8_t xyz[3] = {kMaxAxes, kMaxAxes, kMaxAxes};

  /// Returns the standard uncertainty of the time of a touch. `resolution`: resolution of the time stamp of
  /// the edge. Not real-time safe.
  InstantNs time_uncertainty(InstantNs resolution) const noexcept;
};

/// Converts the signal edges of a touch probe to positions. After each tick, new edges of the probe signal
/// become touches. For each touch, the position of the axes at the moment of contact is computed in two
/// forms: as the controller counts, and compensated. A touch is published after its settling time, and at
/// most two ticks later.
class Probing {
 public:
  static constexpr std::uint32_t kMostEdges = 16;  // largest number of edges in one tick
  static constexpr std::uint32_t kMostWaiting = 8;

  /// `line`: input of the probe; it must exist longer than this object. `actual`: gives the positions of the
  /// axes in a tick, and must exist longer than this object; null: the positions that the cycle read are
  /// used. Not real-time safe.
  Probing(ProbeLine& line, const ProbeSettings& settings, AxisReader* actual = nullptr) noexcept;

  /// Sets the delay from contact to edge for later edges, 0 to 50 ms. Real-time safe.
  void set_delay(InstantNs delay) noexcept { settings_.delay = delay; }

  /// Call after_tick() after a tick that read its axes at the time `woke` and wrote its corrections. `time`:
  /// time t of the machine file in this tick. Real-time safe.
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
  std::uint8_t state_ = 0;  // TouchFlag bits that are valid for all samples in the ring
};

}  // namespace vernier
