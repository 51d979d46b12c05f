// SPDX-License-Identifier: GPL-3.0-or-later
// `vernierd --check` as a process: every device is really tried, one line each, and what is missing is named;
// and what a daemon does to a converter that holds a value from before.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <thread>
#include <tuple>
#include <vector>

#include "tests/conformance/linux_devices.h"

namespace vernier::check_test {
namespace {

constexpr const char* kBoard = R"([board]
store = "store"
[axis.X]
max_speed = 100
max_correction = 0.2
max_step = 0.001
position = { kind = "sim" }
output = { kind = "pwm", path = "ROOT/pwm0", period_ns = 50000, span = 0.25 }
[axis.Y]
max_speed = 100
max_correction = 0.2
max_step = 0.001
position = { kind = "sim" }
output = { kind = "iio-dac", root = "ROOT", device = "mcp4922", channel = 1, codes = 255, span = 0.25, zero = 127, high = 254 }
[input.T]
unit = "degC"
source = { kind = "iio", root = "ROOT", device = "tmp117", attribute = "in_temp_input", scale = 0.001 }
)";

/// The published chain of the hybrid mill: 0-10 V, 25 um/V, 8 bit, 127 is 5 V, 12 updates a second.
constexpr const char* kPublished = R"([board]
store = "store"
[axis.X]
max_speed = 20
max_correction = 0.2
max_step = 0.001
correction_share = 0.01
position = { kind = "sim" }
output = { kind = "iio-dac", root = "ROOT", device = "mcp4922", channel = 1, codes = 255, span = 0.25, zero = 127, high = 254, delay_ms = 83.3 }
)";

struct Said {
  int status;
  std::string text;
};

class Check : public testing::Test {
 protected:
  Check() {
    files_.put("pwm0/period", "50000"), files_.put("pwm0/duty_cycle", "25000"),
        files_.put("pwm0/enable", "1");
    files_.put("iio:device3/name", "mcp4922"), files_.put("iio:device3/out_voltage1_raw", "200");
    files_.put("iio:device4/name", "tmp117"), files_.put("iio:device4/in_temp_input", "21500");
    write(kBoard);
  }
  void write(std::string text) const {
    for (std::size_t at = 0; (at = text.find("ROOT")) != std::string::npos;)
      text.replace(at, 4, files_.path());
    files_.put("board.toml", text);
  }
  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  }
  Said run(const std::string& arguments, const std::string& input = "") const {
    const std::string command = input + std::string(VERNIER_BIN_DIR) + "/vernierd --board " + files_.path() +
                                "/board.toml --no-realtime " + arguments + " 2>&1";
    std::FILE* const pipe = popen(command.c_str(), "r");
    std::string out;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out.push_back(static_cast<char>(c));
    const int status = pclose(pipe);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out};
  }
  void expect_missing(const std::string& line) const {
    const Said said = run("--check");
    EXPECT_EQ(said.status, 2);
    EXPECT_NE(said.text.find(line), std::string::npos) << said.text;
    EXPECT_NE(said.text.find(": 1 missing"), std::string::npos) << said.text;
  }
  const SysfsDirectory files_{testing::TempDir() + "check_" + std::to_string(getpid()) + "_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name()};
};

TEST_F(Check, SaysWhatThePublishedChainAddsToTheError) {
  write(kPublished);
  const Said said = run("--check");
  EXPECT_EQ(said.status, 0) << said.text;
  // 250 um over 255 codes; 0.2 mm/s for 83.3 ms.
  EXPECT_NE(said.text.find("budget   axis.X.output: -124.51 to 124.51 um, step 0.9804, error at most 0.4902 "
                           "(rms 0.283); at most 0.2 um a tick; delay 83.3 "
                           "ms: at most 16.66 more at the largest speed of the correction\n"),
            std::string::npos)
      << said.text;
}

TEST_F(Check, SaysOneLinePerDeviceAndMovesNothing) {
  const Said said = run("--check");
  EXPECT_EQ(said.status, 0) << said.text;
  for (const char* line :
       {"ok       axis.X.position  sim\n", "ok       axis.X.output  pwm\n",
        "ok       axis.Y.output  iio-dac\n", "ok       input.T  iio\n", "6 devices: all there"})
    EXPECT_NE(said.text.find(line), std::string::npos) << line << said.text;
  EXPECT_EQ(files_.get("iio:device3/out_voltage1_raw"), "200");
}

TEST_F(Check, NamesAConverterThatIsNotThere) {
  std::filesystem::remove(files_.path() + "/iio:device3/out_voltage1_raw");
  expect_missing("missing  axis.Y.output  iio-dac: ");
  EXPECT_EQ(run("--seconds 0.1").status, 2) << "it does not run without it";
}

TEST_F(Check, NamesAConverterThatRefuses) {
  files_.break_writes("iio:device3/out_voltage1_raw");
  expect_missing("missing  axis.Y.output  iio-dac: the present value of the device cannot be read");
}

TEST_F(Check, LeavesNoEmptyFolderOfTheStore) {
  write(replaced(kBoard, "store = \"store\"", "store = \"deep/store\""));
  for (const char* const how : {"--check", "--zero"}) {
    EXPECT_EQ(run(how).status, 0);
    EXPECT_FALSE(std::filesystem::exists(files_.path() + "/deep")) << how;
  }
  std::filesystem::remove_all(files_.path() + "/pwm0");
  EXPECT_EQ(run("--seconds 0.1").status, 2) << "a start without its output";
  EXPECT_FALSE(std::filesystem::exists(files_.path() + "/deep"));
  // A folder that was there stays, and so does one with contents.
  std::filesystem::create_directories(files_.path() + "/deep");
  EXPECT_EQ(run("--check").status, 2);
  EXPECT_TRUE(std::filesystem::exists(files_.path() + "/deep"));
  EXPECT_FALSE(std::filesystem::exists(files_.path() + "/deep/store"));
  files_.put("pwm0/period", "50000"), files_.put("pwm0/duty_cycle", "25000"), files_.put("pwm0/enable", "1");
  EXPECT_EQ(run("--seconds 0.1").status, 0);
  EXPECT_TRUE(std::filesystem::exists(files_.path() + "/deep/store/identity.pub"));
}

// The board file's own span does not stand in for a calibration that is named and not there.
TEST_F(Check, NamesACalibrationThatIsNotThere) {
  write(replaced(kBoard, "span = 0.25 }", "span = 0.25, calibration = \"typo.toml\" }"));
  const Said said = run("--check");
  EXPECT_EQ(said.status, 2) << said.text;
  EXPECT_NE(
      said.text.find(
          "missing  axis.X.output  calibration " + files_.path() +
          "/typo.toml: the calibration file does not exist; make this file with vernierd --calibrate X\n"),
      std::string::npos)
      << said.text;
  EXPECT_NE(said.text.find("1 file: 1 missing\n"), std::string::npos) << said.text;
  EXPECT_EQ(run("--seconds 0.1").status, 2) << "it does not run uncalibrated";
  files_.put("typo.toml", "span = 0.25\npolarity = \"normal\"\n");
  EXPECT_NE(run("--check").text.find("zero is missing"), std::string::npos) << "code 0 is no zero";
  EXPECT_NE(run("--seconds 0.1").status, 0);
  files_.put("typo.toml", "span = 0.25\nzero = 25000\npolarity = \"normal\"\n");
  EXPECT_EQ(run("--check").status, 0) << run("--check").text;
}

