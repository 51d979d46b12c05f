// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "hal/linux/can/canopen_drive.h"
#include "hal/linux/can/canopen_sdo.h"
#include "hal/linux/output_device.h"

namespace vernier {

/// Address of a drive, and the method of testing its PDOs.
struct CanopenPlace {
  std::string interface;  // as for open_can()
  std::uint32_t node = 1;
  CanopenObject object;   // that takes the offset, 32 bits
  bool test_pdos = true;  // compare the PDO settings of the drive by SDO; else they are not known
};

/// The correction of one axis as the position offset of a CiA 402 drive, sent by PDO in the tick: no thread
/// and no wait. Rules: CanopenDrive.
class CanopenOutput : public OutputDevice {
 public:
  /// Returns null with `error` set if the CAN bus does not exist, or if the PDOs of the drive differ from
  /// `settings`. Not real-time safe.
  static std::unique_ptr<CanopenOutput> open(const CanopenPlace& place, const CanopenSettings& settings,
                                             const AnalogueScale& scale, std::string& error);
  /// Takes ownership of the socket. Any socket is possible that preserves the boundaries of frames and does
  /// not block. Not real-time safe.
  CanopenOutput(int socket, const CanopenPlace& place, const CanopenSettings& settings,
                const AnalogueScale& scale);
  ~CanopenOutput() override;
  CanopenOutput(const CanopenOutput&) = delete;
  CanopenOutput& operator=(const CanopenOutput&) = delete;

  /// kRefused: the drive does not accept an offset (no SYNC, bus off), or a loss must be reported to the
  /// tick. Real-time safe.
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;
  /// The correction that the drive has, if it does not follow. Real-time safe.
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override;

  /// False if another node sends the RPDO. Listens for some SYNC periods. Not real-time safe.
  bool lock() noexcept override;
  /// The offset that the drive has, by SDO. Not real-time safe.
  HalFault read_back(std::uint32_t axis, AxisTravel& correction) noexcept override;
  std::string attempt(std::uint32_t axis) override;
  std::string trial() const override;
  std::uint64_t held_at_end(std::uint32_t) const noexcept override { return held_at_end_; }
  const AnalogueScale& scale(std::uint32_t) const noexcept override { return converter_.scale(); }
  std::string account() const override;
  const CanopenDrive& drive() const noexcept { return drive_; }

  static constexpr int kMostFrames = 256;  // taken from the socket in one tick

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
  bool known_ = false;  // read_back() found the drive's own offset
  std::int32_t before_ = 0;
};

}  // namespace vernier
