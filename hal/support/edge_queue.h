// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "hal/probe_line.h"

namespace vernier {

/// Queue of the edges of a probe signal that were received but not yet read. EdgeQueue keeps the order of the
/// edges and records where edges are missing. The contact of a probe closes and opens alternately: if two
/// edges of the same kind follow each other, an edge between these two edges is lost. If the kernel numbers
/// the edges, every loss of an edge is detected.
class EdgeQueue {
 public:
  static constexpr std::uint32_t kRoom = 128;
  static constexpr std::uint32_t kNoNumber = 0;

  /// Adds an edge. `number`: number that the device gave to the edge. The number of the edges increases by
  /// one with each edge. A device never gives the number 0. The value kNoNumber (0) means that the device
  /// does not number its edges. If the queue is full, the edge is dropped and reported as lost. Real-time
  /// safe.
  void put(const ProbeEdge& edge, std::uint32_t number = kNoNumber) noexcept {
    if (count_ == kRoom) return put_loss();
    const bool out_of_turn = known_ && edge.made == last_made_;
    const bool gap = known_ && number != kNoNumber && number != last_number_ + 1;
    entries_[(first_ + count_) % kRoom] = {edge, loss_ || out_of_turn || gap};
    ++count_;
    loss_ = false;
    known_ = true;
    last_made_ = edge.made;
    last_number_ = number;
  }
  /// Records that edges were lost after the last edge in the queue. Real-time safe.
  void put_loss() noexcept {
    loss_ = true;
    known_ = false;
  }
  /// Reads the oldest edge. The function take() returns kNoReading if the queue is empty, and kRefused if
  /// edges are missing before the next edge. The call after kRefused continues with the next edge. Real-time
  /// safe.
  HalFault take(ProbeEdge& edge) noexcept {
    bool& missing = count_ > 0 ? entries_[first_].after_loss : loss_;
    if (missing) {
      missing = false;
      ++losses_;
      return HalFault::kRefused;
    }
    if (count_ == 0) return HalFault::kNoReading;
    edge = entries_[first_].edge;
    first_ = (first_ + 1) % kRoom;
    --count_;
    return HalFault::kNone;
  }
  bool empty() const noexcept { return count_ == 0 && !loss_; }
  /// Returns the number of edges that can be added before the queue is full.
  std::uint32_t room() const noexcept { return kRoom - count_; }
  /// Returns the number of gaps in the sequence of edges since the start. The number never decreases.
  std::uint64_t losses() const noexcept { return losses_; }

 private:
  struct Entry {
    ProbeEdge edge;
    bool after_loss = false;
  };

  Entry entries_[kRoom];
  std::uint32_t first_ = 0, count_ = 0;
  std::uint32_t last_number_ = 0;
  bool known_ = false, last_made_ = false, loss_ = false;
  std::uint64_t losses_ = 0;
};

}  // namespace vernier
