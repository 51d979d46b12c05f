// SPDX-License-Identifier: GPL-3.0-or-later
// The daemon with a board file, as a process: uploads over Modbus TCP, kill -9 at any moment, a full store.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <filesystem>
#include <span>

#include "tests/unit/firmware/daemon_process.h"
#include "tools/text/error.h"

namespace vernier::daemon_board_test {

using namespace vernier::text;
using namespace vernier::upload;
namespace {

class DaemonBoard : public DaemonFolder {};

/// What a plain Modbus server at this port answers.
std::vector<std::uint8_t> answer_of(int port, std::span<const std::uint8_t> request) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::vector<std::uint8_t> answer(260);
  ssize_t got = -1;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0 &&
      ::send(fd, request.data(), request.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(request.size()))
    got = ::recv(fd, answer.data(), answer.size(), 0);
  ::close(fd);
  answer.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return answer;
}

TEST_F(DaemonBoard, TakesAnImageKeepsItAndRunsItAfterAKill) {
  Daemon first(directory_);
  {
    Client client = first.client(key_);
    client.upload(upload(2e-5, 1), [](double) {});
    EXPECT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
    client.confirm();
    client.upload(upload(4e-5, 2), [](double) {});  // on trial when the power goes
  }
  EXPECT_EQ(first.end(SIGKILL), -1);
  Daemon second(directory_);
  Client client = second.client(key_);
  EXPECT_EQ(client.slots().issued, 1u);
  EXPECT_EQ(client.slots().trial, kNoSlot);
  EXPECT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
  EXPECT_EQ(second.end(SIGTERM), 0) << "asked to end, it takes the correction out and ends well";
}

TEST_F(DaemonBoard, LastSettingOfTheOperatorOutlivesAKill) {
  const auto corrects = [](Client& client) {
    const BoardTick tick = client.newest();
    return tick.mode == Mode::kActive || tick.correction[0] != 0 || tick.correction[1] != 0;
  };
  {
    Daemon first(directory_);
    Client client = first.client(key_);
    client.upload(upload(2e-5, 1), [](double) {});
    ASSERT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
    client.confirm();
    client.weight(1, 0.25);
    client.command(Command::kDeactivate);
    EXPECT_EQ(first.end(SIGKILL), -1);
  }
  Daemon second(directory_);
  EXPECT_TRUE(wait_for([&] {
    return second.log().find("was deactivated or held before the start") != std::string::npos;
  })) << second.log();
  Client client = second.client(key_);
  ASSERT_TRUE(wait_for([&] { return client.newest().mode == Mode::kReady; }));
  for (int i = 0; i < 100; ++i) {
    ASSERT_FALSE(corrects(client));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(client.state().axes[1].weight, 0.25);
  client.command(Command::kActivate);
  EXPECT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
}

// Twelve of eighteen settings were lost by a kill within 9 ms of the answer.
TEST_F(DaemonBoard, AnsweredSettingIsStored) {
  replace_in_board("port = 0\n", "port = 0\nplain_commands = \"allowed\"\n");
  for (int round = 1; round <= 8; ++round) {
    const double weight = 0.1 * round;
    {
      Daemon daemon(directory_);
      Client client = daemon.client(key_);
      client.weight(0, weight);
      EXPECT_EQ(daemon.end(SIGKILL), -1);
    }
    Daemon daemon(directory_);
    Client client = daemon.client(key_);
    EXPECT_NEAR(client.state().axes[0].weight, weight, 1e-4) << round;
  }
  // By a plain master: function 6 to register 0.
  const std::uint8_t request[] = {0, 1, 0, 0, 0, 6, 1, 6, 0, 0, 0, 2};
  {
    Daemon daemon(directory_);
    EXPECT_EQ(answer_of(daemon.port(), request), std::vector<std::uint8_t>(request, request + 12));
    EXPECT_EQ(daemon.end(SIGKILL), -1);
  }
  Daemon daemon(directory_);
  EXPECT_TRUE(wait_for([&] {
    return daemon.log().find("was deactivated or held before the start") != std::string::npos;
  })) << daemon.log();
}

// A limit of the file size stands for a full medium. Without care its signal ends the daemon.
TEST_F(DaemonBoard, SettingThatCannotBeStoredIsSaidAndNeverActivates) {
  replace_in_board("port = 0\n", "port = 0\nplain_commands = \"allowed\"\n");
  {
    Daemon daemon(directory_);
    Client client = daemon.client(key_);
    client.upload(upload(2e-5, 1), [](double) {});
    ASSERT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
    client.confirm();
    const rlimit little{40, RLIM_INFINITY};
    ASSERT_EQ(::prlimit(daemon.pid(), RLIMIT_FSIZE, &little, nullptr), 0);
    try {
      client.command(Command::kDeactivate);
      ADD_FAILURE() << "the answer was: done";
    } catch (const LimitNotMet& refused) {
      EXPECT_NE(std::string(refused.what()).find("could not store the new setting"), std::string::npos)
          << refused.what();
    }
    EXPECT_TRUE(wait_for([&] { return client.newest().mode == Mode::kReady; })) << "it acts";
    EXPECT_EQ(client.state().settings & kSettingRefused, kSettingRefused);
    const std::uint8_t request[] = {0, 1, 0, 0, 0, 6, 1, 6, 0, 0, 0, 2};
    EXPECT_EQ(answer_of(daemon.port(), request), (std::vector<std::uint8_t>{0, 1, 0, 0, 0, 3, 1, 0x86, 4}));
    EXPECT_EQ(daemon.end(SIGKILL), -1);
  }
  {
    Daemon daemon(directory_);
    EXPECT_TRUE(wait_for([&] {
      return daemon.log().find("is damaged or missing: the correction stays deactivated") !=
             std::string::npos;
    })) << daemon.log();
    Client client = daemon.client(key_);
    ASSERT_TRUE(wait_for([&] { return client.newest().mode == Mode::kReady; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_EQ(client.newest().mode, Mode::kReady);
    EXPECT_EQ(client.state().settings, kSettingDamaged);
    client.command(Command::kActivate);
    ASSERT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
    EXPECT_TRUE(wait_for([&] { return client.state().settings == 0; }));
    EXPECT_EQ(daemon.end(SIGKILL), -1);
  }
  Daemon daemon(directory_);
  Client client = daemon.client(key_);
  EXPECT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
}

// The answer was: refused. The board stayed deactivated none the less.
TEST_F(DaemonBoard, DeactivationBeforeTheBoardIsReadyIsDone) {
  {
    Daemon first(directory_);
    Client client = first.client(key_);
    client.upload(upload(2e-5, 1), [](double) {});
    client.confirm();
  }
  Daemon daemon(directory_);
  Client client = daemon.client(key_);
  client.command(Command::kDeactivate);
  EXPECT_EQ(client.health().refused_commands, 0u);
  ASSERT_TRUE(wait_for([&] { return client.newest().mode == Mode::kReady; }));
  client.command(Command::kDeactivate);
  EXPECT_EQ(client.health().refused_commands, 0u) << "again, without a correction";
}

TEST_F(DaemonBoard, KilledAtAnyMomentOfUploadsItRunsAConfirmedImage) {
  {
    Daemon daemon(directory_);
    Client client = daemon.client(key_);
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
      Client client = daemon.client(key_);
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
    const std::uint64_t found = again.client(key_).slots().issued;
    ASSERT_TRUE(found == done || found == done + 1) << "round " << round << ": " << done << ", " << found;
    confirmed = found;
  }
}

TEST_F(DaemonBoard, CommandThatDoesNotFitIsCounted) {
  Daemon daemon(directory_);
  Client client = daemon.client(key_);
  client.command(Command::kClearFault);
  EXPECT_TRUE(wait_for([&] { return client.health().refused_commands == 1; }));
}

TEST_F(DaemonBoard, TellsTheServiceManagerThatItIsReadyAliveAndStopping) {
  NotifySocket manager(directory_ + "/notify");
  Daemon daemon(directory_, {manager.setting()});
  EXPECT_TRUE(wait_for([&] { return manager.hears("READY=1"); })) << manager.heard();
  EXPECT_TRUE(wait_for([&] { return manager.hears("WATCHDOG=1"); })) << manager.heard();
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  EXPECT_TRUE(wait_for([&] { return manager.hears("STOPPING=1"); })) << manager.heard();
}

// A file stands for the kernel's device: fed with line ends, disarmed by the letter V (watchdog-api.rst).
TEST_F(DaemonBoard, HardwareWatchdogIsFedWhileTicksRunAndDisarmedAtAnOrderlyEndOnly) {
  const std::string device = directory_ + "/watchdog";
  replace_in_board("store = ", "watchdog = \"" + device + "\"\nstore = ");
  for (const int signal : {SIGTERM, SIGKILL}) {
    write_file(device, "");
    Daemon daemon(directory_);
    EXPECT_TRUE(wait_for([&] { return read_file(device).size() > 2; })) << "not fed";
    daemon.end(signal);
    const std::string written = read_file(device);
    EXPECT_EQ(written.find('V'), signal == SIGTERM ? written.size() - 1 : std::string::npos)
        << "signal " << signal;
  }
}

TEST_F(DaemonBoard, TwoDaemonsDoNotShareAStore) {
  Daemon daemon(directory_);
  const std::string command = std::string(VERNIER_BIN_DIR) + "/vernierd --seconds 1 --no-realtime --board " +
                              directory_ + "/board.toml 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::string out;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out.push_back(static_cast<char>(c));
  EXPECT_EQ(WEXITSTATUS(pclose(pipe)), 2);
  EXPECT_NE(out.find("store: in use by another process"), std::string::npos) << out;
  EXPECT_TRUE(wait_for([&] { return daemon.client(key_).newest().number > 0; }));
}

TEST_F(DaemonBoard, StatusSaysWhatRunsSinceWhenAndHowMuchOfItArrives) {
  Daemon daemon(directory_);
  Client client = daemon.client(key_);
  EXPECT_EQ(client.state().image, ImageState::kNone);
  client.upload(upload(2e-5, 1), [](double) {});
  EXPECT_TRUE(wait_for([&] { return client.newest().mode == Mode::kActive; }));
  const BoardState tried = client.state();
  EXPECT_EQ(tried.image, ImageState::kTrial);
  EXPECT_NE(tried.fingerprint, 0u);
  EXPECT_EQ(tried.weight, 1);
  client.confirm();
  EXPECT_TRUE(wait_for([&] { return client.state().image == ImageState::kConfirmed; }));
  client.weight(1, 0);
  EXPECT_TRUE(wait_for([&] { return client.state().axes[1].weight == 0; }));
  EXPECT_TRUE(wait_for([&] { return std::abs(client.state().axes[1].achieved) < 1e-6; }));
  EXPECT_NE(client.state().axes[1].wanted, 0);
}

// Off this computer a link shows the state and no more, unless the board file says so.
TEST_F(DaemonBoard, LinkOffThisComputerOnlyShowsTheState) {
  replace_in_board("port = 0", "address = \"0.0.0.0\"\nport = 0");
  Daemon daemon(directory_, {}, "0.0.0.0");
  Client client = daemon.client(key_);
  EXPECT_NO_THROW(client.newest());
  EXPECT_THROW(client.command(Command::kActivate), LimitNotMet);
  EXPECT_THROW(client.upload(upload(2e-5, 1), [](double) {}), LimitNotMet);
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
        BadBoard{"NameOfATable", "[axis.X]", "[`xis.X]", "board.toml:8: "},
        BadBoard{"LetterOfAnotherAlphabet", "unit = \"degC\"", "unit = °C",
                 "\"°C\": letters beyond ASCII must be in quotes, on one line"},
        BadBoard{"LetterAsAName", "high = 600", "hïgh = 600", "board.toml:9: \"hïgh\": "},
        BadBoard{"LetterBehindABackslash", "name = \"test\"", "name = \"\\ä\"", "board.toml:2: "},
        BadBoard{"UnknownSetting", "trial_s", "trail_s", "board.toml:5: board: unknown setting trail_s"},
        BadBoard{"UnknownSection", "[[link]]", "[[lnik]]", "unknown section lnik"},
        BadBoard{"NoKeyFile", "key.pub", "none.pub", "none.pub: cannot be read as a public key"},
        BadBoard{"Type", "high = 600", "high = \"600\"", "board.toml:9: axis.X: high must be a number"},
        BadBoard{"Range", "trial_s = 30", "trial_s = -1", "trial_s must be between 0.1 and 86400"},
        BadBoard{"Kind", "[input.T]\nunit = \"degC\"", "[input.T]\nkind = \"degC\"", "unknown setting kind"},
        BadBoard{"NoPosition", "position = { kind = \"sim\" }\n", "", "axis.X: position is missing"},
        BadBoard{"Device", "source = { kind = \"sim\" }", "source = { kind = \"thermo\" }",
                 "no input of kind thermo"},
        BadBoard{"FeatureOfNothing", "source = { kind = \"sim\" }",
                 "source = { kind = \"feature\", of = \"acc\", feature = \"RMS\" }",
                 "input.T.source: of: the board file has no input acc"},
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
        BadBoard{"DisplacementOfDegrees", "source = { kind = \"sim\" }",
                 "source = { kind = \"sim\" }\n[input.D]\nunit = \"um\"\nsource = { kind = \"feature\", of = "
                 "\"T\", feature = \"DISPLACEMENT\", corner_Hz = 0.5 }",
                 "input.D.source: T is in \"degC\": a displacement needs an acceleration in g"},
        BadBoard{"DisplacementUnit", "source = { kind = \"sim\" }",
                 "source = { kind = \"feature\", of = \"A\", feature = \"DISPLACEMENT\", corner_Hz = 0.5 }\n"
                 "[input.A]\nunit = \"g\"\nsource = { kind = \"sim\" }",
                 "a displacement is in um"},
        BadBoard{"DisplacementWithoutCorner", "source = { kind = \"sim\" }",
                 "source = { kind = \"sim\" }\n[input.D]\nunit = \"um\"\nsource = { kind = \"feature\", of = "
                 "\"A\", feature = \"DISPLACEMENT\" }\n[input.A]\nunit = \"g\"\nsource = { kind = \"sim\" }",
                 "corner_Hz must be between 0.001 and 1000"},
        BadBoard{
            "DisplacementCorner", "source = { kind = \"sim\" }",
            "source = { kind = \"sim\" }\n[input.D]\nunit = \"um\"\nsource = { kind = \"feature\", of = "
            "\"A\", feature = \"DISPLACEMENT\", corner_Hz = 20 }\n[input.A]\nunit = \"g\"\nsource = { kind "
            "= \"sim\" }",
            "input.D.source: the settings `window` or `corner_Hz` are outside their limits"},
        BadBoard{"DisplacementWindow", "source = { kind = \"sim\" }",
                 "source = { kind = \"sim\" }\n[input.D]\nunit = \"um\"\nsource = { kind = \"feature\", of = "
                 "\"A\", feature = \"DISPLACEMENT\", corner_Hz = 1, window = 800 }\n[input.A]\nunit = "
                 "\"g\"\nsource = { kind = \"sim\" }",
                 "unknown setting window"},
        BadBoard{"NoName", "name = \"test\"\n", "",
                 "board.toml:1: board: name is missing: images are signed for a board"},
        BadBoard{"Role", "[[link]]", "[[key]]\nname = \"a\"\nfile = \"key.pub\"\nrole = \"boss\"\n[[link]]",
                 "role: 'boss' is not one of"},
        BadBoard{"KeyTwice", "[[link]]", "[[key]]\nname = \"a\"\nfile = \"key.pub\"\n[[link]]",
                 "the board file has this key twice"},
        BadBoard{"Access", "port = 0", "access = \"all\"", "access: 'all' is not one of"},
        BadBoard{"Link", "kind = \"modbus-tcp\"", "kind = \"telnet\"", "no link of kind telnet"}),
    [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace vernier::daemon_board_test