TEST_F(Check, NamesAWatchdogThatIsNotThereAndOpensNone) {
  write(replaced(kBoard, "store = ", "watchdog = \"ROOT/watchdog\"\nstore = "));
  expect_missing("missing  board.watchdog  " + files_.path() + "/watchdog: No such file or directory\n");
  EXPECT_EQ(run("--seconds 0.1").status, 2) << "it does not run without it";
  files_.put("watchdog", "");
  const Said said = run("--check");
  EXPECT_EQ(said.status, 0) << said.text;
  EXPECT_NE(said.text.find("not looked at  board.watchdog: "), std::string::npos) << said.text;
  EXPECT_EQ(files_.get("watchdog"), "") << "it was not fed";
}

TEST_F(Check, SaysWhatItDoesNotLookAt) {
  const Said said = run("--check");
  for (const char* line : {"not looked at  axis.X.output: ", "not looked at  store: "})
    EXPECT_NE(said.text.find(line), std::string::npos) << line << said.text;
}

TEST_F(Check, NamesAPulseOutputThatIsNotExported) {
  std::filesystem::remove_all(files_.path() + "/pwm0");
  expect_missing("/pwm0/period: No such file or directory");
}

TEST_F(Check, NamesASensorThatIsSilent) {
  files_.put("iio:device4/in_temp_input", "");
  expect_missing("missing  input.T  iio: the sensor gives no number");
}

TEST_F(Check, HearsASensorsBufferAndNamesOneThatIsSilent) {
  files_.put("iio:device5/name", "adxl355"), files_.put("iio:device5/buffer/enable", "0");
  files_.put("iio:device5/buffer/length", "2"), files_.put("iio:device5/scan_elements/in_accel_x_en", "0");
  files_.put("iio:device5/scan_elements/in_accel_x_index", "0");
  files_.put("iio:device5/scan_elements/in_accel_x_type", "le:s16/16>>0");
  files_.put("dev/README", "a pipe stands for the device");
  ASSERT_EQ(::mkfifo((files_.path() + "/dev/iio:device5").c_str(), 0600), 0);
  const std::string buffered =
      std::string(kBoard) +
      "[input.a]\nunit = \"m/s^2\"\nsource = { kind = \"iio-buffer\", root = \"ROOT\", devices = "
      "\"ROOT/dev\", device = \"adxl355\", channel = \"accel_x\", scale = 0.001 }\n";
  write(buffered);
  expect_missing("missing  input.a  iio-buffer: no scan of this sensor has come within 1 s");
  const int pipe = ::open((files_.path() + "/dev/iio:device5").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  std::atomic<bool> stop{false};
  std::thread feeder([&] {
    for (; !stop; std::this_thread::sleep_for(std::chrono::milliseconds(1)))
      static_cast<void>(::write(pipe, "ab", 2) == 2);
  });
  const Said heard = run("--check");
  stop = true;
  feeder.join();
  ::close(pipe);
  EXPECT_EQ(heard.status, 0) << heard.text;
  EXPECT_NE(heard.text.find("ok       input.a  iio-buffer\n"), std::string::npos) << heard.text;
  EXPECT_EQ(files_.get("iio:device5/buffer/enable"), "0") << "it is stopped again";
  write(buffered +
        "[input.b]\nunit = \"m/s^2\"\nsource = { kind = \"iio-buffer\", root = \"ROOT\", device = "
        "\"adxl355\", channel = \"accel_x\", scale = 0.001 }\n");
  const Said twice = run("--check");
  EXPECT_EQ(twice.status, 1);
  EXPECT_NE(twice.text.find("another input uses this channel"), std::string::npos) << twice.text;
}

TEST_F(Check, NamesABusThatIsNotThere) {
  write(replaced(kBoard, "{ kind = \"sim\" }", "{ kind = \"can\", interface = \"nocan\", id = 0x181 }"));
  expect_missing("missing  axis.X.position  can nocan id 0x181: nocan: ");
}

TEST_F(Check, NamesLinesWhoseChipIsNotThere) {
  write(std::string(kBoard) + R"([probe]
delay_us = 12.5
delay_spread_us = 0.5
line = { kind = "gpio", chip = "no_such_chip", line = 3, polarity = "inverted" }
[digital]
enable = { kind = "gpio", chip = "no_such_chip", line = 4 }
healthy = { kind = "gpio", chip = "/dev/no_such_chip", line = 5 }
)");
  const Said said = run("--check");
  EXPECT_EQ(said.status, 2) << said.text;
  for (const char* line :
       {"missing  probe.line  gpio: GPIO chip no_such_chip: No such file or directory\n",
        "missing  digital.enable  gpio: GPIO chip no_such_chip: No such file or directory\n",
        "missing  digital.healthy  gpio: GPIO chip /dev/no_such_chip: No such file or directory\n",
        "9 devices: 3 missing"})
    EXPECT_NE(said.text.find(line), std::string::npos) << line << said.text;
}

TEST_F(Check, WrongSettingsOfLinesAreNamed) {
  for (const char* wrong : {"[probe]\ndelay_us = 1\n", "[probe]\nline = { kind = \"gpio\", chip = \"a\" }\n",
                            "[probe]\nline = { kind = \"gpoi\", chip = \"a\", line = 1 }\n",
                            "[probe]\ndelay_us = -1\nline = { kind = \"gpio\", chip = \"a\", line = 1 }\n",
                            "[digital]\nenabel = { kind = \"gpio\", chip = \"a\", line = 1 }\n",
                            "[digital]\nenable = { kind = \"gpio\", chip = \"a\", line = 1.5 }\n"}) {
    write(std::string(kBoard) + wrong);
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << wrong << said.text;
    EXPECT_NE(said.text.find("board.toml:"), std::string::npos) << wrong << said.text;
  }
}

TEST_F(Check, WrongSettingsOfRegistersAreNamed) {
  const std::string pwm(kBoard);
  const auto begin = pwm.find("output = {"), end = pwm.find('\n', begin);
  const auto board = [&](const std::string& settings) {
    return pwm.substr(0, begin) + "output = { kind = \"modbus-out\", " + settings + " }" + pwm.substr(end);
  };
  const std::string place = "address = \"127.0.0.1\", port = 1, register = 100, ";
  const std::pair<std::string, const char*> kWrong[] = {
      {place + "echo = 50, range = 0.2", "resolution is missing"},
      {place + "echo = 50, resolution = 1e-6", "range is missing"},
      {place + "echo = 50, resolution = 1e-6, range = 1e-7", "range must be at least resolution"},
      {place + "echo = 50, resolution = 1e-9, range = 2", "range must be"},
      {place + "echo = 103, resolution = 1e-6, range = 0.2",
       "echo is among the registers that the board writes"},
      {place + "echo = 50, resolution = 1e-6, range = 0.2, timeout_ms = 19", "at least four times period_ms"},
      {place + "echo = 50, resolution = 1e-6, range = 0.2, device = \"/dev/x\"",
       "device or address, not both"},
      {place + "echo = 50, resolution = 1e-6, range = 0.2, place = 16", "place"},
      {place + "echo = 50, resolution = 1e-6, range = 0.2, span = 1", "unknown setting span"}};
  for (const auto& [settings, said_of_it] : kWrong) {
    write(board(settings));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << settings << said.text;
    EXPECT_NE(said.text.find(said_of_it), std::string::npos) << settings << said.text;
  }
  write(board(place + "echo = 50, resolution = 1e-6, range = 0.2"));
  const Said gone = run("--check");
  EXPECT_EQ(gone.status, 2) << gone.text;
  EXPECT_NE(gone.text.find("missing  axis.X.output  modbus-out: the controller gives no valid answer"),
            std::string::npos)
      << gone.text;
}

/// The same board in the spelling of one table for each axis and each output.
constexpr const char* kTables = R"([board]
store = "store"
[[axis]]
name = "X"
kind = "sim"
max_speed = 100
max_correction = 0.2
max_step = 0.001
[[axis]]
name = "C"
kind = "sim"
rotary = true
rollover = true
max_speed = 100
max_correction = 0.2
max_step = 0.001
[[output]]
axis = "C"
kind = "iio-dac"
root = "ROOT"
device = "mcp4922"
channel = 1
codes = 255
span = 0.25
[[output]]
axis = "X"
kind = "modbus"
address = "127.0.0.1"
port = 1
unit = 3
register = 104
sequence = 100
valid = 101
echo = 50
scale = 0.01
)";

