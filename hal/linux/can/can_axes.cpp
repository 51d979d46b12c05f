// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/can_axes.h"

#include <linux/can.h>
#include <linux/can/error.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "hal/linux/can/can_socket.h"

namespace vernier {
namespace {

// Late frames in a row, each with the counter after the other's, that are a controller which started again.
// A burst of old frames from a queue is shorter, as controllers hold one frame of an axis.
constexpr std::uint32_t kFramesOfRestart = 4;

bool usable(const std::vector<std::uint32_t>& ids) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] > CAN_EFF_MASK) return false;
    for (std::size_t k = 0; k < i; ++k)
      if (ids[i] == ids[k]) return false;
  }
  return !ids.empty();
}

}  // namespace

std::unique_ptr<CanAxes> CanAxes::open(const std::string& interface, const std::vector<std::uint32_t>& ids,
                                       std::string& error) {
  if (!usable(ids)) {
    errno = EINVAL;
    can_failed(interface, "identifiers", -1, error);
    return nullptr;
  }
  const int fd = open_can(interface, ids, true, error);
  if (fd < 0) return nullptr;
  return std::make_unique<CanAxes>(fd, ids);
}

CanAxes::CanAxes(int socket, const std::vector<std::uint32_t>& ids) : socket_(socket), axes_(ids.size()) {
  for (std::size_t i = 0; i < ids.size(); ++i) axes_[i].id = can_identifier(ids[i]);
}

CanAxes::~CanAxes() { ::close(socket_); }

void CanAxes::begin_tick() noexcept {
  for (Axis& axis : axes_) axis.fresh = false;
  for (std::uint32_t i = 0; i < kMostFrames; ++i) {
    can_frame frame{};
    const ssize_t got = ::recv(socket_, &frame, sizeof(frame), MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      counts_.broken += errno == EAGAIN || errno == EWOULDBLOCK ? 0 : 1;
      return;
    }
    if (got == 0) return;
    if (got == sizeof(frame) && (frame.can_id & CAN_ERR_FLAG) != 0) {
      ++counts_.bus_errors;
    } else if (got != sizeof(frame) || frame.can_dlc != CanAxisFrame::kBytes ||
               (frame.can_id & CAN_RTR_FLAG) != 0) {
      ++counts_.malformed;
    } else {
      take(frame.can_id, decode_axis_frame(frame.data));
    }
  }
}

bool CanAxes::restarted(Axis& axis, std::uint8_t counter) noexcept {
  const bool follows = axis.late_in_row > 0 && counter == static_cast<std::uint8_t>(axis.late_counter + 1);
  axis.late_in_row = follows ? axis.late_in_row + 1 : 1;
  axis.late_counter = counter;
  return axis.late_in_row >= kFramesOfRestart;
}

bool CanAxes::in_order(Axis& axis, std::uint8_t counter) noexcept {
  if (!axis.known) return true;
  const auto ahead = static_cast<std::uint8_t>(counter - axis.newest.counter);
  if (ahead == 0) {
    ++counts_.duplicates;
    return false;
  }
  if (ahead >= 128) {
    ++counts_.late;
    if (!restarted(axis, counter)) return false;
    ++counts_.restarts;
    return true;
  }
  counts_.lost += ahead - 1u;
  return true;
}

void CanAxes::take(std::uint32_t id, const CanAxisFrame& frame) noexcept {
  for (Axis& axis : axes_) {
    if (axis.id != id) continue;
    if (!in_order(axis, frame.counter)) return;
    axis.late_in_row = 0;
    axis.same_stamp = axis.known && frame.stamp == axis.newest.stamp ? axis.same_stamp + 1 : 0;
    if (axis.same_stamp > kStalledFrames) axis.same_stamp = kStalledFrames;
    axis.newest = frame;
    axis.known = true;
    const bool stalled = axis.same_stamp >= kStalledFrames;
    counts_.stalled += stalled ? 1 : 0;
    counts_.invalid += frame.valid ? 0 : 1;
    counts_.frames += frame.valid && !stalled ? 1 : 0;
    // The newest frame decides: one that is not valid takes back an earlier one of the same tick.
    axis.fresh = frame.valid && !stalled;
    return;
  }
  ++counts_.malformed;
}

HalFault CanAxes::read_axis(std::uint32_t index, AxisReading& reading) noexcept {
  if (index >= axes_.size()) return HalFault::kNoDevice;
  const Axis& axis = axes_[index];
  if (!axis.fresh) return HalFault::kNoReading;
  reading = {};
  reading.position = AxisPosition(axis.newest.position);
  reading.referenced = axis.newest.referenced;
  return HalFault::kNone;
}

}  // namespace vernier
