// SPDX-License-Identifier: GPL-3.0-or-later
// What the test of the emulated board does inside of it: edges of a simulated probe against what the kernel's
// stamps say, the bit rate of a CAN controller, and a talk over ISO-TP that is also cut off in the middle.
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/netlink.h>
#include <linux/can/raw.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "hal/linux/can/isotp_link.h"
#include "hal/linux/gpio_lines.h"
#include "hal/linux/monotonic_clock.h"
#include "tables/link_format.h"

namespace {

using namespace vernier;

int fail(const char* what) {
  std::printf("agent: FAILED: %s: %s\n", what, std::strerror(errno));
  return 1;
}

// ---- the probe's line

/// Pulls a line of the kernel's simulated chip up or down.
class Pull {
 public:
  explicit Pull(const char* path) : fd_(::open(path, O_WRONLY)) {}
  ~Pull() { ::close(fd_); }
  bool up(bool high) const {
    const std::string word = high ? "pull-up" : "pull-down";
    return ::pwrite(fd_, word.data(), word.size(), 0) == static_cast<ssize_t>(word.size());
  }

 private:
  int fd_;
};

HalFault wait_for_edge(GpioProbeLine& probe, Clock& clock, ProbeEdge& edge) {
  const InstantNs end = clock.now() + instant_ns(TimeUs(1'000'000));
  HalFault fault = HalFault::kNoReading;
  while ((fault = probe.read_edge(edge)) == HalFault::kNoReading && clock.now() < end)
    clock.sleep_until(clock.now() + instant_ns(TimeUs(100)));
  return fault;
}

/// One edge after the other: kind as pulled, stamp between before and after.
int edges_in_turn(GpioProbeLine& probe, const Pull& pull, bool inverted, int count) {
  MonotonicClock clock;
  std::int64_t longest = 0;
  for (int i = 0; i < count; ++i) {
    const bool high = i % 2 == 0;
    const InstantNs before = clock.now();
    if (!pull.up(high)) return fail("pull");
    ProbeEdge edge;
    if (wait_for_edge(probe, clock, edge) != HalFault::kNone) return fail("an edge did not come");
    const InstantNs after = clock.now();
    if (edge.made != (high != inverted)) return fail("an edge has the wrong kind");
    if (edge.at < before || edge.at > after) return fail("a stamp is not between before and after");
    longest = std::max(longest, (edge.at - before).count);
  }
  std::printf("agent: %d of %d edges, stamps at most %lld ns after the pull began\n", count, count,
              static_cast<long long>(longest));
  return 0;
}

/// More edges than the kernel holds: what is lost is told.
int burst(GpioProbeLine& probe, const Pull& pull) {
  MonotonicClock clock;
  constexpr int kEdges = 100;
  for (int i = 0; i < kEdges; ++i) {
    if (!pull.up(i % 2 == 0)) return fail("pull");
    ::usleep(200);
  }
  ProbeEdge edge;
  int read = 0, losses = 0;
  for (HalFault fault; (fault = wait_for_edge(probe, clock, edge)) != HalFault::kNoReading;)
    ++(fault == HalFault::kRefused ? losses : read);
  std::printf("agent: burst of %d edges: %d read, %d losses told\n", kEdges, read, losses);
  if (read < 16 || (read < kEdges && losses == 0)) return fail("a loss was not told");
  return 0;
}

int probe(const char* chip, unsigned line, const char* pull_path, int count) {
  const Pull pull(pull_path);
  for (const bool inverted : {false, true}) {
    if (!pull.up(false)) return fail(pull_path);
    ::usleep(1000);
    std::string error;
    const auto probe_line = GpioProbeLine::open({chip, line, inverted}, error);
    if (!probe_line) return std::printf("agent: FAILED: %s\n", error.c_str()), 1;
    if (probe_line->level() != (inverted ? 1 : 0)) return fail("the level is not that of the pull");
    if (edges_in_turn(*probe_line, pull, inverted, count) != 0) return 1;
    if (!inverted && burst(*probe_line, pull) != 0) return 1;
    auto second = GpioProbeLine::open({chip, line, false}, error);
    if (second) return fail("a line was given away twice");
  }
  std::printf("agent: probe: done\n");
  return 0;
}

// ---- edges from outside: says each when it has heard it, so that the next can be pulled

int say_edges(const char* chip, unsigned line, int count) {
  MonotonicClock clock;
  std::string error;
  const auto probe_line = GpioProbeLine::open({chip, line, false}, error);
  if (!probe_line) return std::printf("agent: FAILED: %s\n", error.c_str()), 1;
  std::printf("agent: listening\n");
  std::fflush(stdout);
  int made = 0, let_go = 0, losses = 0;
  // After the last one a while longer: none comes that nobody pulled.
  for (bool quiet = false; made + let_go < count || !quiet;) {
    ProbeEdge edge;
    const HalFault fault = wait_for_edge(*probe_line, clock, edge);
    quiet = fault == HalFault::kNoReading;
    losses += fault == HalFault::kRefused ? 1 : 0;
    if (fault != HalFault::kNone) continue;
    ++(edge.made ? made : let_go);
    std::printf("agent: edge %d %s\n", made + let_go, edge.made ? "made" : "let go");
    std::fflush(stdout);
  }
  std::printf("agent: heard %d made %d let go %d losses\n", made, let_go, losses);
  return 0;
}

// ---- a CAN controller's bit rate, as `ip link set can0 type can bitrate N` does

struct Message {
  nlmsghdr head;
  ifinfomsg link;
  char room[256];

