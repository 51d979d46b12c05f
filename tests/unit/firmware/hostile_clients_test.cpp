// SPDX-License-Identifier: GPL-3.0-or-later
// No client and no medium keeps the daemon from its duties: the service manager hears of it in time, trials
// end on time, and it ends when it is told to. Each of these was once held up by what is done here.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/ptrace.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "tests/unit/firmware/daemon_process.h"
#include "tools/text/error.h"

namespace vernier::hostile_clients_test {

using namespace vernier::text;
using namespace vernier::upload;
namespace {

// The unit's WatchdogSec; a sign of life comes four times a second (0.26 s measured, with all clients and a
// busy machine; the fault was 22 s).
constexpr double kMostSilence_s = 2.0;

int connect_to(int port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0) return fd;
  ::close(fd);
  return -1;
}

/// A client in a thread of its own, that comes again when it is thrown out.
class Hostile {
 public:
  enum class Manner { kDrips, kNeverReads, kConnectsOnly };
  Hostile(int port, Manner manner) : thread_([this, port, manner] { run(port, manner); }) {}
  ~Hostile() {
    stop_ = true;
    thread_.join();
  }
  int thrown_out() const { return thrown_out_; }

 private:
  void run(int port, Manner manner) {
    // Function 4, 125 registers: the longest reply to the shortest request.
    const std::uint8_t request[] = {0, 1, 0, 0, 0, 6, 1, 4, 0, 0, 0, 125};
    while (!stop_) {
      const int fd = connect_to(port);
      bool open = fd >= 0;
      for (std::size_t i = 0; open && !stop_; ++i) {
        if (manner == Manner::kDrips) {
          open = ::send(fd, request + i % 11, 1, MSG_NOSIGNAL) == 1;
          std::this_thread::sleep_for(std::chrono::milliseconds(85));
        } else if (manner == Manner::kNeverReads) {
          open = ::send(fd, request, sizeof(request), MSG_NOSIGNAL | MSG_DONTWAIT) > 0 || errno == EAGAIN;
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        } else {
          char byte = 0;
          std::this_thread::sleep_for(std::chrono::milliseconds(50));
          open = ::recv(fd, &byte, 1, MSG_DONTWAIT) != 0;
        }
      }
      if (!open) ++thrown_out_;
      if (fd >= 0) ::close(fd);
      if (!open) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  std::atomic<bool> stop_{false};
  std::atomic<int> thrown_out_{0};
  std::thread thread_;
};

/// How late this machine itself wakes a thread that sleeps as the guardian does: not the daemon's fault.
class OwnLateness {
 public:
  ~OwnLateness() {
    stop_ = true;
    thread_.join();
  }
  double longest_s() const { return longest_s_; }

 private:
  void run() {
    constexpr std::chrono::duration<double> kAsked{0.25};
    while (!stop_) {
      const auto begun = std::chrono::steady_clock::now();
      std::this_thread::sleep_for(kAsked);
      const std::chrono::duration<double> slept = std::chrono::steady_clock::now() - begun;
      longest_s_ = std::max(longest_s_.load(), (slept - kAsked).count());
    }
  }
  std::atomic<bool> stop_{false};
  std::atomic<double> longest_s_{0};
  std::thread thread_{[this] { run(); }};
};

class HostileClients : public DaemonFolder {
 protected:
  HostileClients() {
    replace_in_board("trial_s = 30", "trial_s = 2");
    slow_fsync(0);
  }
  void slow_fsync(int ms) const { write_file(directory_ + "/fsync_ms", std::to_string(ms)); }
  std::vector<std::string> environment(const NotifySocket& manager) const {
    return {manager.setting(), std::string("LD_PRELOAD=") + VERNIER_SLOW_FSYNC_LIBRARY,
            "VERNIER_SLOW_FSYNC=" + directory_ + "/fsync_ms", "ASAN_OPTIONS=verify_asan_link_order=0"};
  }
  double seconds_to_end(Daemon& daemon) const {
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_EQ(daemon.end(SIGTERM), 0);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }
};

TEST_F(HostileClients, NeitherDrippingNorDeafOnesDelayWatchdogTrialOrEnd) {
  NotifySocket manager(directory_ + "/notify");
  Daemon daemon(directory_, environment(manager));
  {
    Client client = daemon.client(key_);
    client.upload(upload(2e-5, 1), [](double) {});
    client.confirm();
    ASSERT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
  }
  std::vector<std::unique_ptr<Hostile>> clients;
  for (int i = 0; i < 50; ++i)
    clients.push_back(std::make_unique<Hostile>(daemon.port(), static_cast<Hostile::Manner>(i % 3)));
  ASSERT_TRUE(wait_for([&] { return manager.hears("WATCHDOG=1"); }));
  manager.forget();
  const OwnLateness own;
  // WHEN an image is tried in the middle of them, by a client that did not stand idle
  std::optional<Client> known;
  ASSERT_TRUE(wait_for([&] {
    try {
      known.emplace(daemon.client(key_));
    } catch (const InputError&) {
      // No room just now.
    }
    return known.has_value();
  }));
  Client& client = *known;
  client.upload(upload(4e-5, 2), [](double) {});
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_TRUE(wait_for([&] { return client.slots().trial == kNoSlot; }));
  const double trial_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  // THEN who is well-behaved is answered, the trial ends on time, and signs of life came all the while
  EXPECT_GT(trial_s, 1.5);
  EXPECT_LT(trial_s, 8) << "12.7 s past its end, or never, was the fault";
  EXPECT_EQ(client.newest().mode, Mode::kActive);
  // Eight wakes in a row have to be late for that.
  EXPECT_LT(manager.longest_silence_s(), kMostSilence_s + 8 * own.longest_s());
  int thrown_out = 0;
  for (const auto& hostile : clients) thrown_out += hostile->thrown_out();
  EXPECT_GT(thrown_out, 20) << "the attack is worth something only if it was one";
  const double end_s = seconds_to_end(daemon);
  std::printf("trial of 2 s: %.2f s, longest silence %.2f s, end after %.2f s, %d thrown out\n", trial_s,
              manager.longest_silence_s(), end_s, thrown_out);
  EXPECT_LT(end_s, 8);
}

TEST_F(HostileClients, SlowMediumDelaysWhoAskedForItAndNobodyElse) {
  NotifySocket manager(directory_ + "/notify");
  Daemon daemon(directory_, environment(manager));
  Client client = daemon.client(key_), other = daemon.client(key_);
  client.upload(upload(2e-5, 1), [](double) {});
  client.confirm();
  ASSERT_TRUE(wait_for([&] { return manager.hears("WATCHDOG=1"); }));
  manager.forget();
  const OwnLateness own;
  // GIVEN a medium whose every write takes 1.2 s
  slow_fsync(1200);
  std::thread uploads([&] { client.upload(upload(4e-5, 2), [](double) {}); });
  double worst_s = 0;
  const auto asked = [&] {
    const auto begun = std::chrono::steady_clock::now();
    const bool trial = other.slots().trial != kNoSlot;
    worst_s =
        std::max(worst_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
    return trial;
  };
  EXPECT_TRUE(wait_for(asked)) << "slow, but tried";
  const auto begun = std::chrono::steady_clock::now();
  uploads.join();
  // THEN the trial is over on time, whatever the medium has written down by then
  EXPECT_TRUE(wait_for([&] { return !asked(); }));
  const double trial_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  EXPECT_GT(trial_s, 1.5);
  EXPECT_LT(trial_s, 8);
  EXPECT_LT(worst_s, 3.0) << "another client is answered meanwhile";
  EXPECT_LT(manager.longest_silence_s(), kMostSilence_s + 8 * own.longest_s());
  std::printf("trial of 2 s: %.2f s, others waited %.3f s at most, longest silence %.2f s\n", trial_s,
              worst_s, manager.longest_silence_s());
  slow_fsync(0);
  EXPECT_LT(seconds_to_end(daemon), 6.0);
}

TEST_F(HostileClients, TickThatStandsStillGivesNoSignOfLife) {
  NotifySocket manager(directory_ + "/notify");
  // A file stands for the device of a hardware watchdog.
  const std::string device = directory_ + "/watchdog";
  write_file(device, "");
  replace_in_board("store = ", "watchdog = \"" + device + "\"\nstore = ");
  Daemon daemon(directory_, environment(manager));
  ASSERT_TRUE(wait_for([&] { return manager.hears("WATCHDOG=1"); }));
  // A tracer stops the main thread, which is the tick, and no other.
  if (::ptrace(PTRACE_SEIZE, daemon.pid(), nullptr, nullptr) != 0) GTEST_SKIP() << "no tracing here";
  ASSERT_EQ(::ptrace(PTRACE_INTERRUPT, daemon.pid(), nullptr, nullptr), 0);
  int status = 0;
  ASSERT_EQ(::waitpid(daemon.pid(), &status, __WALL), daemon.pid());
  const int signs = manager.signs();
  const std::size_t fed = read_file(device).size();
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_LE(manager.signs(), signs + 1) << "the tick stands still, all other threads run";
  EXPECT_LE(read_file(device).size(), fed + 1) << "nor is a hardware watchdog fed";
  EXPECT_NO_THROW(daemon.client(key_).slots()) << "links are served all the same";
  ASSERT_EQ(::ptrace(PTRACE_DETACH, daemon.pid(), nullptr, nullptr), 0);
  EXPECT_TRUE(wait_for([&] { return manager.signs() > signs + 2; }));
}

}  // namespace
}  // namespace vernier::hostile_clients_test
