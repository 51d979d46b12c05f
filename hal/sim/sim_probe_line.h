// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/support/edge_queue.h"

namespace vernier {

/// The line of a touch probe for tests. The test adds edges with times of the board's clock. The function
/// read_edge returns an edge even if its time is in the future.
class SimProbeLine : public ProbeLine {
 public:
  /// `resolution`: largest difference between the recorded times and the edges.
  explicit SimProbeLine(InstantNs resolution = InstantNs{}) : resolution_(resolution) {}

  void put(InstantNs at, bool made) noexcept { queue_.put({at, made}); }
  void put_loss() noexcept { queue_.put_loss(); }
  HalFault read_edge(ProbeEdge& edge) noexcept override { return queue_.take(edge); }
  InstantNs resolution() const noexcept override { return resolution_; }

 private:
  EdgeQueue queue_;
  InstantNs resolution_;
};

}  // namespace vernier
