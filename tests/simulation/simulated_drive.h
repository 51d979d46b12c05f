// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A CiA 402 drive on a CANopen bus with its master, in the world's time: both fail.
#include <cstdint>
#include <memory>
#include <random>

#include "hal/correction_writer.h"
#include "hal/linux/can/canopen_drive.h"

namespace vernier::simulation {

/// What was injected into the drive and its bus.
struct DriveCounts {
  std::uint64_t syncs_lost = 0, positions_lost = 0, heartbeats_lost = 0, cuts = 0, emergencies = 0,
                disabled = 0, restarts = 0, overtaken = 0;
  std::uint64_t all() const {
    return syncs_lost + positions_lost + heartbeats_lost + cuts + emergencies + disabled + restarts +
           overtaken;
  }
};

/// The drive's offset is the board's correction in nm. The board's side is CanopenDrive.
class SimulatedDrive : public CorrectionWriter {
 public:
  /// most: largest change of the correction in a tick, nm.
  SimulatedDrive(std::mt19937_64& random, TimeUs tick, std::int64_t most);

  /// The board has started again; the drive has no offset, as the daemon removes it before its first tick.
  void start();
  /// A cycle of the master and the drive: before the tick of the board.
  void cycle(InstantNs now, bool calm);
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override;

  /// The offset that the drive uses, and whether it moves its axis.
  AxisTravel offset() const { return AxisTravel(applied_); }
  bool has_torque() const { return enabled_; }
  /// The offset and the torque were there in the cycle before, too.
  bool had_torque() const { return had_torque_; }
  DriveCounts counts;

 private:
  /// A fault that lasts some ticks.
  struct Lasting {
    std::int64_t left = 0;
    bool on() const { return left > 0; }
  };
  void hurt();
  void begin(Lasting& fault, std::uint64_t& count, std::uint64_t rate);
  void arrive();
  void give(std::uint32_t id, std::initializer_list<std::uint32_t> bytes);

  std::mt19937_64& random_;
  CanopenSettings settings_;
  std::unique_ptr<CanopenDrive> board_;
  InstantNs now_;
  std::int64_t ticks_ = 0;
  Lasting no_sync_, no_position_, no_heartbeat_, cut_, emergency_, disabled_, starting_;
  bool enabled_ = true, had_torque_ = false, told_ = true;
  std::int32_t buffer_ = 0, applied_ = 0, waiting_ = 0;
  bool waits_ = false, overtakes_ = false;
};

}  // namespace vernier::simulation
