// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"

namespace vernier {

/// Counters of a probe's line.
enum class TouchKind : std::uint8_t {
  kTouch = 0,           // closed, and stayed closed through the settling time
  kReleaseMissing = 1,  // a touch, but the line had not opened since the one before: an edge was lost
  kMissed = 2,          // the line opened without having closed: the touch was lost, its instant is unknown
};

/// One contact of the probe with the workpiece.
struct Touch {
  InstantNs at;  // first edge of the contact; of kMissed: the edge that opened it
  TouchKind kind = TouchKind::kTouch;
  std::uint8_t bounces = 0;  // further closing edges while it settled, at most 255
};

/// Counters of the edges and contacts of a probe's line; each counter only increases.
struct TouchCounts {
  std::uint32_t touches = 0;
  std::uint32_t spikes = 0;   // closed and open again when the settling time was over: no touch
  std::uint32_t bounces = 0;  // edges while the contact settled, closing or opening
  std::uint32_t missing = 0;  // touches or releases that were lost
};

/// Converts edges to touches. The first edge of a contact counts. Bounces before the contact has settled are
/// ignored; an edge that does not last is counted as a spike. Bounded, no heap.
class TouchFilter {
 public:
  /// settle: time after a change of the contact; later edges within this time belong to the same contact, >=
  /// 0. Not real-time safe.
  explicit TouchFilter(InstantNs settle = InstantNs(1'000'000)) noexcept : settle_(settle) {}

  /// Processes an edge of the probe's signal. at: time of the edge, not earlier than the previous edge.
  /// edge() returns true and fills `touch` if the settling time of a touch is over at this edge. Real-time
  /// safe.
  bool edge(InstantNs at, bool made, Touch& touch) noexcept;
  /// Call wait() when time passes without an edge. Returns true and fills `touch` if the last contact has
  /// settled at `now`. Real-time safe.
  bool wait(InstantNs now, Touch& touch) noexcept;

  const TouchCounts& counts() const noexcept { return counts_; }

 private:
  enum class State : std::uint8_t { kOpen, kClosing, kClosed, kOpening };
  bool conclude(InstantNs until, Touch& touch) noexcept;

  InstantNs settle_;
  State state_ = State::kOpen;
  bool made_ = false;  // level after the last edge
  Touch pending_;      // while closing
  InstantNs since_;    // first edge of the change
  TouchCounts counts_;
};

}  // namespace vernier