TEST_F(Check, TablesOfAxesAndOutputsAreRead) {
  write(kTables);
  const Said said = run("--check");
  EXPECT_EQ(said.status, 2) << said.text;
  for (const char* line :
       {"ok       axis.X.position  sim\n", "ok       axis.C.position  sim\n",
        "missing  axis.X.output  modbus-out: the controller gives no valid answer",
        "ok       axis.C.output  iio-dac", "budget   axis.C.output: -124.51 to 125.49 mdeg"})
    EXPECT_NE(said.text.find(line), std::string::npos) << line << said.text;
  // The last block of the registers; `valid` is the register after `sequence` if it is not given.
  write(replaced(
      replaced(replaced(kTables, "sequence = 100", "sequence = 65532"), "register = 104", "register = 65534"),
      "valid = 101\n", ""));
  EXPECT_EQ(run("--check").status, 2);
  // An [[output]] belongs to an [axis.NAME] as well.
  write(std::string(kPublished) +
        "[axis.C]\nkind = \"rotary\"\nmax_speed = 100\nmax_correction = 0.2\nmax_step = 0.001\n"
        "position = { kind = \"sim\" }\n[[output]]\naxis = \"C\"\nkind = \"pwm\"\npath = \"ROOT/pwm0\"\n"
        "period_ns = 50000\nspan = 0.25\n");
  const Said both = run("--check");
  EXPECT_EQ(both.status, 0) << both.text;
  EXPECT_NE(both.text.find("ok       axis.C.output  pwm\n"), std::string::npos) << both.text;
}

TEST_F(Check, WrongTablesOfAxesAndOutputsAreNamedWithTheLineOfTheSetting) {
  const std::tuple<const char*, const char*, const char*> kWrong[] = {
      {"name = \"C\"", "name = \"X\"", "board.toml:10: axis: name: 'X' occurs twice"},
      {"name = \"C\"", "", "board.toml:9: axis: name is missing"},
      {"kind = \"sim\"\nrotary", "rotary", "board.toml:9: axis C: kind is missing"},
      {"rotary = true", "rotary = \"yes\"", "board.toml:12: axis C: rotary must be true or false"},
      {"rotary = true", "rotate = 1", "board.toml:12: axis C: unknown setting rotate of kind sim"},
      {"max_step = 0.001\n[[output]]", "[[output]]", "board.toml:9: axis C: max_step or max_acceleration"},
      {"axis = \"C\"", "axis = \"B\"", "board.toml:18: output: axis: the board file has no axis 'B'"},
      {"axis = \"C\"", "axis = \"X\"", "board.toml:26: output: axis: 'X' has an output already"},
      {"axis = \"C\"", "", "board.toml:17: output: axis is missing"},
      {"span = 0.25", "spun = 0.25", "board.toml:24: output of C: unknown setting spun of kind iio-dac"},
      {"unit = 3", "unit = 300", "board.toml:30: output of X: unit must be a whole number from 1 to 247"},
      {"register = 104", "register = 103",
       "board.toml:31: output of X: register must be sequence + 2 + 2 * n"},
      {"register = 104", "register = 134",
       "board.toml:31: output of X: register must be sequence + 2 + 2 * n"},
      {"valid = 101", "valid = 102",
       "board.toml:33: output of X: valid must be the register after sequence (101)"},
      {"echo = 50\n", "", "board.toml:25: output of X: echo is missing"},
      {"scale = 0.01", "scale = 0", "board.toml:35: output of X: scale must be above 0"},
      {"max_step = 0.001", "missing_ticks = 3.5",
       "board.toml:8: axis X: missing_ticks must be a whole number"},
      {"store = \"store\"", "activate = 1", "board.toml:2: board: activate must be true or false"},
      {"store = \"store\"", "public_key = \"no.pub\"", "board.toml:2: board: "},
      {"sequence = 100\n", "sequence = 65533\n",
       "board.toml:32: output of X: sequence must be a whole number from 0 to 65532"},
      {"scale = 0.01", "resolution = 1", "unknown setting resolution of kind modbus"}};
  for (const auto& [setting, wrong, said_of_it] : kWrong) {
    write(replaced(kTables, setting, wrong));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << said.text;
    EXPECT_NE(said.text.find(said_of_it), std::string::npos) << said_of_it << "\n" << said.text;
  }
}

/// One axis whose position and output are in tables, with settings of the board.
std::string board_of(const std::string& position, const std::string& output,
                     const std::string& general = "") {
  return "[board]\nstore = \"store\"\n" + general +
         "\n[[axis]]\nname = \"X\"\nmax_speed = 100\nmax_correction = 0.2\n" +
         "max_step = 0.001\nmissing_ticks = 20\n" + position + "\n[[output]]\naxis = \"X\"\n" + output + "\n";
}