  rtattr* add(unsigned short type, const void* data, std::size_t size) {
    auto* const attribute =
        reinterpret_cast<rtattr*>(reinterpret_cast<char*>(this) + NLMSG_ALIGN(head.nlmsg_len));
    attribute->rta_type = type;
    attribute->rta_len = static_cast<unsigned short>(RTA_LENGTH(size));
    if (size > 0) std::memcpy(RTA_DATA(attribute), data, size);
    head.nlmsg_len = static_cast<unsigned>(NLMSG_ALIGN(head.nlmsg_len) + RTA_ALIGN(attribute->rta_len));
    return attribute;
  }
  void close(rtattr* attribute) {
    const auto* const end = reinterpret_cast<char*>(this) + head.nlmsg_len;
    attribute->rta_len = static_cast<unsigned short>(end - reinterpret_cast<char*>(attribute));
  }
};

int set_bit_rate(const char* interface, unsigned bits_per_s) {
  const int fd = ::socket(AF_NETLINK, SOCK_RAW, NETLINK_ROUTE);
  Message message{};
  message.head.nlmsg_len = NLMSG_LENGTH(sizeof(ifinfomsg));
  message.head.nlmsg_type = RTM_NEWLINK;
  message.head.nlmsg_flags = NLM_F_REQUEST | NLM_F_ACK;
  message.link.ifi_index = static_cast<int>(::if_nametoindex(interface));
  can_bittiming timing{};
  timing.bitrate = bits_per_s;
  rtattr* const info = message.add(IFLA_LINKINFO, nullptr, 0);
  message.add(IFLA_INFO_KIND, "can", 3);
  rtattr* const data = message.add(IFLA_INFO_DATA, nullptr, 0);
  message.add(IFLA_CAN_BITTIMING, &timing, sizeof(timing));
  message.close(data), message.close(info);
  if (::send(fd, &message, message.head.nlmsg_len, 0) < 0) return fail("netlink");
  char reply[4096];
  if (::recv(fd, reply, sizeof(reply), 0) < static_cast<ssize_t>(sizeof(nlmsghdr) + sizeof(nlmsgerr)))
    return fail("netlink reply");
  errno = -reinterpret_cast<nlmsgerr*>(reply + sizeof(nlmsghdr))->error;
  ::close(fd);
  return errno == 0 ? 0 : fail(interface);
}

// ---- requests over ISO-TP

bool answers(IsotpLink& link, std::uint8_t sequence) {
  const std::uint8_t request[2] = {static_cast<std::uint8_t>(LinkOp::kHello), sequence};
  std::uint8_t reply[4096];
  const int got = link.ask(request, sizeof(request), reply, sizeof(reply), TimeUs(3'000'000));
  return got > 8 && reply[0] == request[0] && reply[1] == sequence && reply[2] == 0;
}

/// The first frame of a long message, and then nothing.
bool begin_and_leave(const char* interface, std::uint32_t id) {
  const int fd = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface));
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = 8;
  frame.data[0] = 0x10, frame.data[1] = 200;  // first frame of 200 bytes
  const bool sent = fd >= 0 && ::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0 &&
                    ::write(fd, &frame, sizeof(frame)) == static_cast<ssize_t>(sizeof(frame));
  ::close(fd);
  return sent;
}

int talk(const char* interface, std::uint32_t send, std::uint32_t receive, int count) {
  std::string error;
  const auto link = IsotpLink::open(interface, receive, send, error);
  if (!link) return std::printf("agent: FAILED: %s\n", error.c_str()), 1;
  int good = 0;
  for (int i = 0; i < count; ++i) good += answers(*link, static_cast<std::uint8_t>(i)) ? 1 : 0;
  std::printf("agent: %d of %d answers over ISO-TP\n", good, count);
  int after = 0;
  for (int i = 0; i < 5; ++i) {
    if (!begin_and_leave(interface, send)) return fail("raw frame");
    ::usleep(1'500'000);  // longer than the protocol waits for the rest
    after += answers(*link, static_cast<std::uint8_t>(i)) ? 1 : 0;
  }
  std::printf("agent: %d of 5 answers after messages that were cut off\n", after);
  return good == count && after == 5 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "probe" && argc == 6)
    return probe(argv[2], static_cast<unsigned>(std::atoi(argv[3])), argv[4], std::atoi(argv[5]));
  if (what == "edges" && argc == 5)
    return say_edges(argv[2], static_cast<unsigned>(std::atoi(argv[3])), std::atoi(argv[4]));
  if (what == "bitrate" && argc == 4) return set_bit_rate(argv[2], static_cast<unsigned>(std::atoi(argv[3])));
  if (what == "isotp" && argc == 6)
    return talk(argv[2], static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 0)),
                static_cast<std::uint32_t>(std::strtoul(argv[4], nullptr, 0)), std::atoi(argv[5]));
  std::fputs(
      "usage: board_agent probe CHIP LINE PULL COUNT | edges CHIP LINE COUNT | bitrate INTERFACE N |\n"
      "       isotp INTERFACE SEND RECEIVE COUNT\n",
      stderr);
  return 1;
}
