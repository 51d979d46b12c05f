// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/clock.h"
#include "hal/fault.h"

namespace vernier {

/// An edge of a probe's line, polarity already undone.
struct ProbeEdge {
  InstantNs at;       // by the board's clock, as near to the edge as the device can stamp it
  bool made = false;  // the probe touched; false: it let go
};

/// The line on which a touch probe reports a touch.
class ProbeLine {
 public:
  virtual ~ProbeLine() = default;
  /// Reads the oldest edge that has not been read yet. kNoReading: no edge is waiting. kRefused: edges were
  /// lost since the last call; the next call continues with the remaining edges. read_edge() never waits.
  /// Real-time safe.
  virtual HalFault read_edge(ProbeEdge& edge) noexcept = 0;
  /// Returns the largest time between `at` and the edge; 0 if the device does not know this time.
  /// Not real-time safe.
  virtual InstantNs resolution() const noexcept = 0;
};

}  // namespace vernier
