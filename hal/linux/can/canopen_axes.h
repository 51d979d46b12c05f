// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hal/axis_reader.h"
#include "hal/linux/can/canopen_drive.h"
#include "hal/support/wrapped_count.h"

namespace vernier {

/// Reads the positions of CiA 402 drives from a TPDO with the position actual value (0x6064) and the
/// statusword. The board uses one socket for all drives of a CAN bus. The TPDOs contain only positions. The
/// firmware computes the motion from the positions.
class CanopenAxes : public PositionReader {
 public:
  struct Axis {
    CanopenSettings settings;
    PositionScale scale;
  };
  static constexpr int kMostFrames = 256;  // largest number of frames that one tick reads from the socket

  /// Returns null, and the reason in `error`, if the kernel refuses the socket. Not real-time safe.
  static std::unique_ptr<CanopenAxes> open(const std::string& interface, const std::vector<Axis>& axes,
                                           std::string& error);
  /// Takes ownership of the socket. The socket must preserve the boundaries of frames and must not block. Not
  /// real-time safe.
  CanopenAxes(int socket, const std::vector<Axis>& axes);
  ~CanopenAxes() override;
  CanopenAxes(const CanopenAxes&) = delete;
  CanopenAxes& operator=(const CanopenAxes&) = delete;

  void begin_tick() noexcept override;
  /// The function read_axis() returns kNoReading if no TPDO of the drive came since the previous tick.
  /// Real-time safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;
  const CanopenCounts& counts(std::uint32_t index) const noexcept { return drives_[index].drive.counts(); }

 private:
  /// The position of a drive wraps around at 32 bits, for example on a rotary table that always turns in one
  /// direction.
  struct Drive {
    std::uint32_t tpdo, heartbeat;
    CanopenDrive drive;
    PositionConverter converter;
    WrappedCount count{std::int64_t{1} << 32};
  };

  int socket_;
  std::vector<Drive> drives_;
};

}  // namespace vernier