TEST_F(Check, WrongSettingsOfDrivesAndCountersAreNamed) {
  const std::string sync = "sync = { kind = \"can\", interface = \"nocan\" }", sim = "kind = \"sim\"";
  const std::string drive = "kind = \"canopen\"\ninterface = \"nocan\"\nnode = 1\nscale = 0.1\n";
  const std::string output = drive + "sync_us = 1000\n",
                    plc =
                        "kind = \"modbus\"\naddress = \"127.0.0.1\"\nport = 1\n"
                        "register = 12\nsequence = 10\nscale = 0.1\n";
  const std::string counter = "kind = \"counter\"\nroot = \"ROOT\"\ndevice = \"eqep\"\nscale = 0.1\n";
  const auto with_link = [&](const std::string& receive, const std::string& transmit) {
    return board_of(sim, output, sync) +
           "[[link]]\nkind = \"isotp\"\ninterface = \"nocan\"\nreceive = " + receive +
           "\ntransmit = " + transmit + "\n";
  };
  const std::tuple<std::string, const char*> kWrong[] = {
      {board_of(sim, output), "board.toml:11: output of X: the ticks do not follow SYNC; add sync = "},
      {board_of(sim, drive, sync), "board.toml:11: output of X: sync_us is missing"},
      {board_of(sim, drive + "sync_us = 2000", sync),
       "board.toml:17: output of X: sync_us must be tick_us (1000)"},
      {board_of(sim, replaced(output, "node = 1", "node = 128"), sync),
       "board.toml:15: output of X: node must be a whole number from 1 to 127"},
      {board_of(sim, output + "object = \"60B0\"", sync),
       "board.toml:18: output of X: object: '60B0' is no object"},
      {board_of(sim, output + "object = \"0x60B0:1g\"", sync), "'0x60B0:1g' is no object"},
      {board_of(sim, output + "pdo_test = \"no\"", sync), "pdo_test: 'no' is neither sdo nor none"},
      {board_of(sim, output + "rpdo = 0x81", sync),
       "the emergency message and rpdo: two CAN frames have the same identifier; each frame must have its "
       "own"},
      {board_of(sim, output + "rpdo = 0x201", sync),
       "board.toml:18: output of X: rpdo: 0x201 belongs to RPDO 1, the controller's controlword (0x201 to "
       "0x27F)"},
      {board_of(sim, output + "rpdo = 0x482", sync), "rpdo: 0x482 belongs to TPDO 4 of the drives"},
      {board_of(sim, output + "rpdo = 0x601", sync), "rpdo: 0x601 belongs to SDO requests (0x601 to 0x67F)"},
      {board_of(sim, output + "object = \"0x607A\"", sync),
       "board.toml:18: output of X: object: '0x607A' is no position offset: give 0x60B0"},
      {board_of(sim, output + "object = \"0x6040:00\"", sync), "'0x6040:00' is no position offset"},
      {board_of(sim, output + "object = \"0x60FF\"", sync), "'0x60FF' is no position offset"},
      {board_of(sim, output + "object = \"0x6071\"", sync), "'0x6071' is no position offset"},
      {board_of(sim, output + "object = \"0x6060\"", sync), "'0x6060' is no position offset"},
      {board_of(sim, output + "object = \"0x60B1\"", sync), "'0x60B1' is no position offset"},
      {board_of(sim, output + "object = \"0x60B0:01\"", sync), "'0x60B0:01' is no position offset"},
      {board_of(sim, output + "rpdo = 0x000", sync), "rpdo must be a whole number from 1 to 2047"},
      {board_of(sim, output + "rpdo = 0x080", sync),
       "sync and rpdo: two CAN frames have the same identifier; each frame must have its own"},
      {board_of(sim, output + "rpdo = 0x701", sync),
       "the heartbeat and rpdo: two CAN frames have the same identifier; each frame must have its own"},
      {board_of(sim, output + "rpdo = 0x702", sync), "rpdo: 0x702 belongs to heartbeats"},
      {board_of(sim, output + "tpdo = 0x501", sync),
       "tpdo and rpdo: two CAN frames have the same identifier; each frame must have its own"},
      {board_of(sim, output + "tpdo = 0x082", sync),
       "board.toml:18: output of X: tpdo: 0x082 belongs to emergency messages"},
      {board_of(replaced(drive, "scale", "tpdo = 0x100\nscale"), output, sync),
       "board.toml:13: axis X: tpdo: 0x100 belongs to TIME"},
      {board_of(sim, output + "tpdo = 0x27F", sync), "tpdo: 0x27F belongs to RPDO 1"},
      {board_of(sim, output + "rpdo = 0x6C0", sync) +
           "\n[[axis]]\nname = \"Y\"\nkind = \"sim\"\nmax_speed = 100\nmax_correction = 0.2\nmax_step = "
           "0.001\n"
           "[[output]]\naxis = \"Y\"\n" +
           replaced(output, "node = 1", "node = 2\nrpdo = 0x6C0"),
       "output of Y: rpdo: this identifier is already used by the RPDO of "},
      {board_of("kind = \"can\"\ninterface = \"nocan\"\nid = 0x501", output, sync),
       "board.toml:12: axis X: id: this identifier is already used by a frame of the drive of "},
      {board_of(replaced(drive, "scale", "tpdo = 0x501\nscale"), output, sync),
       "tpdo: this identifier is already used by a frame of the drive of "},
      {board_of(drive, replaced(output, "node = 1", "node = 2"), sync),
       "output of X: node: the position of this axis is from another drive ("},
      {board_of(drive, replaced(output, "scale = 0.1", "scale = 1"), sync),
       "output of X: scale: the position of this drive has a count of another size"},
      {board_of(replaced(drive, "scale = 0.1", "scale = -0.1"), output, sync),
       "output of X: polarity must be inverted, because the scale of the position is below 0 in "},
      {board_of(drive, output + "polarity = \"inverted\"", sync),
       "output of X: polarity must be normal, because the scale of the position is above 0 in "},
      {board_of(sim, output + "rpdo = 0x302", sync),
       "rpdo: the identifier belongs to RPDO 2 of the drives, node 2"},
      {board_of(sim, output + "rpdo = 0x502", sync),
       "rpdo: the identifier belongs to RPDO 4 of the drives, node 2"},
      {board_of(sim, output + "pdo_test = \"none\"\nrpdo = 0x401", sync),
       "rpdo: with pdo_test = \"none\" the board does not read the mapping of this RPDO"},
      {board_of(sim, output + "rpdo = 0x100", sync), "rpdo: 0x100 belongs to TIME"},
      {board_of(sim, output + "sync = 0x201", sync), "sync: 0x201 belongs to RPDO 1"},
      {with_link("0x650", "0"), "link: receive: 0x650 belongs to SDO requests"},
      {with_link("0x7e0", "0"), "link: receive: 0x7E0 belongs to a restricted use"},
      {with_link("0x202", "0"), "link: transmit: 0x000 is NMT"},
      {with_link("0x202", "0x201"), "link: transmit: the identifier belongs to node 1"},
      {board_of(replaced(plc, "register", "baud = 9600\nregister"), output, sync),
       "baud is a setting of a serial line"},
      {board_of(replaced(plc, "address = \"127.0.0.1\"\nport = 1", "device = \"/dev/null\"\nport = 1"),
                output, sync),
       "port is a setting of an address"},
      {board_of(replaced(plc, "address = \"127.0.0.1\"\nport = 1", "device = \"/dev/null\"\nbaud = 12345"),
                output, sync),
       "baud: 12345 is not a baud rate of a serial line"},
      {board_of(sim,
                "kind = \"modbus-out\"\ndevice = \"/dev/null\"\nbaud = 1200\nregister = 100\necho = 50\n"
                "resolution = 1e-5\nrange = 0.1\nperiod_ms = 20\ntimeout_ms = 400\n"),
       "timeout_ms: a request and its answer need 230 ms on this line, and must end within a quarter "
       "of timeout_ms"},
      {with_link("0x700", "0x501"),
       "link: transmit: this identifier is already used by a frame of the drive of "},
      {board_of(sim, output + "span = 1", sync),
       "board.toml:18: output of X: unknown setting span of kind canopen"},
      {board_of(sim, replaced(output, "scale = 0.1", "scale = -1"), sync), "scale must be above 0"},
      {board_of(drive + "heartbeat_ms = 3", output, sync), "unknown setting heartbeat_ms of kind canopen"},
      {board_of(replaced(drive, "scale = 0.1", "scale = 0"), output, sync), "scale must not be zero"},
      {board_of(replaced(plc, "sequence = 10", "sequence = 13"), output, sync),
       "sequence is a register of the position"},
      {board_of(replaced(plc, "sequence = 10", "sequence = 300"), output, sync),
       "sequence is too far from the positions"},
      {board_of(plc + "period_ms = 20", output, sync), "missing_ticks must be at least 2 periods"},
      {board_of(plc + "registers = \"coil\"", output, sync), "registers must be input or holding"},
      {board_of(counter + "bits = 1", output, sync), "bits must be 2 to 40"},
      {board_of(counter + "count = -1", output, sync), "count must be a whole number from 0 to 63"}};
  for (const auto& [board, said_of_it] : kWrong) {
    write(board);
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << said.text;
    EXPECT_NE(said.text.find(said_of_it), std::string::npos) << said_of_it << "\n" << said.text;
  }
}

