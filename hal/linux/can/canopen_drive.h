// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <linux/can.h>

#include <cstdint>

#include "hal/clock.h"
#include "hal/fault.h"

namespace vernier {

/// Identifiers and times of one drive on a CANopen bus. The board is a node without NMT. A master on the bus
/// starts the drive and sends SYNC. Sources: CiA 301 (predefined connection set, 7.3.3), CiA 402 (default
/// PDOs).
struct CanopenSettings {
  std::uint32_t sync = 0x80;              // SYNC
  std::uint32_t emergency = 0x81;         // EMCY: 0x80 + node
  std::uint32_t heartbeat = 0x701;        // NMT error control: 0x700 + node
  std::uint32_t tpdo = 0x381;             // statusword (16 bits), position actual value (32 bits)
  std::uint32_t rpdo = 0x501;             // offset of the position (32 bits)
  InstantNs sync_timeout{20'000'000};     // longest permitted time without SYNC, and without the TPDO
  InstantNs heartbeat_time{200'000'000};  // longest permitted time without a heartbeat
  /// Largest change of the offset from one SYNC to the next, in parts of a count of the object. A limit that
  /// is not a whole number of counts is kept as a mean over several SYNCs.
  static constexpr std::int64_t kPartsOfCount = 1 << 20;
  std::int64_t parts_per_sync = kPartsOfCount;
};

/// Counters of one drive. The counters never decrease.
struct CanopenCounts {
  std::uint64_t syncs = 0, positions = 0;
  std::uint64_t offsets = 0;      // offsets that were sent
  std::uint64_t refused = 0;      // offsets that the bus refused (no room, interface down)
  std::uint64_t malformed = 0;    // frames with a wrong length, remote or extended frames, and unknown frames
  std::uint64_t emergencies = 0;  // emergency frames with an error code other than "no error"
  std::uint64_t not_enabled = 0;  // offsets that were required while the drive was not in the state Operation
                                  // enabled
  std::uint64_t foreign = 0;      // frames with the board's identifier that another node sent
  std::uint64_t bus_errors = 0;   // number of bus-off states
  std::uint64_t losses = 0;       // losses of SYNC, TPDO, heartbeat or the state Operational; EMCY frames;
                                  // bus off
  std::uint16_t last_emergency = 0;
};

/// State machine of one CiA 402 drive and of the offset that the board sends to it. The class
/// CanopenDrive processes frames and uses no device itself.
///
/// The drive uses an offset from the next SYNC on (RPDO transmission type 0 to 240). The board also receives
/// its own frames in their order on the bus. The board therefore detects if a SYNC comes before an offset
/// that waits for the bus.
///   Operation enabled                    the offset follows, within parts_per_sync; it stays while
///                                        the drive leaves out a TPDO
///   Quick stop, fault reaction           the offset goes to zero within parts_per_sync: the drive moves
///   any other state, in one TPDO         the offset stays: a wrong bit of a statusword makes no step
///   any other state, in two TPDOs        zero: the drive has no torque
///   after a loss                         one write is refused; then the offset only decreases, until the
///                                        wanted offset is zero
///   no SYNC, TPDO or state Operational   the drive takes nothing: writes are refused, the offset stays
class CanopenDrive {
 public:
  explicit CanopenDrive(const CanopenSettings& settings) noexcept : settings_(settings) {}

  /// Takes a frame from the bus. The received frame may also be a frame that the board itself has
  /// sent. Real-time safe.
  void take(const can_frame& frame, InstantNs now) noexcept;

  struct Step {
    HalFault fault = HalFault::kNone;
    bool send = false;
    std::int32_t offset = 0;
  };
  /// Evaluates the state of the drive, and determines the offset for this tick. `wanted`: required offset in
  /// counts of the object. If the CAN bus accepted the frame with the offset, the caller must call
  /// sent(). Real-time safe.
  Step step(std::int64_t wanted, InstantNs now) noexcept;
  void sent(std::int32_t offset, InstantNs now) noexcept {
    sent_ = offset, pending_ = true, pending_since_ = now;
    if (doubt_ == Doubt::kRepeat) doubt_ = Doubt::kOnItsWay;
    ++counts_.offsets;
  }
  /// Call this function if the CAN bus did not accept the frame with the offset. Real-time safe.
  void not_sent() noexcept { ++counts_.refused; }
  /// Sets the offset that the drive has from an earlier run. Not real-time safe.
  void begin_with(std::int32_t offset) noexcept { sent_ = on_bus_ = applied_ = offset; }

