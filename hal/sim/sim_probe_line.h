// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/support/edge_queue.h"

namespace vernier {

/// A probe's line for tests: the test puts in the edges, at moments of the board's clock. read_edge delivers
/// an edge even if its moment is in the future.
class SimProbeLine : public ProbeLine {
 public:
  /// resolution: how far the stamps may be from the edges.
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
