// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/clock.h"
#include "hal/fault.h"

namespace vernier {

/// An edge in the signal of a touch probe. The polarity is already applied.
struct ProbeEdge {
  InstantNs at;       // time of the edge by the clock of the board, as accurate as the device can record it
  bool made = false;  // true: the contact was made; false: the contact was released
};

/// The digital line on which a touch probe signals a touch.
class ProbeLine {
 public:
  virtual ~ProbeLine() = default;
  /// Reads the oldest edge that was not yet read. The function read_edge() returns kNoReading if no edge is
  /// waiting. The function read_edge() returns kRefused if edges were lost since the last call. The next call
  /// continues with the remaining edges. The function read_edge() never waits. Real-time safe.
  virtual HalFault read_edge(ProbeEdge& edge) noexcept = 0;
  /// Returns the largest time between the recorded time `at` and the edge; 0 if the device does not know this
  /// time. Not real-time safe.
  virtual InstantNs resolution() const noexcept = 0;
};

}  // namespace vernier
