// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/canopen_drive.h"

#include <linux/can/error.h>

#include <algorithm>
#include <cstdlib>

namespace vernier {
namespace {

constexpr std::uint8_t kTpdoBytes = 6, kEmergencyBytes = 8, kHeartbeatBytes = 1;
constexpr std::uint8_t kMostSyncBytes = 1;  // with the counter of CiA 301
constexpr std::uint8_t kNmtMask = 0x7f;     // bit 7: toggle of node guarding, reserved in a heartbeat
// Ticks that stand still for longer leave frames in the socket that say nothing about now.
constexpr InstantNs kLongestPause{100'000'000};

std::uint32_t little_endian(const std::uint8_t* bytes, int count) noexcept {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
  return value;
}

}  // namespace

void CanopenDrive::take(const can_frame& frame, InstantNs now) noexcept {
  if ((frame.can_id & CAN_ERR_FLAG) != 0) {
    if ((frame.can_id & CAN_ERR_BUSOFF) != 0) bus_off_ = true, ++counts_.bus_errors;
    if ((frame.can_id & CAN_ERR_RESTARTED) != 0) bus_off_ = pending_ = false;
    return;
  }
  const auto is = [&](std::uint32_t id, int least, int most) {
    return frame.can_id == id && frame.can_dlc >= least && frame.can_dlc <= most;
  };
  if (is(settings_.sync, 0, kMostSyncBytes)) {
    ++counts_.syncs;
    sync_.now(now);
    // A drive that has sent no TPDO since the SYNC before may have taken no offset either.
    synced_ = true;
    const bool confirmed = answered_;
    const std::int64_t before = applied_;
    if (confirmed) applied_ = on_bus_;
    give_allowance(std::abs(applied_ - before));
    if (!confirmed) doubt_ = Doubt::kRepeat;
    if (doubt_ == Doubt::kInDrive) doubt_ = Doubt::kNone;
    answered_ = false;
  } else if (is(settings_.tpdo, kTpdoBytes, kTpdoBytes)) {
    take_status(frame, now);
  } else if (is(settings_.heartbeat, kHeartbeatBytes, kHeartbeatBytes)) {
    take_heartbeat(frame, now);
  } else if (is(settings_.emergency, kEmergencyBytes, kEmergencyBytes)) {
    take_emergency(frame);
  } else if (frame.can_id == settings_.rpdo) {
    take_own(frame, now);
  } else {
    ++counts_.malformed;
  }
}

void CanopenDrive::take_own(const can_frame& frame, InstantNs now) noexcept {
  if (frame.can_dlc == kOffsetBytes &&
      little_endian(frame.data, kOffsetBytes) == static_cast<std::uint32_t>(sent_)) {
    on_bus_ = sent_;
    if (doubt_ == Doubt::kOnItsWay) doubt_ = Doubt::kInDrive;
    pending_ = false;
    return;
  }
  ++counts_.foreign;
  foreign_.now(now);
}

void CanopenDrive::take_status(const can_frame& frame, InstantNs now) noexcept {
  ++counts_.positions;
  tpdo_.now(now);
  status_ = static_cast<std::uint16_t>(little_endian(frame.data, 2));
  without_torque_ =
      has_torque(status_) ? 0 : static_cast<std::uint8_t>(std::min(without_torque_ + 1, int{kSure}));
  position_ = static_cast<std::int32_t>(little_endian(frame.data + 2, 4));
  fresh_ = answered_ = true;
}

// A drive that has started again has no offset, and its errors are gone.
void CanopenDrive::take_heartbeat(const can_frame& frame, InstantNs now) noexcept {
  heartbeat_.now(now);
  nmt_ = frame.data[0] & kNmtMask;
  if (nmt_ == kBootUp) sent_ = on_bus_ = applied_ = 0, emergency_ = false;
}

void CanopenDrive::take_emergency(const can_frame& frame) noexcept {
  const auto code = static_cast<std::uint16_t>(little_endian(frame.data, 2));
  emergency_ = (code & 0xff00) != 0;  // 0x00xx: error reset, or no error
  if (!emergency_) return;
  ++counts_.emergencies;
  counts_.last_emergency = code;
}

bool CanopenDrive::takes_offsets(InstantNs now) const noexcept {
  return sync_.within(now, settings_.sync_timeout) && tpdo_.within(now, settings_.sync_timeout) &&
         nmt_ == kOperational && !bus_off_ && !is_stuck(now);
}

/// The bus does not take a frame: nobody acknowledges, or frames of others come first.
bool CanopenDrive::is_stuck(InstantNs now) const noexcept {
  return pending_ && now - pending_since_ > settings_.sync_timeout;
}

bool CanopenDrive::is_well(InstantNs now) const noexcept {
  return takes_offsets(now) && heartbeat_.within(now, settings_.heartbeat_time) && !emergency_ &&
         !foreign_.within(now, settings_.heartbeat_time);
}

const char* CanopenDrive::missing(InstantNs now) const noexcept {
  if (bus_off_) return "the bus is off";
  if (is_stuck(now)) return "the CAN bus does not accept the frames of the board";
  if (!sync_.within(now, settings_.sync_timeout)) return "no SYNC arrives";
  if (!heartbeat_.within(now, settings_.heartbeat_time)) return "the heartbeat of the drive is missing";
  if (nmt_ != kOperational) return "the drive is not in the NMT state Operational";
  if (!tpdo_.within(now, settings_.sync_timeout)) return "no TPDO with statusword and position arrives";
  if (emergency_) return "the drive reports an emergency";
  if (foreign_.within(now, settings_.heartbeat_time)) return "another node sends the RPDO of the offset";
  return nullptr;
}

/// A limit below one count, or of a count and a half, is kept over several SYNCs: what one SYNC does not use
/// is kept for the next, up to less than a count.
void CanopenDrive::give_allowance(std::int64_t moved) noexcept {
  const std::int64_t most = settings_.parts_per_sync + CanopenSettings::kPartsOfCount - 1;
  allowance_ = std::clamp<std::int64_t>(
      allowance_ - moved * CanopenSettings::kPartsOfCount + settings_.parts_per_sync, 0, most);
}

void CanopenDrive::forget() noexcept {
  sync_.known = tpdo_.known = heartbeat_.known = pending_ = false;
  status_ = 0;
  without_torque_ = kSure;
}

/// The offset that is wanted, as far as the drive may have it.
std::int64_t CanopenDrive::goal(std::int64_t wanted, bool well) noexcept {
  if (!enabled()) {
    counts_.not_enabled += wanted != 0 ? 1 : 0;
    return 0;
  }
  if (well && !fading_) return wanted;
  return sent_ >= 0 ? std::clamp<std::int64_t>(wanted, 0, sent_) : std::clamp<std::int64_t>(wanted, sent_, 0);
}

CanopenDrive::Step CanopenDrive::step(std::int64_t wanted, InstantNs now) noexcept {
  if (step_.known && !step_.within(now, kLongestPause)) forget();
  step_.now(now);
  const bool takes = takes_offsets(now), well = is_well(now);
  // A frame that did not come back may be lost: the same offset is sent once more.
  if (is_stuck(now)) pending_ = false;
  if (well_ && !well) {
    ++counts_.losses;
    fading_ = true;
    refuse_ = refuse_ || wanted != 0 || sent_ != 0;
  }
  well_ = well;
  fading_ = fading_ && wanted != 0;
  follows_ = false;
  // A drive that takes nothing keeps its offset: with the first SYNC it goes on from there. The newest offset
  // may be one that it has not taken, and is sent once more. Without a new SYNC the newest offset stays.
  const bool again = doubt_ != Doubt::kNone || !synced_;
  if (!takes) doubt_ = Doubt::kRepeat;
  synced_ = false;
  if (refuse_ || (!takes && sent_ != 0)) {
    refuse_ = false;
    return {HalFault::kRefused};
  }
  if (!takes) {
    follows_ = wanted == 0;
    return {};
  }
  if (pending_) return {};  // one frame waits for the bus at a time
  const bool in_doubt = without_torque_ > 0 && without_torque_ < kSure;
  std::int64_t next = goal(wanted, well);
  const std::int64_t most = allowance_ / CanopenSettings::kPartsOfCount;
  if (without_torque_ < kSure)
    next = again || in_doubt ? sent_ : std::clamp<std::int64_t>(next, applied_ - most, applied_ + most);
  follows_ = next == wanted;
  return {HalFault::kNone, true, static_cast<std::int32_t>(next)};
}

}  // namespace vernier