/// Settings of every kind of device, each on its own line. The board file is valid; no device is there.
constexpr const char* kEverySetting = R"([board]
name = "mill"
class = "mills"
store = "store"
tick_us = 1000
slot_bytes = 100000
trial_s = 60.5
activate = true
max_lost_ticks = 0.05
priority = 70
watchdog = "ROOT/watchdog"
sync = { kind = "can", interface = "ROOT/bus", id = 0x80, timeout_ms = 20 }
[[axis]]
name = "X"
kind = "canopen"
interface = "ROOT/bus"
node = 1
tpdo = 0x381
scale = 0.1
offset = 0.5
low = 0.5
high = 800.5
max_speed = 500.5
max_acceleration = 5000.5
max_step = 0.001
max_correction = 0.2
correction_share = 0.1
missing_ticks = 3
rotary = false
rollover = false
[[output]]
axis = "X"
kind = "canopen"
interface = "ROOT/bus"
node = 1
tpdo = 0x381
rpdo = 0x501
sync = 0x80
object = "0x60B0"
scale = 0.1
sync_us = 1000
range = 0.1
polarity = "normal"
timeout_ms = 20
heartbeat_ms = 200
pdo_test = "sdo"
delay_ms = 1.5
[[axis]]
name = "Y"
kind = "counter"
root = "ROOT"
device = "eqep"
count = 0
bits = 32
scale = 0.1
offset = 0.5
max_speed = 100
max_correction = 0.2
max_step = 0.001
[[output]]
axis = "Y"
kind = "modbus"
address = "127.0.0.1"
port = 1
unit = 1
sequence = 100
valid = 101
register = 102
echo = 50
scale = 0.01
range = 0.1
period_ms = 5
timeout_ms = 100
[[axis]]
name = "Z"
kind = "modbus"
address = "127.0.0.1"
port = 1
unit = 2
register = 12
sequence = 10
registers = "holding"
scale = 0.1
offset = 0.5
period_ms = 5
timeout_ms = 100
missing_ticks = 20
max_speed = 100
max_correction = 0.2
max_step = 0.001
[[output]]
axis = "Z"
kind = "pwm"
path = "ROOT/pwm9"
period_ns = 50000
span = 0.25
zero_ns = 25000
low_ns = 0
high_ns = 50000
[[axis]]
name = "B"
kind = "can"
interface = "nocan"
id = 0x181
rotary = true
max_speed = 100
max_correction = 0.2
max_step = 0.001
[[output]]
axis = "B"
kind = "modbus-out"
device = "ROOT/tty"
baud = 115200
parity = "E"
unit = 1
register = 100
echo = 50
place = 0
resolution = 1e-5
range = 0.1
period_ms = 20
timeout_ms = 400
[[axis]]
name = "C"
kind = "sim"
max_speed = 100
max_correction = 0.2
max_step = 0.001
[[output]]
axis = "C"
kind = "iio-dac"
root = "ROOT"
device = "mcp"
channel = 1
codes = 255
span = 0.25
zero = 127
low = 0
high = 254
[input.T]
unit = "degC"
low = -10.5
high = 60.5
max_step = 1.5
reference = 20.5
[input.T.source]
kind = "iio"
root = "ROOT"
device = "tmp117"
attribute = "in_temp_input"
scale = 0.001
offset = 0.5
stale_ticks = 1000
[input.A]
unit = "m/s^2"
[input.A.source]
kind = "iio-buffer"
root = "ROOT"
devices = "ROOT/dev"
device = "adxl"
channel = "accel_x"
scale = 0.001
offset = 0.5
trigger = "t"
rate_Hz = 1000
[input.V]
unit = "m/s^2"
[input.V.source]
kind = "feature"
of = "A"
feature = "RMS"
window = 1500
every = 1
resolution = 0.001
missing_samples = 3
[input.S]
unit = "degC"
[input.S.source]
kind = "sim"
amplitude = 0.5
frequency_Hz = 0.5
[input.M]
unit = "degC"
[input.M.source]
kind = "modbus-tcp"
address = "127.0.0.1"
port = 1
unit = 3
register = 1
registers = "input"
type = "int16"
scale = 0.5
offset = 0.5
timeout_ms = 200
stale_ticks = 1000
[probe]
delay_us = 0.5
delay_spread_us = 0.5
position_age_us = 0.5
position_age_spread_us = 0.5
settle_us = 1000.5
[probe.line]
kind = "gpio"
chip = "none"
line = 3
polarity = "normal"
[digital.healthy]
kind = "gpio"
chip = "none"
line = 4
toggle_ms = 10
[[link]]
kind = "modbus-tcp"
address = "127.0.0.1"
port = 0
access = "read"
plain_commands = "refused"
[[link]]
kind = "modbus-rtu"
device = "ROOT/tty2"
baud = 115200
parity = "E"
unit = 1
[[link]]
kind = "isotp"
interface = "nocan"
receive = 0x700
transmit = 0x702
)";

/// A value of another type than `value` has; a fraction for a whole number.
std::vector<std::string> of_another_type(const std::string& value) {
  if (value[0] == '"') return {"true", "7", "1.5"};
  if (value == "true" || value == "false") return {"1", "0", "\"" + value + "\""};
  std::vector<std::string> others = {"true", "\"" + value + "\"", "nan", "inf", "-inf", "1979-05-27"};
  // The settings with a fraction in the file above take every number.
  if (value.find_first_of(".e") == std::string::npos)
    for (const char* const whole : {"3.5", "9007199254740993"}) others.emplace_back(whole);
  return others;
}

#ifdef __SANITIZE_ADDRESS__
constexpr int kStride = 8;  // a start of the daemon takes ten times as long: each eighth
#else
constexpr int kStride = 1;
#endif

// `activate = 1` and `missing_ticks = 3.5`: whatever the setting, its value has one type.
TEST_F(Check, EverySettingRefusesAValueOfAnotherTypeWithItsLine) {
  write(kEverySetting);
  ASSERT_EQ(run("--check").status, 2) << run("--check").text;
  std::vector<std::string> lines;
  std::istringstream file(kEverySetting);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  int seen = 0, tried = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string line = lines[i];
    const auto equals = line.find(" = ");
    const std::string name = line.substr(0, equals), number = std::to_string(i + 1);
    if (equals == std::string::npos || name == "sync") continue;
    // These take fractions, although the value above is none.
    const bool any_number = std::set<std::string>{"max_speed", "delay_ms"}.contains(name);
    for (const std::string& value : of_another_type(line.substr(equals + 3) + (any_number ? ".0" : ""))) {
      if (seen++ % kStride != 0) continue;
      lines[i] = name + " = " + value;
      std::string text;
      for (const std::string& one : lines) text += one + "\n";
      write(text);
      const Said said = run("--check");
      EXPECT_EQ(said.status, 1) << number << ": " << lines[i] << "\n" << said.text;
      EXPECT_NE(said.text.find("board.toml:" + number + ": "), std::string::npos) << lines[i] << said.text;
      EXPECT_NE(said.text.find(name), std::string::npos) << lines[i] << said.text;
      ++tried;
    }
    lines[i] = line;
  }
  EXPECT_GT(tried, 800 / kStride);
}

/// A port of this computer at which nobody accepts a connection; the system completes it all the same.
class QuietPort {
 public:
  QuietPort() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof place;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&place), size), 0);
    EXPECT_EQ(::listen(socket_, 8), 0);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&place), &size);
    port_ = ntohs(place.sin_port);
  }
  ~QuietPort() { ::close(socket_); }
  QuietPort(const QuietPort&) = delete;
  QuietPort& operator=(const QuietPort&) = delete;
  int port() const { return port_; }
  /// Connections since the last call.
  int connections() const {
    int count = 0;
    for (int one = 0; (one = ::accept(socket_, nullptr, nullptr)) >= 0; ++count) ::close(one);
    return count;
  }

 private:
  int socket_, port_ = 0;
};

