// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hal/axis_reader.h"
#include "hal/linux/can/canopen_drive.h"
#include "hal/support/wrapped_count.h"

namespace vernier {

/// Positions of CiA 402 drives: position actual value (0x6064) with the statusword in a TPDO. One socket for
/// all drives of a bus. The TPDOs contain only positions: the firmware derives the motion.
class CanopenAxes : public PositionReader {
 public:
  struct Axis {
    CanopenSettings settings;
    PositionScale scale;
  };
  static constexpr int kMostFrames = 256;  // taken from the socket in one tick

  /// Returns null with `error` set if the kernel refuses the socket. Not real-time safe.
  static std::unique_ptr<CanopenAxes> open(const std::string& interface, const std::vector<Axis>& axes,
                                           std::string& error);
  /// Takes ownership of the socket. Any socket is possible that preserves the boundaries of frames and does
  /// not block. Not real-time safe.
  CanopenAxes(int socket, const std::vector<Axis>& axes);
  ~CanopenAxes() override;
  CanopenAxes(const CanopenAxes&) = delete;
  CanopenAxes& operator=(const CanopenAxes&) = delete;

  void begin_tick() noexcept override;
  /// kNoReading: no TPDO of the drive since the previous tick. Real-time safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;
  const CanopenCounts& counts(std::uint32_t index) const noexcept { return drives_[index].drive.counts(); }

 private:
  /// The position wraps around at 32 bits, as that of a rotary table does which always turns one way.
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
