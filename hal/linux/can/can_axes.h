// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/axis_reader.h"
#include "hal/linux/can/can_axis_frame.h"

namespace vernier {

/// Counters of the frames on the bus; each counter only increases.
struct CanCounts {
  std::uint64_t frames = 0;      // taken as the newest position of an axis
  std::uint64_t malformed = 0;   // not 8 bytes, remote, or an identifier that was not requested
  std::uint64_t duplicates = 0;  // the counter of the frame before
  std::uint64_t late = 0;        // a counter before that of the newest frame
  std::uint64_t lost = 0;        // counters that were left out
  std::uint64_t restarts = 0;    // the counter restarted
  std::uint64_t invalid = 0;     // frames that are marked as invalid
  std::uint64_t stalled = 0;     // frames whose stamp has stood still
  std::uint64_t bus_errors = 0;  // error frames: bus off, restarted
  std::uint64_t broken = 0;      // ticks in which the socket failed (interface down or gone)
};

/// Axis positions over SocketCAN, one frame per axis and controller cycle (CanAxisFrame). The frames contain
/// only positions: the firmware derives the motion. Axis i is the frame with the i-th identifier.
class CanAxes : public PositionReader {
 public:
  static constexpr std::uint32_t kMostFrames = 256;   // taken from the socket in one tick
  static constexpr std::uint32_t kStalledFrames = 3;  // frames with one and the same stamp that are accepted

  /// interface: for example "can0"; ids: 11 bits, or 29 bits above 0x7ff, all different, at least one.
  /// Returns null with `error` set if the kernel refuses the socket. Not real-time safe.
  static std::unique_ptr<CanAxes> open(const std::string& interface, const std::vector<std::uint32_t>& ids,
                                       std::string& error);
  /// Takes ownership of the socket. Any socket is possible that preserves the boundaries of frames, does not
  /// block, and transmits frames as the kernel's can_frame. Not real-time safe.
  CanAxes(int socket, const std::vector<std::uint32_t>& ids);
  ~CanAxes() override;
  CanAxes(const CanAxes&) = delete;
  CanAxes& operator=(const CanAxes&) = delete;

  /// Takes the frames since the last call, at most kMostFrames, without waiting. Real-time safe.
  void begin_tick() noexcept override;
  /// kNoReading: no new, valid frame of this axis since the previous tick. Real-time safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;

  const CanCounts& counts() const noexcept { return counts_; }

 private:
  struct Axis {
    std::uint32_t id = 0;  // as in can_frame, with the flag of long identifiers
    CanAxisFrame newest;
    bool known = false;  // a frame has come
    bool fresh = false;  // in this tick
    std::uint32_t same_stamp = 0;
    std::uint8_t late_counter = 0;  // of the last late frame
    std::uint32_t late_in_row = 0;  // late frames whose counters follow each other
  };

  void take(std::uint32_t id, const CanAxisFrame& frame) noexcept;
  bool in_order(Axis& axis, std::uint8_t counter) noexcept;
  bool restarted(Axis& axis, std::uint8_t counter) noexcept;

  int socket_;
  std::vector<Axis> axes_;
  CanCounts counts_;
};

}  // namespace vernier