// A block in the controller's registers was overwritten before the error was found.
TEST_F(Check, AnErrorAnywhereInTheFileIsFoundBeforeAControllerIsReached) {
  const QuietPort controller;
  const std::string board =
      board_of("kind = \"sim\"",
               "kind = \"modbus-out\"\naddress = \"127.0.0.1\"\nport = " + std::to_string(controller.port()) +
                   "\nregister = 100\necho = 50\nresolution = 1e-6\nrange = 0.2\ntimeout_ms = 20\n");
  const char* const kWrong[] = {
      "[[link]]\nkind = \"bogus\"\n",
      "[[link]]\nkind = \"modbus-tcp\"\nfoo = 1\n",
      "[[link]]\nkind = \"modbus-tcp\"\naddress = \"x\"\n",
      "[digital]\nenable = { kind = \"bogus\" }\n",
      "[probe]\nline = { kind = \"bogus\" }\n",
      "[input.T]\nsource = { kind = \"bogus\" }\n",
      "[input.T]\nsource = { kind = \"feature\", of = \"T\", feature = \"RMS\" }\n",
      "[input.T]\nsource = { kind = \"iio-buffer\", device = \"a\", channel = \"b/c\", scale = 1 }\n"};
  for (const std::string wrong : kWrong)
    for (const char* const mode : {"--check", "--zero", "--seconds 0.1"}) {
      write(board + wrong);
      const Said said = run(mode);
      EXPECT_EQ(said.status, 1) << wrong << mode << said.text;
      EXPECT_EQ(controller.connections(), 0) << wrong << mode << said.text;
      EXPECT_FALSE(std::filesystem::exists(files_.path() + "/store")) << wrong << mode;
    }
  write(replaced(board, "name = \"X\"", "name = \"X\"\nrotary = false"));
  EXPECT_EQ(run("--check").status, 2);
  EXPECT_GT(controller.connections(), 0) << "the port is that of the output";
}

TEST_F(Check, DrivesCountersAndRegistersThatAreMissingAreNamed) {
  const std::string sync = "sync = { kind = \"can\", interface = \"ROOT/bus\" }";
  const std::string drive = "kind = \"canopen\"\ninterface = \"ROOT/bus\"\nnode = 1\nscale = 0.1\n";
  write(board_of(drive, drive + "sync_us = 1000", sync));
  Said said = run("--check");
  EXPECT_EQ(said.status, 2) << said.text;
  EXPECT_NE(said.text.find("missing  axis.X.output  canopen: "), std::string::npos) << said.text;
  EXPECT_NE(said.text.find("bus: no program answers: No such file"), std::string::npos) << said.text;
  // A counter is found by the name of its driver, and read.
  const std::string pwm = "kind = \"pwm\"\npath = \"ROOT/pwm0\"\nperiod_ns = 50000\nspan = 0.25";
  const std::string counter = "kind = \"counter\"\nroot = \"ROOT\"\ndevice = \"eqep\"\nscale = 0.1\n";
  write(board_of(counter, pwm));
  said = run("--check");
  EXPECT_EQ(said.status, 2) << said.text;
  EXPECT_NE(said.text.find("missing  axis.X.position  counter: "), std::string::npos) << said.text;
  files_.put("counter2/name", "eqep"), files_.put("counter2/count0/count", "7"),
      files_.put("counter2/count0/ceiling", "4294967295");
  said = run("--check");
  EXPECT_EQ(said.status, 0) << said.text;
  EXPECT_NE(said.text.find("ok       axis.X.position  counter\n"), std::string::npos) << said.text;
  write(board_of(
      "kind = \"modbus\"\naddress = \"127.0.0.1\"\nport = 1\nregister = 12\nsequence = 10\nscale = 0.1",
      pwm));
  said = run("--check");
  EXPECT_EQ(said.status, 2) << said.text;
  EXPECT_NE(said.text.find("missing  axis.X.position  modbus: the controller does not answer, or its "
                           "sequence number does not change"),
            std::string::npos)
      << said.text;
}

/// Two axes with blocks of registers at one controller, and an input.
std::string board_with_registers(const std::string& x, const std::string& y, const std::string& more = "") {
  const auto axis = [](const char* name, const std::string& settings) {
    return std::string("[axis.") + name +
           "]\nmax_speed = 100\nmax_correction = 0.2\nmax_step = 0.001\nposition = { kind = \"sim\" }\n"
           "output = { kind = \"modbus-out\", resolution = 1e-6, range = 0.2, " +
           settings + " }\n";
  };
  return "[board]\nstore = \"store\"\n" + axis("X", x) + axis("Y", y) + more;
}

// A controller then read the word of one axis as the value of another, with its valid bit.
TEST_F(Check, RegistersOfAControllerHaveOneUse) {
  const std::string plc = "address = \"127.0.0.1\", port = 502, ", same = "address = \"127.0.0.2\", ";
  const std::string first = plc + "register = 100, echo = 50";  // registers 100 to 103
  const std::string input =
      "[input.T]\nunit = \"degC\"\nsource = { kind = \"modbus-tcp\", address = \"127.0.0.1\", "
      "registers = \"holding\", scale = 1, ";
  const std::tuple<std::string, std::string, const char*> kWrong[] = {
      {same + "register = 101, echo = 51", "", "board.toml:14: axis.Y.output: block: registers 101 to 104"},
      {same + "register = 101, echo = 51", "", "overlaps the block (registers 100 to 103) of "},
      {same + "register = 101, echo = 51", "", "board.toml:8: axis.X.output"},
      {plc + "register = 97, echo = 51", "", "overlaps the block"},
      {plc + "register = 96, place = 1, echo = 51", "", "overlaps the block"},
      {plc + "register = 200, echo = 50", "", "echo: register 50 at 127.0.0.1:502 unit 1 overlaps the echo"},
      {plc + "register = 200, echo = 102", "", "overlaps the block"},
      {plc + "register = 48, echo = 60", "", "overlaps the block (registers 48 to 51)"},
      {plc + "register = 100, place = 1, echo = 51", "",
       "echo: all axes of one register block need the same value"},
      {plc + "register = 100, place = 1, echo = 50, timeout_ms = 200", "",
       "timeout_ms: all axes of one register block need the same value"},
      {plc + "register = 200, echo = 60", input + "register = 103 }\n", "reading: register 103"},
      {plc + "register = 200, echo = 60", input + "register = 99, type = \"int32\" }\n",
       "reading: registers 99 to 100"},
      {plc + "register = 200, echo = 60", input + "register = 50 }\n", "overlaps the echo"},
      {"address = \"localhost\", register = 101, echo = 51", "", "address: 'localhost' is not a numeric"},
      {"address = \"127.1\", register = 101, echo = 51", "", "address: '127.1' is not a numeric"},
      {"address = \"\", register = 101, echo = 51", "", "address: '' is not a numeric"},
      {"address = \"0.0.0.0\", register = 101, echo = 51", "", "'0.0.0.0' is not the address of one"},
      {"address = \"255.255.255.255\", register = 101, echo = 51", "", "is not the address of one"},
      {plc + "register = 200, echo = 60",
       "[input.T]\nunit = \"degC\"\nsource = { kind = \"modbus-tcp\", address = \"plc!\", register = 1, "
       "scale = 1 }\n",
       "input.T.source: address: 'plc!' is not a numeric"}};
  for (const auto& [second, more, said_of_it] : kWrong) {
    write(board_with_registers(first, second, more));
    for (const char* const how : {"--check", "--seconds 0.1"}) {
      const Said said = run(how);
      EXPECT_EQ(said.status, 1) << how << " " << second << more << said.text;
      EXPECT_NE(said.text.find("board.toml:"), std::string::npos) << said.text;
      EXPECT_NE(said.text.find(said_of_it), std::string::npos) << second << more << said.text;
    }
  }
  // Beside each other, at another unit, and as other places of one block, they pass: only the controller is
  // missing.
  for (const std::string& second :
       {plc + "register = 104, echo = 51", plc + "unit = 2, register = 101, echo = 51",
        same + "register = 100, place = 1, echo = 50", plc + "register = 100, place = 5"}) {
    std::string x = first, y = second;
    for (std::string* const one : {&x, &y})
      if (const auto at = one->find("port = 502, "); at != std::string::npos) one->erase(at, 12);
    write(board_with_registers("port = 1, " + x, "port = 1, " + y, input + "port = 1, register = 300 }\n"));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 2) << second << said.text;
  }
}

