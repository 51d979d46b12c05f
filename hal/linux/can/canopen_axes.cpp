// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/canopen_axes.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "hal/linux/can/can_socket.h"

namespace vernier {

std::unique_ptr<CanopenAxes> CanopenAxes::open(const std::string& interface, const std::vector<Axis>& axes,
                                               std::string& error) {
  std::vector<std::uint32_t> ids;
  for (const Axis& axis : axes) ids.push_back(axis.settings.tpdo), ids.push_back(axis.settings.heartbeat);
  const int fd = open_can(interface, ids, true, error);
  return fd < 0 ? nullptr : std::make_unique<CanopenAxes>(fd, axes);
}

CanopenAxes::CanopenAxes(int socket, const std::vector<Axis>& axes) : socket_(socket) {
  for (const Axis& axis : axes)
    drives_.push_back({axis.settings.tpdo, axis.settings.heartbeat, CanopenDrive(axis.settings),
                       PositionConverter(axis.scale)});
}

CanopenAxes::~CanopenAxes() { ::close(socket_); }

void CanopenAxes::begin_tick() noexcept {
  for (Drive& drive : drives_) drive.drive.begin_tick();
  for (int i = 0; i < kMostFrames; ++i) {
    can_frame frame{};
    const ssize_t got = ::recv(socket_, &frame, sizeof frame, MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return;
    if (got != static_cast<ssize_t>(sizeof frame)) continue;
    for (Drive& drive : drives_) {
      if (frame.can_id != drive.tpdo && frame.can_id != drive.heartbeat) continue;
      drive.drive.take(frame, InstantNs{});
      // A drive that has started again may count from another zero: the jump is a fault of the firmware.
      if (frame.can_id == drive.heartbeat && frame.can_dlc == 1 && frame.data[0] == CanopenDrive::kBootUp)
        drive.count.forget();
    }
  }
}

HalFault CanopenAxes::read_axis(std::uint32_t index, AxisReading& reading) noexcept {
  if (index >= drives_.size()) return HalFault::kNoDevice;
  Drive& drive = drives_[index];
  std::int32_t value = 0;
  if (!drive.drive.position(value)) return HalFault::kNoReading;
  drive.count.take(static_cast<std::uint32_t>(value));
  reading = {};
  reading.position = drive.converter.position_of(drive.count.position());
  return HalFault::kNone;
}

}  // namespace vernier
