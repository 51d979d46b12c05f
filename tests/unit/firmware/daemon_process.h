// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The daemon as a process, for tests.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/unit/firmware/upload_rig.h"
#include "tools/text/files.h"
#include "tools/upload/client.h"
#include "tools/upload/open_transport.h"

extern char** environ;

namespace vernier {

using namespace vernier::text;
using namespace vernier::upload;

inline bool wait_for(const std::function<bool()>& done, int seconds = 20) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// A running vernierd.
class Daemon {
 public:
  /// more: further settings of its environment, "NAME=value".
  explicit Daemon(const std::string& directory, const std::vector<std::string>& more = {},
                  const std::string& address = "127.0.0.1")
      : log_(directory + "/log"), address_(address) {
    write_file(log_, "");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, log_.c_str(), O_WRONLY | O_APPEND, 0);
    const std::string program = std::string(VERNIER_BIN_DIR) + "/vernierd", board = directory + "/board.toml";
    const char* const arguments[] = {program.c_str(), "--board", board.c_str(), "--no-realtime", nullptr};
    std::vector<char*> environment;
    for (const std::string& setting : more) environment.push_back(const_cast<char*>(setting.c_str()));
    for (char** setting = environ; *setting != nullptr; ++setting) environment.push_back(*setting);
    environment.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, program.c_str(), &actions, nullptr, const_cast<char**>(arguments),
                          environment.data()),
              0);
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_TRUE(wait_for([&] { return port() != 0; })) << read_file(log_);
  }
  ~Daemon() { end(SIGKILL); }
  /// Exit status after a signal; -1 where the signal ended it.
  int end(int signal) {
    if (pid_ == 0) return 0;
    ::kill(pid_, signal);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  pid_t pid() const { return pid_; }
  std::string log() const { return read_file(log_); }
  int port() const {
    const std::string text = read_file(log_), before = "Modbus TCP on " + address_ + ":";
    const std::size_t at = text.find(before);
    if (at == std::string::npos || text.find('\n', at) == std::string::npos) return 0;
    return std::atoi(text.c_str() + at + before.size());
  }
  Client client(const std::optional<SigningKey>& key = std::nullopt) const {
    Client client(open_transport(parse_url("tcp://127.0.0.1:" + std::to_string(port()))));
    client.sign_with(key);
    return client;
  }

 private:
  std::string log_, address_;
  pid_t pid_ = 0;
};

/// The service manager's side of sd_notify: hears what a daemon says, and when. A thread of its own takes
/// what comes, so that a test that is held up elsewhere never takes its own pause for a silence of the
/// daemon.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path)
      : path_(path), fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    EXPECT_LT(path.size(), sizeof(address.sun_path));
    path.copy(address.sun_path, path.size());
    EXPECT_EQ(::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    const timeval patience{.tv_sec = 0, .tv_usec = 20'000};
    EXPECT_EQ(::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience)), 0);
    thread_ = std::thread([this] { listen(); });
  }
  ~NotifySocket() {
    stop_ = true;
    thread_.join();
    ::close(fd_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;
  std::string setting() const { return "NOTIFY_SOCKET=" + path_; }
  /// Has `word` been heard by now?
  bool hears(const std::string& word) const { return heard().find(word) != std::string::npos; }
  std::string heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
  }
  /// Longest silence between two signs of life, and since the last one; s.
  double longest_silence_s() const {
    const std::lock_guard lock(mutex_);
    return std::max(longest_s_, since_last_s());
  }
  int signs() const {
    const std::lock_guard lock(mutex_);
    return signs_;
  }
  /// Counts silences from the last sign on.
  void forget() {
    const std::lock_guard lock(mutex_);
    longest_s_ = 0;
  }

 private:
  void listen() {
    char text[64];
    while (!stop_) {
      const ssize_t got = ::recv(fd_, text, sizeof(text), 0);
      if (got <= 0) continue;
      const std::string said(text, static_cast<std::size_t>(got));
      const std::lock_guard lock(mutex_);
      heard_ += said + "\n";
      if (said != "WATCHDOG=1") continue;
      if (signs_++ > 0) longest_s_ = std::max(longest_s_, since_last_s());
      last_sign_ = std::chrono::steady_clock::now();
    }
  }
  double since_last_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_sign_).count();
  }

  std::string path_;
  int fd_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::string heard_;
  int signs_ = 0;
  std::chrono::steady_clock::time_point last_sign_{};
  double longest_s_ = 0;
  std::thread thread_;
};

inline constexpr const char* kBoardText = R"([board]
name = "test"
store = "store"
public_key = "key.pub"
trial_s = 30
activate = true
max_lost_ticks = 0.9   # an emulation, or a busy computer, leaves many out
[axis.X]
high = 600
position = { kind = "sim" }
output = { kind = "sim" }
[axis.Y]
high = 200
position = { kind = "sim" }
output = { kind = "sim" }
[input.T]
unit = "degC"
reference = 21
source = { kind = "sim" }
[[link]]
kind = "modbus-tcp"
port = 0
)";

/// A folder with a board of simulated axes, and its key.
class DaemonFolder : public testing::Test {
 protected:
  DaemonFolder() {
    std::filesystem::create_directories(directory_);
    write_file(directory_ + "/key.pub", public_key_text(key_));
    write_file(directory_ + "/board.toml", kBoardText);
  }
  ~DaemonFolder() override { std::filesystem::remove_all(directory_); }
  std::vector<std::uint8_t> upload(double scale, std::uint64_t issued) const {
    return make_upload(small_image_bytes(scale), key_, issued, 0, "test");
  }
  void replace_in_board(const std::string& from, const std::string& to) const {
    std::string text = read_file(directory_ + "/board.toml");
    text.replace(text.find(from), from.size(), to);
    write_file(directory_ + "/board.toml", text);
  }
  const SigningKey key_ = new_key();
  const std::string directory_ = testing::TempDir() + "daemon_" + std::to_string(getpid()) + "_" +
                                 testing::UnitTest::GetInstance()->current_test_info()->name();
};

}  // namespace vernier