// Whatever the names of its directory.
TEST_F(Check, OneCounterHasOneAxis) {
  for (const int counter : {0, 1}) {
    const std::string at = "counter" + std::to_string(counter);
    files_.put(at + "/name", "ctr" + std::to_string(counter)), files_.put(at + "/count0/count", "7"),
        files_.put(at + "/count1/count", "7"), files_.put(at + "/count0/ceiling", "4294967295"),
        files_.put(at + "/count1/ceiling", "4294967295");
  }
  std::filesystem::create_directory(files_.path() + "/links");
  std::filesystem::create_directory_symlink(files_.path() + "/counter0", files_.path() + "/links/x");
  const auto board = [](const std::string& second) {
    const auto axis = [](const char* name, const std::string& source) {
      return std::string("[axis.") + name + "]\nlow = 0\nhigh = 100\nposition = { kind = \"counter\", " +
             source + ", scale = 0.1 }\noutput = { kind = \"sim\" }\n";
    };
    return "[board]\nname = \"m\"\n" + axis("X", "device = \"ROOT/counter0/\"") + axis("Y", second);
  };
  for (const char* const wrong :
       {"device = \"ROOT/counter0/\"", "device = \"ROOT/links/x/\"", "root = \"ROOT\", device = \"ctr0\"",
        "device = \"ROOT/counter1/../counter0/\""}) {
    write(board(wrong));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << wrong << said.text;
    EXPECT_NE(said.text.find("another axis has the counter"), std::string::npos) << wrong << said.text;
  }
  for (const char* const right : {"device = \"ROOT/counter1/\"", "device = \"ROOT/counter0/\", count = 1"}) {
    write(board(right));
    const Said said = run("--check");
    EXPECT_EQ(said.text.find("another axis"), std::string::npos) << right << said.text;
    EXPECT_NE(said.text.find("ok       axis.Y.position  counter"), std::string::npos) << right << said.text;
  }
}

// Two clients on a serial line disturb each other, under whatever names.
TEST_F(Check, SerialLineOfABlockHasOneUse) {
  files_.put("tty", "");
  std::filesystem::create_symlink(files_.path() + "/tty", files_.path() + "/by-id");
  const std::string x = "device = \"ROOT/tty\", register = 100, echo = 50";
  const std::string y = "address = \"127.0.0.1\", port = 1, register = 100, echo = 50";
  const std::pair<std::string, std::string> kWrong[] = {
      {"device = \"ROOT/by-id\", unit = 2, register = 300, echo = 51", ""},
      {y,
       "[input.T]\nunit = \"degC\"\nsource = { kind = \"modbus-rtu\", device = \"ROOT/by-id\", register = 1, "
       "scale = 1 }\n"},
      {y, "[[link]]\nkind = \"modbus-rtu\"\ndevice = \"ROOT/by-id\"\n"}};
  for (const auto& [second, more] : kWrong) {
    write(board_with_registers(x, second, more));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << second << more << said.text;
    EXPECT_NE(said.text.find("/tty has another use in "), std::string::npos) << said.text;
  }
}

// What a real output may do is not for an image to say.
TEST_F(Check, RealOutputsNeedLimitsOfTheBoardsOwn) {
  const std::pair<const char*, const char*> kLimits[] = {
      {"max_correction = 0.2\n",
       "board.toml:3: axis.X: max_correction is missing: an output of kind pwm needs it"},
      {"max_speed = 100\n", "board.toml:3: axis.X: max_speed is missing: an output of kind pwm needs it"},
      {"max_step = 0.001\n",
       "board.toml:3: axis.X: max_step or max_acceleration is missing: an output of kind pwm needs one of "
       "them; add max_step = 0.001  # mm"}};
  for (const auto& [setting, said_of_it] : kLimits) {
    write(replaced(kBoard, setting, ""));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << said.text;
    EXPECT_NE(said.text.find(said_of_it), std::string::npos) << said.text;
  }
}

// With max_speed = 500 alone a tenth of it, 50 um, was allowed in each tick.
TEST_F(Check, SaysTheMostThatACorrectionChangesInATick) {
  const std::pair<const char*, const char*> kSteps[] = {
      {"max_step = 0.001\n", "; at most 1 um a tick"},
      {"max_step = 0.5\n", "; at most 10 um a tick"},  // a tenth of 100 mm/s
      {"max_acceleration = 5000\n", "; at most 10 um a tick, 0.5 more in each"},
      {"max_acceleration = 5000\n",
       "default  axis.X: not set; a default is max_step = 0.001  # mm in one tick\n"},
      // Ten times 0.4 mm over 800 mm, at 0.1 mm in a tick.
      {"max_acceleration = 5000\nhigh = 800\n",
       "axis.X: not set; a default is max_step = 0.0005  # mm in one tick\n"}};
  for (const auto& [setting, said_of_it] : kSteps) {
    write(replaced(kBoard, "max_step = 0.001\n", setting));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 0) << said.text;
    EXPECT_NE(said.text.find(said_of_it), std::string::npos) << said.text;
  }
}

// The tables of drivers in the daemon and the table of the page are the same.
TEST_F(Check, EachDriverIsOnThePageOfTheBoard) {
  std::ifstream file(VERNIER_SOURCE_DIR "/tools/docs/board.md");
  const std::string page((std::istreambuf_iterator<char>(file)), {});
  const std::string link = std::string(kBoard) + "[[link]]\nkind = \"nothing\"\n";
  const std::pair<std::string, std::string> kBoards[] = {
      {"output", replaced(kBoard, "\"pwm\"", "\"nothing\"")},
      {"position", replaced(kBoard, "\"sim\"", "\"nothing\"")},
      {"input", replaced(kBoard, "\"iio\"", "\"nothing\"")},
      {"link", link}};
  for (const auto& [port, board] : kBoards) {
    write(board);
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << said.text;
    const std::string mark = "no " + port + " of kind nothing; drivers: ";
    const auto at = said.text.find(mark);
    ASSERT_NE(at, std::string::npos) << said.text;
    std::istringstream names(said.text.substr(at + mark.size(), said.text.find('\n', at) - at - mark.size()));
    int count = 0;
    for (std::string name; std::getline(names >> std::ws, name, ','); ++count)
      EXPECT_NE(page.find("| `" + name + "` (" + port + ")"), std::string::npos) << name << " " << port;
    EXPECT_GE(count, 2) << said.text;
  }
}

