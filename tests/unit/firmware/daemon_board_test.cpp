// SPDX-License-Identifier: GPL-3.0-or-later
// The daemon with a board file, as a process: uploads over Modbus TCP, kill -9 at any moment, a full store.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include "tests/unit/firmware/upload_rig.h"
#include "tools/text/files.h"
#include "tools/upload/client.h"

extern char** environ;

namespace vernier::daemon_board_test {
namespace {

bool wait_for(const std::function<bool()>& done, int seconds = 20) {
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
  explicit Daemon(const std::string& directory) : log_(directory + "/log") {
    write_file(log_, "");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, log_.c_str(), O_WRONLY | O_APPEND, 0);
    const std::string program = std::string(VERNIER_BIN_DIR) + "/vernierd", board = directory + "/board.toml";
    const char* const arguments[] = {program.c_str(), "--board", board.c_str(), "--no-realtime", nullptr};
    EXPECT_EQ(posix_spawn(&pid_, program.c_str(), &actions, nullptr, const_cast<char**>(arguments), environ),
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
  int port() const {
    const std::string text = read_file(log_), before = "Modbus TCP on 127.0.0.1:";
    const std::size_t at = text.find(before);
    if (at == std::string::npos || text.find('\n', at) == std::string::npos) return 0;
    return std::atoi(text.c_str() + at + before.size());
  }
  Client client() const {
    return Client(open_transport(parse_url("tcp://127.0.0.1:" + std::to_string(port()))));
  }

 private:
  std::string log_;
  pid_t pid_ = 0;
};

class DaemonBoard : public testing::Test {
 protected:
  DaemonBoard() {
    std::filesystem::create_directories(directory_);
    write_file(directory_ + "/key.pub", public_key_text(key_));
    write_file(directory_ + "/board.toml", R"([board]
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
)");
  }
  ~DaemonBoard() override { std::filesystem::remove_all(directory_); }
  std::vector<std::uint8_t> upload(double scale, std::uint64_t issued) const {
    return make_upload(small_image_bytes(scale), key_, issued, 0);
  }
  const SigningKey key_ = new_key();
  const std::string directory_ = testing::TempDir() + "daemon_" + std::to_string(getpid()) + "_" +
                                 testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(DaemonBoard, TakesAnImageKeepsItAndRunsItAfterAKill) {
  Daemon first(directory_);
  {
    Client client = first.client();
    client.upload(upload(2e-5, 1), [](double) {});
    EXPECT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
    client.confirm();
    client.upload(upload(4e-5, 2), [](double) {});  // on trial when the power goes
  }
  EXPECT_EQ(first.end(SIGKILL), -1);
  Daemon second(directory_);
  Client client = second.client();
  EXPECT_EQ(client.slots().issued, 1u);
  EXPECT_EQ(client.slots().trial, kNoSlot);
  EXPECT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
  EXPECT_EQ(second.end(SIGTERM), 0) << "asked to end, it takes the correction out and ends well";
}

TEST_F(DaemonBoard, KilledAtAnyMomentOfUploadsItRunsAConfirmedImage) {
  {
    Daemon daemon(directory_);
    Client client = daemon.client();
    client.upload(upload(2e-5, 1), [](double) {});
    client.confirm();
  }
  std::uint64_t confirmed = 1;
  for (std::uint64_t round = 0; round < 12; ++round) {
    Daemon daemon(directory_);
    std::uint64_t done = confirmed;
    std::thread killer([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(500 + 2300 * round));
      daemon.end(SIGKILL);
    });
    try {
      Client client = daemon.client();
      for (std::uint64_t issued = confirmed + 1; issued < confirmed + 1000; ++issued) {
        client.upload(upload(2e-5 + 1e-8 * static_cast<double>(issued), issued), [](double) {});
        client.confirm();
        done = issued;
      }
    } catch (const std::exception&) {
      // The daemon is gone.
    }
    killer.join();
    Daemon again(directory_);
    const std::uint64_t found = again.client().slots().issued;
    ASSERT_TRUE(found == done || found == done + 1) << "round " << round << ": " << done << ", " << found;
    confirmed = found;
  }
}

TEST_F(DaemonBoard, CommandThatDoesNotFitIsCounted) {
  Daemon daemon(directory_);
  Client client = daemon.client();
  client.command(Command::kClearFault);
  EXPECT_TRUE(wait_for([&] { return client.health().refused_commands == 1; }));
}

TEST_F(DaemonBoard, TellsTheServiceManagerThatItIsReadyAliveAndStopping) {
  const std::string path = directory_ + "/notify";
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof(address.sun_path));
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  ASSERT_EQ(::setenv("NOTIFY_SOCKET", path.c_str(), 1), 0);
  Daemon daemon(directory_);
  ::unsetenv("NOTIFY_SOCKET");
  std::string heard;
  const auto hears = [&](const char* word) {
    char text[64];
    const ssize_t got = ::recv(fd, text, sizeof(text), MSG_DONTWAIT);
    if (got > 0) heard += std::string(text, static_cast<std::size_t>(got)) + "\n";
    return heard.find(word) != std::string::npos;
  };
  EXPECT_TRUE(wait_for([&] { return hears("READY=1"); })) << heard;
  EXPECT_TRUE(wait_for([&] { return hears("WATCHDOG=1"); })) << heard;
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  EXPECT_TRUE(wait_for([&] { return hears("STOPPING=1"); })) << heard;
  ::close(fd);
}

struct BadBoard {
  const char* name;
  const char* from;
  const char* to;
  const char* said;
};

class BoardFileError : public DaemonBoard, public testing::WithParamInterface<BadBoard> {};

TEST_P(BoardFileError, NamesFileLineAndWord) {
  std::string text = read_file(directory_ + "/board.toml");
  const std::string from = GetParam().from;
  text.replace(text.find(from), from.size(), GetParam().to);
  write_file(directory_ + "/board.toml", text);
  const std::string command =
      std::string(VERNIER_BIN_DIR) + "/vernierd --check --board " + directory_ + "/board.toml 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out.push_back(static_cast<char>(c));
  const int status = pclose(pipe);
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_NE(out.find(GetParam().said), std::string::npos) << out;
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BoardFileError,
    testing::Values(
        BadBoard{"Syntax", "[board]", "[board", "board.toml:1: "},
        BadBoard{"UnknownSetting", "trial_s", "trail_s", "board.toml:4: board: unknown setting trail_s"},
        BadBoard{"UnknownSection", "[[link]]", "[[lnik]]", "unknown section lnik"},
        BadBoard{"NoKeyFile", "key.pub", "none.pub", "none.pub: cannot be read as a public key"},
        BadBoard{"Type", "high = 600", "high = \"600\"", "board.toml:8: axis.X: high must be a number"},
        BadBoard{"Range", "trial_s = 30", "trial_s = -1", "trial_s must be between 0.1 and 86400"},
        BadBoard{"Kind", "[input.T]\nunit = \"degC\"", "[input.T]\nkind = \"degC\"", "unknown setting kind"},
        BadBoard{"NoPosition", "position = { kind = \"sim\" }\n", "", "axis.X: position is missing"},
        BadBoard{"Device", "source = { kind = \"sim\" }", "source = { kind = \"thermo\" }",
                 "no input of kind thermo"},
        BadBoard{"FeatureOfNothing", "source = { kind = \"sim\" }",
                 "source = { kind = \"feature\", of = \"acc\", feature = \"RMS\" }",
                 "input.T.source: of: the board has no input acc"},
        BadBoard{"FeatureOfItself", "source = { kind = \"sim\" }",
                 "source = { kind = \"feature\", of = \"T\", feature = \"RMS\" }", "T is a feature itself"},
        BadBoard{"FeatureName", "source = { kind = \"sim\" }",
                 "source = { kind = \"feature\", of = \"A\", feature = \"rms\" }\n[input.A]\n"
                 "source = { kind = \"sim\" }",
                 "no feature rms"},
        BadBoard{"FeatureWindow", "source = { kind = \"sim\" }",
                 "source = { kind = \"feature\", of = \"A\", feature = \"RMS\", window = 801 }\n[input.A]\n"
                 "source = { kind = \"sim\" }",
                 "window must be even"},
        BadBoard{"FeatureResolution", "source = { kind = \"sim\" }",
                 "source = { kind = \"feature\", of = \"A\", feature = \"RMS\", resolution = 1.5e-6 }\n"
                 "[input.A]\nsource = { kind = \"sim\" }",
                 "resolution must be a whole number of millionths"},
        BadBoard{"Link", "kind = \"modbus-tcp\"", "kind = \"telnet\"", "no link of kind telnet"}),
    [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace vernier::daemon_board_test
