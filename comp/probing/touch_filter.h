// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"

namespace vernier {

/// Kind of an event that TouchFilter detects in the signal of a touch probe.
enum class TouchKind : std::uint8_t {
  kTouch = 0,           // the contact closed, and stayed closed until the end of the settling time
  kReleaseMissing = 1,  // a touch, but the contact had not opened since the previous touch: an edge was lost
  kMissed = 2,          // the contact opened without having closed: the touch was lost, and its time is
                        // unknown
};

/// One contact of the probe with the workpiece.
struct Touch {
  InstantNs at;  // time of the first edge of the contact; for kMissed: time of the edge that opened the
                 // contact
  TouchKind kind = TouchKind::kTouch;
  std::uint8_t bounces = 0;  // number of further closing edges during the settling time, at most 255
};

/// Counters of the edges and contacts of a probe signal. The counters never decrease.
struct TouchCounts {
  std::uint32_t touches = 0;
  std::uint32_t spikes = 0;   // contacts that were open again at the end of the settling time: no touch
  std::uint32_t bounces = 0;  // edges during the settling time, closing or opening
  std::uint32_t missing = 0;  // touches or releases that were lost
};

/// Converts the edges of a probe signal to touches. The time of a touch is the time of the first edge of the
/// contact. Bounces during the settling time are ignored. A contact that does not last is counted as a spike.
/// The computing time of TouchFilter is limited, and it uses no heap memory.
class TouchFilter {
 public:
  /// `settle`: settling time after a change of the contact, >= 0. Later edges within the settling
  /// time belong to the same contact of the probe. Not real-time safe.
  explicit TouchFilter(InstantNs settle = InstantNs(1'000'000)) noexcept : settle_(settle) {}

  /// Processes one edge of the probe signal. `at`: time of the edge, not earlier than the previous edge. The
  /// function edge() returns true and sets `touch` if the settling time of a touch ends at this edge.
  /// Real-time safe.
  bool edge(InstantNs at, bool made, Touch& touch) noexcept;
  /// Call wait() if time passes without an edge. Returns true and sets `touch` if the settling time of the
  /// last contact has ended at `now`. Real-time safe.
  bool wait(InstantNs now, Touch& touch) noexcept;

  const TouchCounts& counts() const noexcept { return counts_; }

 private:
  enum class State : std::uint8_t { kOpen, kClosing, kClosed, kOpening };
  bool conclude(InstantNs until, Touch& touch) noexcept;

  InstantNs settle_;
  State state_ = State::kOpen;
  bool made_ = false;  // level of the signal after the last edge
  Touch pending_;      // the touch during its settling time
  InstantNs since_;    // time of the first edge of the change
  TouchCounts counts_;
};

}  // namespace vernier