TEST_F(Check, OneDeviceHasOneUse) {
  const std::string y =
      "output = { kind = \"iio-dac\", root = \"ROOT\", device = \"mcp4922\", channel = 1, codes = 255, ";
  write(replaced(kBoard, "output = { kind = \"pwm\", path = \"ROOT/pwm0\", period_ns = 50000, ", y));
  Said said = run("--check");
  EXPECT_EQ(said.status, 1) << said.text;
  EXPECT_NE(said.text.find("axis.Y.output: this device is already used by "), std::string::npos) << said.text;
  // Under another name it is found when it is opened.
  write(replaced(replaced(kBoard, "output = { kind = \"pwm\", path = \"ROOT/pwm0\", period_ns = 50000, ", y),
                 "\"mcp4922\", channel = 1, codes = 255, span",
                 "\"ROOT/iio:device3\", channel = 1, codes = 255, span"));
  said = run("--check");
  EXPECT_EQ(said.status, 2) << said.text;
  EXPECT_NE(said.text.find("in use by another axis or another process"), std::string::npos) << said.text;
}

TEST_F(Check, ZeroTakesOutWhatWasLeftAndNamesWhatItCannotReach) {
  files_.put("pwm0/duty_cycle", "31000");
  Said said = run("--zero");
  EXPECT_EQ(said.status, 0) << said.text;
  EXPECT_EQ(files_.get("pwm0/duty_cycle"), "25000");
  EXPECT_EQ(files_.get("iio:device3/out_voltage1_raw"), "127");
  // A device that is gone does not keep the others from their zero.
  files_.put("pwm0/duty_cycle", "31000");
  std::filesystem::remove(files_.path() + "/iio:device3/out_voltage1_raw");
  said = run("--zero");
  EXPECT_EQ(said.status, 2) << said.text;
  EXPECT_NE(said.text.find("not at zero: axis.Y.output"), std::string::npos) << said.text;
  EXPECT_EQ(files_.get("pwm0/duty_cycle"), "25000");
}

TEST_F(Check, WrongSettingsAreNamedWithTheirLine) {
  constexpr const char *kNamedLink = "[[link]]\nkind = \"modbus-tcp\"\naddress = \"mill one\"\n[axis.X]",
                       *kEmptyLink = "[[link]]\nkind = \"modbus-tcp\"\naddress = \"\"\n[axis.X]";
  const std::pair<const char*, const char*> kWrong[] = {{"period_ns = 50000", "period_ns = 0"},
                                                        {"span = 0.25", "span = -1"},
                                                        {"channel = 1", "chanel = 1"},
                                                        {"codes = 255", "codes = 25.5"},
                                                        {"zero = 127", "zero = 255"},
                                                        {"scale = 0.001", "scale = \"a\""},
                                                        {"device = \"tmp117\", ", ""},
                                                        {"kind = \"pwm\"", "kind = \"pvm\""},
                                                        {"high = 254", "polarity = \"upside\""},
                                                        {"attribute = \"in_temp_input\"", "attribute = \"\""},
                                                        {"{ kind = \"sim\" }", "{ kind = \"can\" }"},
                                                        {"span = 0.25", "delay_ms = -5, span = 0.25"},
                                                        {"span = 0.25", "delay_ms = \"a\", span = 0.25"},
                                                        {"[axis.X]", kNamedLink},
                                                        {"[axis.X]", kEmptyLink}};
  for (const auto& [from, to] : kWrong) {
    write(replaced(kBoard, from, to));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << to << said.text;
    EXPECT_NE(said.text.find("board.toml:"), std::string::npos) << to << said.text;
  }
}

// A limit was rounded to a whole number of counts, and up to the first one.
TEST_F(Check, LimitThatIsBelowOneCountIsRefused) {
  const std::pair<const char*, const char*> kSmall[] = {
      {"max_acceleration = 5",
       "max_acceleration is too small: the smallest limit of a correction is 1 count"},
      {"max_acceleration = 9.9", "max_acceleration must be at least 10"},
      {"max_step = 0.9e-6", "max_step must be at least 1e-06"},
      {"max_speed = 0.005", "max_speed must be at least 0.01"}};
  const auto board = [](const std::string& limit) {
    return "[board]\nname = \"m\"\n[axis.X]\nlow = 0\nhigh = 9\n" + limit +
           "\nposition = { kind = \"sim\" }\noutput = { kind = \"sim\" }\n";
  };
  for (const auto& [limit, said_of_it] : kSmall) {
    write(board(limit));
    const Said said = run("--check");
    EXPECT_EQ(said.status, 1) << limit << said.text;
    EXPECT_NE(said.text.find(said_of_it), std::string::npos) << limit << said.text;
  }
  for (const char* const enough : {"max_acceleration = 10", "max_step = 1e-6", "max_speed = 0.01"}) {
    write(board(enough));
    EXPECT_EQ(run("--check").status, 0) << enough;
  }
}

TEST_F(Check, RelativePathOfADeviceBeginsInTheFolderOfTheBoardFile) {
  files_.put("counter0/name", "eqep"), files_.put("counter0/count0/count", "7"),
      files_.put("counter0/count0/ceiling", "4294967295");
  write(
      "[board]\nname = \"m\"\n[axis.X]\nlow = 0\nhigh = 100\noutput = { kind = \"sim\" }\n"
      "position = { kind = \"counter\", device = \"counter0/\", scale = 0.1 }\n");
  const Said said = run("--check");
  EXPECT_EQ(said.status, 0) << said.text;
}

TEST_F(Check, CalibrationIsStoredAndUsed) {
  const std::string uncalibrated = "codes = 255, calibration = \"y.toml\", high = 254 }";
  write(replaced(kBoard, "codes = 255, span = 0.25, zero = 127, high = 254 }", uncalibrated));
  Said said = run("--check");
  EXPECT_EQ(said.status, 1) << said.text;
  EXPECT_NE(said.text.find("y.toml does not exist; make it with vernierd --calibrate"), std::string::npos)
      << said.text;
  // GIVEN what a gauge says at three codes: 0.5 um a code, nothing at code 100, falling
  const std::string answers = "printf '50\\n-13.5\\n-77\\n-13.5\\n50\\n' | ";
  said = run("--calibrate Y --steps 3 --json -", answers);
  EXPECT_EQ(said.status, 0) << said.text;
  EXPECT_NE(said.text.find("\"span\": 0.1275, "), std::string::npos) << said.text;
  EXPECT_NE(said.text.find("\"polarity\": \"inverted\""), std::string::npos) << said.text;
  EXPECT_EQ(files_.get("iio:device3/out_voltage1_raw"), "127") << "at the nominal zero";
  // THEN the daemon takes the converter to the zero that was found
  EXPECT_EQ(run("--check").status, 0);
  EXPECT_EQ(run("--seconds 0.2").status, 0);
  EXPECT_EQ(files_.get("iio:device3/out_voltage1_raw"), "100");
  // A calibration that is ended, or has no line, leaves the file as it is.
  const std::string before = files_.get("y.toml");
  EXPECT_EQ(run("--calibrate Y --steps 3", "printf '1\\nq\\n' | ").status, 2);
  files_.put("points.csv", "code,measured[um]\n0,1\n254,x");
  said = run("--calibrate Y --measured " + files_.path() + "/points.csv");
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.text.find("points.csv:3: no measured value"), std::string::npos) << said.text;
  EXPECT_EQ(files_.get("y.toml"), before);
}

TEST_F(Check, WhatAConverterHoldsFromBeforeIsTakenOut) {
  files_.put("pwm0/duty_cycle", "30000");
  const Said said = run("--seconds 0.2");
  EXPECT_EQ(said.status, 0) << said.text;
  EXPECT_EQ(files_.get("iio:device3/out_voltage1_raw"), "127");
  EXPECT_EQ(files_.get("pwm0/duty_cycle"), "25000");
}

}  // namespace
}  // namespace vernier::check_test
