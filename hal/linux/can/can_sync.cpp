// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/can_sync.h"

#include <linux/can.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "hal/linux/can/can_socket.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/system_time.h"

namespace vernier {
namespace {

constexpr int kMostFrames = 256;  // taken at a time

}  // namespace

std::unique_ptr<CanSync> CanSync::open(const std::string& interface, std::uint32_t id, std::string& error) {
  const int fd = open_can(interface, {id}, false, error);
  if (fd < 0) return nullptr;
  return std::make_unique<CanSync>(fd);
}

CanSync::~CanSync() { ::close(socket_); }

/// Takes all frames that are there. False: the socket is broken.
bool CanSync::drain() noexcept {
  for (int i = 0; i < kMostFrames; ++i) {
    can_frame frame;
    if (::recv(socket_, &frame, sizeof(frame), MSG_DONTWAIT) >= 0 || errno == EINTR) continue;
    return errno == EAGAIN || errno == EWOULDBLOCK;
  }
  return true;
}

HalFault CanSync::wait_for_sync(InstantNs latest) noexcept {
  MonotonicClock clock;
  for (int i = 0; i < kMostInterruptions; ++i) {
    const std::int64_t left = std::max<std::int64_t>((latest - clock.now()).count, 0);
    const timespec wait = timespec_of(left);
    pollfd waiting{socket_, POLLIN, 0};
    const int ready = ::ppoll(&waiting, 1, &wait, nullptr);
    if (ready == 0) return HalFault::kNoReading;
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0 || (waiting.revents & POLLIN) == 0) break;
    return drain() ? HalFault::kNone : HalFault::kRefused;
  }
  drain();  // an error of the socket is reported once and then cleared
  return HalFault::kRefused;
}

}  // namespace vernier