  /// Reads the newest position actual value that came since the last call of begin_tick(). Returns
  /// false if no position actual value came from the drive. Real-time safe.
  bool position(std::int32_t& value) const noexcept {
    if (fresh_) value = position_;
    return fresh_;
  }
  void begin_tick() noexcept { fresh_ = false; }

  /// Returns the offset that the drive has, or will have with the next SYNC. Real-time safe.
  std::int32_t offset() const noexcept { return sent_; }
  /// True if the drive used the newest offset at a SYNC. Real-time safe.
  bool has_newest_offset() const noexcept { return on_bus_ == sent_ && applied_ == sent_; }
  /// True if the last change of the offset was sent to the drive without any limitation. Real-time
  /// safe.
  bool follows() const noexcept { return follows_; }
  /// Returns the name of the missing signal ("SYNC", "the heartbeat", ...), or null if no signal is missing.
  /// Not real-time safe.
  const char* missing(InstantNs now) const noexcept;
  bool enabled() const noexcept { return (status_ & kStateMask) == kOperationEnabled; }
  std::uint16_t status() const noexcept { return status_; }
  const CanopenCounts& counts() const noexcept { return counts_; }

  /// Statusword, CiA 402: state in bits 0 to 3, 5 and 6.
  static constexpr std::uint16_t kStateMask = 0x6f, kOperationEnabled = 0x27, kQuickStopActive = 0x07;
  static constexpr std::uint16_t kReactionMask = 0x4f, kFaultReactionActive = 0x0f;
  static constexpr std::uint8_t kOffsetBytes = 4;
  /// NMT state in a heartbeat, CiA 301.
  static constexpr std::uint8_t kBootUp = 0x00, kOperational = 0x05;

 private:
  /// Time at which a signal was last received.
  struct Heard {
    InstantNs at;
    bool known = false;
    void now(InstantNs when) noexcept { at = when, known = true; }
    bool within(InstantNs now, InstantNs time) const noexcept { return known && now - at <= time; }
  };

  /// State that shows whether the drive has the newest offset. An offset for a drive that did not
  /// accept offsets is sent once more, is received back, and is used at a SYNC to which the drive
  /// answers.
  enum class Doubt : std::uint8_t { kNone, kRepeat, kOnItsWay, kInDrive };

  void take_heartbeat(const can_frame& frame, InstantNs now) noexcept;
  void take_emergency(const can_frame& frame) noexcept;
  void take_own(const can_frame& frame, InstantNs now) noexcept;
  void take_status(const can_frame& frame, InstantNs now) noexcept;
  bool takes_offsets(InstantNs now) const noexcept;
  bool is_stuck(InstantNs now) const noexcept;
  bool is_well(InstantNs now) const noexcept;
  std::int64_t goal(std::int64_t wanted, bool well) noexcept;
  void forget() noexcept;
  void give_allowance(std::int64_t moved) noexcept;
  static bool has_torque(std::uint16_t status) noexcept {
    return (status & kStateMask) == kOperationEnabled || (status & kStateMask) == kQuickStopActive ||
           (status & kReactionMask) == kFaultReactionActive;
  }

  static constexpr std::uint8_t kSure = 2;  // number of successive TPDOs without torque that are not
                                            // explained by a wrong bit
  CanopenSettings settings_;
  Heard sync_, heartbeat_, tpdo_, foreign_, step_;
  std::uint8_t nmt_ = kBootUp;
  std::uint16_t status_ = 0;
  std::uint8_t without_torque_ = kSure;  // number of newest successive TPDOs without torque, at most kSure
  bool emergency_ = false, bus_off_ = false;
  bool synced_ = false;    // true: a SYNC has come since the last step
  bool answered_ = false;  // true: a TPDO has come since the last SYNC
  Doubt doubt_ = Doubt::kRepeat;
  bool well_ = false;    // state of the drive at the last step
  bool refuse_ = false;  // true: the tick does not yet know of a loss
  bool fading_ = false;  // true: after a loss, the board still removes its correction
  bool follows_ = true, fresh_ = false;
  std::int32_t position_ = 0;
  std::int32_t applied_ = 0;                                 // offset that was used at the last SYNC
  std::int32_t on_bus_ = 0;                                  // newest offset that was received back from the
                                                             // bus
  std::int32_t sent_ = 0;                                    // newest offset that was sent
  std::int64_t allowance_ = CanopenSettings::kPartsOfCount;  // permitted change until the next SYNC, in parts
                                                             // of a count
  bool pending_ = false;                                     // true: the sent offset was not yet received
                                                             // back
  InstantNs pending_since_;
  CanopenCounts counts_;
};

}  // namespace vernier
