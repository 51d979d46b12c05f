// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "hal/linux/can/canopen_drive.h"
#include "hal/linux/can/canopen_sdo.h"
#include "hal/linux/output_device.h"

namespace vernier {

/// Address of a drive, and the method to test its PDOs.
struct CanopenPlace {
  std::string interface;  // interface as for open_can()
  std::uint32_t node = 1;
  CanopenObject object;   // object that receives the offset, 32 bits
  bool test_pdos = true;  // true: the PDO settings of the drive are compared by SDO; false: they are unknown
};

/// The correction of one axis as the position offset of a CiA 402 drive. The tick sends the
/// position offset by PDO, without a thread and without waiting. The rules for the offset are those
/// of CanopenDrive.
class CanopenOutput : public OutputDevice {
 public:
  /// Returns null, and the reason in `error`, if the CAN bus does not exist, or if the PDOs of the drive
  /// differ from `settings`. Not real-time safe.
  static std::unique_ptr<CanopenOutput> open(const CanopenPlace& place, const CanopenSettings& settings,
                                             const AnalogueScale& scale, std::string& error);
  /// Takes ownership of the socket. The socket must preserve the boundaries of frames and must not block. Not
  /// real-time safe.
  CanopenOutput(int socket, const CanopenPlace& place, const CanopenSettings& settings,
                const AnalogueScale& scale);
  ~CanopenOutput() override;
  CanopenOutput(const CanopenOutput&) = delete;
  CanopenOutput& operator=(const CanopenOutput&) = delete;

  /// The function write_correction() returns kRefused if the drive does not accept an offset (no SYNC, bus
  /// off), or if a loss must be reported to the tick. Real-time safe.
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;
  /// If the drive does not follow the required correction, returns the correction that the drive
  /// has at present. Real-time safe.
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override;

  /// Returns false if another node of the CAN bus sends the RPDO of the drive. lock() listens to
  /// the bus for some SYNC periods. Not real-time safe.
  bool lock() noexcept override;
  /// Reads the present position offset of the drive by SDO. Not real-time safe.
  HalFault read_back(std::uint32_t axis, AxisTravel& correction) noexcept override;
  std::string attempt(std::uint32_t axis) override;
  std::string trial() const override;
  bool has_arrived(std::uint32_t) const noexcept override { return drive_.has_newest_offset(); }
  std::uint64_t held_at_end(std::uint32_t) const noexcept override { return held_at_end_; }
  const AnalogueScale& scale(std::uint32_t) const noexcept override { return converter_.scale(); }
  std::string account() const override;
  const CanopenDrive& drive() const noexcept { return drive_; }

  static constexpr int kMostFrames = 256;  // largest number of frames that one tick reads from the socket

 private:
  void drain(InstantNs now) noexcept;
  bool send(std::int32_t offset) noexcept;
  std::string listen(TimeUs time, bool until_complete) noexcept;
  std::int32_t number_of(AxisTravel correction) const noexcept;

  int socket_;
  CanopenPlace place_;
  CanopenSettings settings_;
  AnalogueConverter converter_;
  CanopenDrive drive_;
  std::uint64_t held_at_end_ = 0;
  bool known_ = false;  // true: read_back() found the offset that the drive already had
  std::int32_t before_ = 0;
};

}  // namespace vernier
