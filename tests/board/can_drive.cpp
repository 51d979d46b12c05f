// SPDX-License-Identifier: GPL-3.0-or-later
// can_drive INTERFACE TICKS: an output for a CANopen drive on the kernel's own bus, for the emulated board. A
// thread is the drive with its master: SYNC, TPDO, heartbeat, the object dictionary. The ticks follow SYNC.
// Prints how many offsets the drive used as they were written; exit 1 if it was not all of them.
#include <linux/can.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "hal/linux/can/can_socket.h"
#include "hal/linux/can/can_sync.h"
#include "hal/linux/can/canopen_output.h"
#include "hal/linux/monotonic_clock.h"

namespace {

using namespace vernier;

constexpr std::int64_t kMost = 20;
constexpr std::size_t kSame = 50;  // ticks in which the offset may stay the same, at the top of the sine

class Drive {
 public:
  explicit Drive(const std::string& interface) {
    std::string error;
    fd_ = open_can(interface, {0x501, 0x601}, false, error);
    if (fd_ < 0) std::fprintf(stderr, "%s\n", error.c_str()), std::exit(1);
    thread_ = std::thread([this] { run(); });
  }
  ~Drive() {
    stop_ = true;
    thread_.join();
    ::close(fd_);
  }
  std::vector<std::int32_t> used;  // at each SYNC; read after the end

 private:
  void send(std::uint32_t id, std::initializer_list<int> bytes) {
    can_frame frame{};
    frame.can_id = id;
    for (const int byte : bytes) frame.data[frame.can_dlc++] = static_cast<std::uint8_t>(byte);
    if (::send(fd_, &frame, sizeof frame, 0) < 0) std::perror("send");
  }
  void answer(const can_frame& asked) {
    static const std::map<int, std::uint32_t> kObjects = {
        {0x140301, 0x501}, {0x140302, 1}, {0x160300, 1},          {0x160301, 0x60b00020}, {0x180201, 0x381},
        {0x180202, 1},     {0x1a0200, 2}, {0x1a0201, 0x60410010}, {0x1a0202, 0x60640020}, {0x60b000, 0}};
    const auto found = kObjects.find(asked.data[2] << 16 | asked.data[1] << 8 | asked.data[3]);
    const std::uint32_t value = found == kObjects.end() ? 0x06020000 : found->second;
    send(0x581, {found == kObjects.end() ? 0x80 : 0x43, asked.data[1], asked.data[2], asked.data[3],
                 static_cast<int>(value & 0xff), static_cast<int>(value >> 8 & 0xff),
                 static_cast<int>(value >> 16 & 0xff), static_cast<int>(value >> 24)});
  }
  void take(std::chrono::steady_clock::time_point until) {
    for (;;) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
      pollfd waiting{fd_, POLLIN, 0};
      if (left.count() < 0 || ::poll(&waiting, 1, static_cast<int>(left.count()) + 1) <= 0) return;
      can_frame frame{};
      if (::recv(fd_, &frame, sizeof frame, MSG_DONTWAIT) < 0) continue;
      if (frame.can_id == 0x601) answer(frame);
      if (frame.can_id == 0x501 && frame.can_dlc == 4) std::memcpy(&newest_, frame.data, 4);
    }
  }
  void run() {
    constexpr auto kPeriod = std::chrono::milliseconds(4);
    for (int cycle = 0; !stop_; ++cycle) {
      const auto began = std::chrono::steady_clock::now();
      used.push_back(newest_);
      send(0x80, {});
      send(0x381, {0x37, 0x16, cycle & 0xff, cycle >> 8 & 0xff, 0, 0});
      if (cycle % 25 == 0) send(0x701, {5});
      take(began + kPeriod);
    }
  }
  int fd_ = -1;
  std::int32_t newest_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: can_drive INTERFACE TICKS\n", stderr), 1;
  const int ticks = std::atoi(argv[2]);
  AnalogueScale scale;
  scale.codes = 1'000'000, scale.span = 1'000'000'000'000 / 1'000;
  scale.zero = 1 << 30, scale.low = scale.zero - 1'000'000, scale.high = scale.zero + 1'000'000;
  CanopenSettings settings;
  settings.parts_per_sync = kMost * CanopenSettings::kPartsOfCount;
  settings.sync_timeout = InstantNs(1'000'000'000), settings.heartbeat_time = InstantNs(3'000'000'000);
  std::vector<std::int32_t> written;
  std::vector<std::int32_t> used;
  std::string account;
  {
    Drive drive(argv[1]);
    std::string error;
    auto sync = CanSync::open(argv[1], 0x80, error);
    auto output = CanopenOutput::open({argv[1], 1, {}, true}, settings, scale, error);
    if (!sync || !output) return std::fprintf(stderr, "can_drive: %s\n", error.c_str()), 1;
    if (!output->lock()) return std::fputs("can_drive: another sender\n", stderr), 1;
    if (const std::string missing = output->attempt(0); !missing.empty())
      return std::fprintf(stderr, "can_drive: %s\n", missing.c_str()), 1;
    MonotonicClock clock;
    std::int32_t offset = 0;
    for (int i = 0; i < ticks; ++i) {
      sync->wait_for_sync(clock.now() + InstantNs(1'000'000'000));
      const auto wanted = static_cast<std::int32_t>(3'000 * std::sin(i / 200.0));
      offset += std::clamp<std::int32_t>(wanted - offset, -kMost, kMost);
      if (output->write_correction(0, AxisTravel(std::int64_t{1'000} * offset)) != HalFault::kNone)
        return std::printf("can_drive: refused in tick %d; %s\n", i, output->account().c_str()), 1;
      written.push_back(offset);
    }
    account = output->account();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    used = drive.used;
  }
  // Every offset in use is one that was written, in this order, and no step is larger than that of a tick.
  std::size_t at = 0, equal = 0, other = 0;
  std::int32_t largest = 0;
  for (std::size_t i = 1; i < used.size(); ++i) {
    largest = std::max(largest, std::abs(used[i] - used[i - 1]));
    std::size_t k = at;
    while (k < written.size() && k < at + kSame && written[k] != used[i]) ++k;
    const bool found = k < written.size() && written[k] == used[i];
    if (found) at = k, ++equal;
    other += found || used[i] == 0 ? 0 : 1;
  }
  std::printf(
      "can_drive: %zu of %d ticks written, %zu offsets in use equal, %zu other, largest step %d of %lld; "
      "%s\n",
      written.size(), ticks, equal, other, largest, static_cast<long long>(kMost), account.c_str());
  return other == 0 && largest <= kMost && equal > written.size() / 2 ? 0 : 1;
}
