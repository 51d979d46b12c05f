// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can_sync.h"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace vernier {
namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;
constexpr int kMostFrames = 256;  // taken at a time
constexpr int kMostInterruptions = 1000;

std::int64_t now_ns() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{time.tv_sec} * kNsPerS + time.tv_nsec;
}

}  // namespace

std::unique_ptr<CanSync> CanSync::open(const std::string& interface, std::uint32_t id, std::string& error) {
  const auto failed = [&](const char* what, int fd) {
    error = interface + ": " + what + ": " + std::strerror(errno);
    if (fd >= 0) ::close(fd);
    return nullptr;
  };
  const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (fd < 0) return failed("no CAN in this kernel", fd);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) return failed("no such interface", fd);
  const can_filter filter{id > CAN_SFF_MASK ? (id | CAN_EFF_FLAG) : id,
                          CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_EFF_MASK};
  if (::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, &filter, sizeof(filter)) != 0)
    return failed("filters are refused", fd);
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    return failed("cannot be used", fd);
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
  for (int i = 0; i < kMostInterruptions; ++i) {
    const std::int64_t left = std::max<std::int64_t>(latest.count - now_ns(), 0);
    const timespec wait{static_cast<time_t>(left / kNsPerS), static_cast<long>(left % kNsPerS)};
    pollfd waiting{socket_, POLLIN, 0};
    const int ready = ::ppoll(&waiting, 1, &wait, nullptr);
    if (ready == 0) return HalFault::kNoReading;
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0 || (waiting.revents & POLLIN) == 0) break;
    return drain() ? HalFault::kNone : HalFault::kRefused;
  }
  drain();  // an error of the socket is told once and then gone
  return HalFault::kRefused;
}

}  // namespace vernier
