// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/simulation/simulated_drive.h"

#include <algorithm>

namespace vernier::simulation {
namespace {

constexpr std::int64_t kHeartbeatTicks = 5, kTimeoutTicks = 4, kNsPerUs = 1'000;
constexpr std::uint32_t kEnabled = 0x1637, kFault = 0x1618;

}  // namespace

SimulatedDrive::SimulatedDrive(std::mt19937_64& random, TimeUs tick, std::int64_t most) : random_(random) {
  settings_.sync_timeout = InstantNs(kTimeoutTicks * tick.count * kNsPerUs);
  settings_.heartbeat_time = InstantNs(3 * kHeartbeatTicks * tick.count * kNsPerUs);
  settings_.parts_per_sync = most * CanopenSettings::kPartsOfCount;
  start();
}

void SimulatedDrive::start() {
  board_ = std::make_unique<CanopenDrive>(settings_);
  buffer_ = applied_ = 0;
  waits_ = false;
}

void SimulatedDrive::give(std::uint32_t id, std::initializer_list<std::uint32_t> bytes) {
  can_frame frame{};
  frame.can_id = id;
  for (const std::uint32_t byte : bytes) frame.data[frame.can_dlc++] = static_cast<std::uint8_t>(byte);
  board_->take(frame, now_);
}

void SimulatedDrive::begin(Lasting& fault, std::uint64_t& count, std::uint64_t rate) {
  if (fault.on() && --fault.left >= 0) return;
  if (random_() % rate != 0) return;
  fault.left = 1 + static_cast<std::int64_t>(random_() % 200);
  ++count;
}

void SimulatedDrive::hurt() {
  begin(no_sync_, counts.syncs_lost, 60'000);
  begin(no_position_, counts.positions_lost, 60'000);
  begin(no_heartbeat_, counts.heartbeats_lost, 60'000);
  begin(cut_, counts.cuts, 60'000);
  begin(emergency_, counts.emergencies, 100'000);
  begin(disabled_, counts.disabled, 40'000);
  const bool ran = !starting_.on();
  begin(starting_, counts.restarts, 200'000);
  if (ran && starting_.on()) {
    arrive();
    buffer_ = applied_ = 0;
    enabled_ = false;
    told_ = false;
  }
  overtakes_ = random_() % 200 == 0;
  counts.overtaken += overtakes_ ? 1 : 0;
}

/// The frame that waits for the bus reaches the drive, and comes back to the board.
void SimulatedDrive::arrive() {
  if (!waits_) return;
  waits_ = false;
  if (!starting_.on()) buffer_ = waiting_;
  const auto value = static_cast<std::uint32_t>(waiting_);
  give(settings_.rpdo, {value & 0xff, value >> 8 & 0xff, value >> 16 & 0xff, value >> 24});
}

void SimulatedDrive::cycle(InstantNs now, bool calm) {
  now_ = now;
  ++ticks_;
  if (!calm) hurt();
  had_torque_ = enabled_;
  if (cut_.on()) return;
  const bool runs = !starting_.on();
  // A master enables its drive over the bus, with SYNC.
  if (disabled_.on() || !runs)
    enabled_ = false;
  else if (!no_sync_.on())
    enabled_ = true;
  if (runs && !told_) give(settings_.heartbeat, {CanopenDrive::kBootUp}), told_ = true;
  if (!no_sync_.on()) {
    if (runs) applied_ = buffer_;
    give(settings_.sync, {});
    arrive();
    const std::uint32_t status = enabled_ ? kEnabled : kFault;
    if (runs && !no_position_.on()) give(settings_.tpdo, {status & 0xff, status >> 8, 0, 0, 0, 0});
  }
  if (runs && !no_heartbeat_.on() && ticks_ % kHeartbeatTicks == 0)
    give(settings_.heartbeat, {CanopenDrive::kOperational});
  if (emergency_.left == 100) give(settings_.emergency, {0x10, 0x23, 0x81, 0, 0, 0, 0, 0});
  if (emergency_.left == 1) give(settings_.emergency, {0, 0, 0, 0, 0, 0, 0, 0});
}

HalFault SimulatedDrive::write_correction(std::uint32_t, AxisTravel correction) noexcept {
  const CanopenDrive::Step step = board_->step(correction.count, now_);
  if (!step.send) return step.fault;
  board_->sent(step.offset, now_);
  if (cut_.on()) return step.fault;  // lost: it never comes back
  waiting_ = step.offset;
  waits_ = true;
  if (!overtakes_) arrive();
  return step.fault;
}

AxisTravel SimulatedDrive::within_range(std::uint32_t, AxisTravel correction) const noexcept {
  return board_->follows() ? correction : AxisTravel(board_->offset());
}

}  // namespace vernier::simulation
