// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/axis_reader.h"
#include "hal/linux/can/can_axis_frame.h"

namespace vernier {

/// Counters of the frames on the bus. The counters never decrease.
struct CanCounts {
  std::uint64_t frames = 0;      // frames that were used as the newest position of an axis
  std::uint64_t malformed = 0;   // frames that do not have 8 bytes, remote frames, and frames with an
                                 // identifier that was not requested
  std::uint64_t duplicates = 0;  // frames with the counter of the previous frame
  std::uint64_t late = 0;        // frames whose counter is before that of the newest frame
  std::uint64_t lost = 0;        // counter values that were missing
  std::uint64_t restarts = 0;    // restarts of the frame counter
  std::uint64_t invalid = 0;     // frames that are marked as invalid
  std::uint64_t stalled = 0;     // frames whose time stamp did not change
  std::uint64_t bus_errors = 0;  // error frames: bus off, bus restarted
  std::uint64_t broken = 0;      // ticks in which the socket failed (interface down or removed)
};

/// Axis positions over SocketCAN. The controller sends one frame (CanAxisFrame) per axis in each of its
/// cycles. The frames contain only positions. The firmware computes the motion from the positions. The i-th
/// identifier is that of axis i.
class CanAxes : public PositionReader {
 public:
  static constexpr std::uint32_t kMostFrames = 256;   // largest number of frames that one tick reads from the
                                                      // socket
  static constexpr std::uint32_t kStalledFrames = 3;  // number of frames with the same time stamp that are
                                                      // accepted

  /// `interface`: for example "can0"; `ids`: identifiers of 11 bits, or of 29 bits if above 0x7ff. At least
  /// one identifier is necessary, and all must be different. Returns null, and the reason in `error`, if the
  /// kernel refuses the socket. Not real-time safe.
  static std::unique_ptr<CanAxes> open(const std::string& interface, const std::vector<std::uint32_t>& ids,
                                       std::string& error);
  /// Takes ownership of the socket. The socket must preserve the boundaries of frames, must not block, and
  /// must transmit frames as the kernel's can_frame. Not real-time safe.
  CanAxes(int socket, const std::vector<std::uint32_t>& ids);
  ~CanAxes() override;
  CanAxes(const CanAxes&) = delete;
  CanAxes& operator=(const CanAxes&) = delete;

  /// Reads the frames that came since the last call, at most kMostFrames, without waiting. Real-time safe.
  void begin_tick() noexcept override;
  /// The function read_axis() returns kNoReading if no new, valid frame of this axis came since the previous
  /// tick. Real-time safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;

  const CanCounts& counts() const noexcept { return counts_; }

 private:
  struct Axis {
    std::uint32_t id = 0;  // identifier as in can_frame, with the flag of long identifiers
    CanAxisFrame newest;
    bool known = false;  // true: a frame has come
    bool fresh = false;  // true: a frame has come in this tick
    std::uint32_t same_stamp = 0;
    std::uint8_t late_counter = 0;  // counter of the last late frame
    std::uint32_t late_in_row = 0;  // number of late frames with successive counters
  };

  void take(std::uint32_t id, const CanAxisFrame& frame) noexcept;
  bool in_order(Axis& axis, std::uint8_t counter) noexcept;
  bool restarted(Axis& axis, std::uint8_t counter) noexcept;

  int socket_;
  std::vector<Axis> axes_;
  CanCounts counts_;
};

}  // namespace vernier
