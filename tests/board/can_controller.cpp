// SPDX-License-Identifier: GPL-3.0-or-later
// A machine controller on a CAN bus, for the emulated board: sends the positions of two axes at 1 kHz. X goes
// back and forth over ±30 mm at 20 mm/s; Y is always -X/2, so that a recording can be checked by itself. With
// a sync identifier each cycle ends with that frame, until
// SIGUSR1.
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "hal/linux/can/can_axis_frame.h"

namespace {

constexpr std::int64_t kPeriodNs = 1'000'000, kNsPerS = 1'000'000'000;
volatile std::sig_atomic_t with_sync = 1;
constexpr std::int64_t kEnd = 30'000'000, kStep = 20'000;  // nm, nm a cycle

bool send(int fd, std::uint32_t id, const vernier::CanAxisFrame& content) {
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = vernier::CanAxisFrame::kBytes;
  vernier::encode_axis_frame(content, frame.data);
  return ::write(fd, &frame, sizeof(frame)) == static_cast<ssize_t>(sizeof(frame));
}

int open_bus(const char* interface) {
  const int fd = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface));
  if (fd < 0 || address.can_ifindex == 0 ||
      ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    return -1;
  return fd;
}

bool send_sync(int fd, std::uint32_t id) {
  can_frame frame{};
  frame.can_id = id;
  return ::write(fd, &frame, sizeof(frame)) == static_cast<ssize_t>(sizeof(frame));
}

// A bus that is full or down for a while is tried again with the next cycle.
bool lasting(bool sent) { return sent || errno == ENOBUFS || errno == ENETDOWN || errno == ENXIO; }

}  // namespace

int main(int argc, char** argv) {
  const int fd = argc == 3 || argc == 4 ? open_bus(argv[1]) : -1;
  if (fd < 0) {
    std::fputs("usage: can_controller INTERFACE FIRST_ID [SYNC_ID]\n", stderr);
    return 1;
  }
  const auto first = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 0));
  const auto sync = static_cast<std::uint32_t>(argc == 4 ? std::strtoul(argv[3], nullptr, 0) : 0);
  std::signal(SIGUSR1, [](int) { with_sync = 0; });
  timespec due{};
  clock_gettime(CLOCK_MONOTONIC, &due);
  std::int64_t x = 0, step = kStep;
  for (std::uint64_t cycle = 0;; ++cycle) {
    if (x + step > kEnd || x + step < -kEnd) step = -step;
    x += step;
    const auto counter = static_cast<std::uint8_t>(cycle);
    const auto stamp = static_cast<std::uint8_t>(cycle * 1000 / 64 % 64);
    if (!lasting(send(fd, first, {x, counter, true, true, stamp})) ||
        !lasting(send(fd, first + 1, {-x / 2, counter, true, true, stamp})) ||
        (sync != 0 && with_sync && !lasting(send_sync(fd, sync))))
      return 2;
    due.tv_nsec += kPeriodNs;
    if (due.tv_nsec >= kNsPerS) due.tv_nsec -= kNsPerS, ++due.tv_sec;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
  }
}
