// SPDX-License-Identifier: GPL-3.0-or-later
// Positions from counters of the kernel (a directory laid out as sysfs is) and from registers of a controller
// (libmodbus's server).
#include <gtest/gtest.h>
#include <modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "hal/linux/counter_axis.h"
#include "hal/linux/modbus/modbus_axes.h"
#include "hal/sim/sim_clock.h"
#include "tests/conformance/linux_devices.h"

namespace vernier::positions_test {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kNothing = INT64_MIN;

std::int64_t tick(AxisReader& axes, std::uint32_t axis = 0) {
  axes.begin_tick();
  AxisReading reading;
  return axes.read_axis(axis, reading) == HalFault::kNone ? reading.position.count : kNothing;
}

TEST(WrappedCount, GoesOnOverBothEndsAndBeginsAtTheNearestZero) {
  for (const std::int64_t range :
       {std::int64_t{2}, std::int64_t{7}, std::int64_t{65536}, std::int64_t{1} << 40}) {
    WrappedCount count(range);
    std::int64_t wanted = 0;
    const std::int64_t step = (range - 1) / 2;
    for (int i = 0; i < 100; ++i) {
      wanted += i < 60 ? step : -step;
      ASSERT_TRUE(count.take(((wanted % range) + range) % range));
      ASSERT_EQ(count.position(), wanted) << range;
    }
    EXPECT_FALSE(count.take(-1));
    EXPECT_FALSE(count.take(range));
    EXPECT_EQ(count.position(), wanted) << "a count beyond the range changes nothing";
  }
  WrappedCount first(65536);
  EXPECT_TRUE(first.take(65535));
  EXPECT_EQ(first.position(), -1);
}

class Counter : public testing::Test {
 protected:
  Counter() {
    files_.put("counter0/count0/count", "0"), files_.put("counter0/count0/ceiling", "65535"),
        files_.put("counter0/count0/enable", "1");
  }
  std::unique_ptr<CounterAxis> open(int bits = 0) {
    return open_at("counter0/count0", bits, {100, 1, 5'000, false});
  }
  // 16 bits of 100 nm, at most 10 um a tick: half the range in 327.68 ms.
  std::unique_ptr<CounterAxis> open_at(const std::string& place, int bits, const PositionScale& scale) {
    const CounterAxis::Speed speed{10'000, TimeUs(1000), 3};
    return CounterAxis::open(files_.path() + "/" + place, bits, scale, speed, clock_, error_);
  }
  void count(const std::string& text) { files_.put("counter0/count0/count", text); }
  std::string error_;
  SimClock clock_;
  const SysfsDirectory files_{testing::TempDir() + "counter_" + std::to_string(getpid()) + "_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name()};
};

TEST_F(Counter, PositionFollowsTheCountOverItsEnds) {
  const auto axis = open();
  ASSERT_NE(axis, nullptr) << error_;
  EXPECT_EQ(tick(*axis), 5'000);
  count("70");
  EXPECT_EQ(tick(*axis), 12'000);
  count("65530");
  EXPECT_EQ(tick(*axis), 4'400) << "through zero";
  std::int64_t wanted = -6;
  for (int i = 0; i < 20; ++i) {
    wanted += 30'000;
    count(std::to_string(((wanted % 65536) + 65536) % 65536));
    ASSERT_EQ(tick(*axis), 5'000 + 100 * wanted) << "two ends in four steps";
  }
  AxisReading reading;
  EXPECT_EQ(axis->read_axis(1, reading), HalFault::kNoDevice);
  EXPECT_FALSE(axis->gives_motion());
}

TEST_F(Counter, CountThatIsNotReadableOrBeyondItsRangeIsNoReading) {
  const auto axis = open();
  ASSERT_NE(axis, nullptr) << error_;
  for (const char* const wrong : {"", "x", "65536", "-1", "1.5", "99999999999999999999"}) {
    count(wrong);
    EXPECT_EQ(tick(*axis), kNothing) << wrong;
  }
  count("3");
  EXPECT_EQ(tick(*axis), 5'300) << "no count of before is left";
}

TEST_F(Counter, WidthIsASettingWhereTheDriverDoesNotStateTheRange) {
  std::filesystem::remove(files_.path() + "/counter0/count0/ceiling");
  EXPECT_EQ(open(), nullptr);
  EXPECT_NE(error_.find("ceiling does not exist; give the width of the counter: bits = 32"),
            std::string::npos)
      << error_;
  files_.put("counter0/count0/ceiling", "0");
  EXPECT_EQ(open(), nullptr);
  const auto axis = open(24);
  ASSERT_NE(axis, nullptr);
  count("16777215");
  EXPECT_EQ(tick(*axis), 4'900);
}

TEST_F(Counter, CounterThatIsOffOrMissingIsNamed) {
  files_.put("counter0/count0/enable", "0");
  EXPECT_EQ(open(), nullptr);
  EXPECT_NE(error_.find("the counter does not count: write 1 to"), std::string::npos) << error_;
  EXPECT_EQ(open_at("counter1/count0", 0, {}), nullptr);
  EXPECT_NE(error_.find("counter1/count0/count: No such file"), std::string::npos) << error_;
}

// The counts say the shortest way; the axis may have gone the other one.
TEST_F(Counter, LongTimeWithoutAReadingIsALostReference) {
  const auto axis = open();
  ASSERT_NE(axis, nullptr) << error_;
  const auto referenced = [&] {
    AxisReading reading;
    axis->begin_tick();
    EXPECT_EQ(axis->read_axis(0, reading), HalFault::kNone);
    return reading.referenced;
  };
  clock_.spend(InstantNs(10'000'000'000));
  EXPECT_TRUE(referenced()) << "the first reading";
  clock_.spend(InstantNs(327'000'000));
  count("");
  EXPECT_EQ(tick(*axis), kNothing);
  count("32000");
  EXPECT_TRUE(referenced()) << "less than half the range at the largest speed";
  clock_.spend(InstantNs(327'679'999));
  EXPECT_TRUE(referenced());
  clock_.spend(InstantNs(327'680'000));
  EXPECT_FALSE(referenced());
  EXPECT_FALSE(referenced()) << "until the board starts again";
}

TEST_F(Counter, CounterThatTheAxisPassesTooFastIsRefused) {
  EXPECT_EQ(open(8), nullptr);
  EXPECT_NE(error_.find("half the range of the counter in 1.28 ms, and a reading may be 4 ms old"),
            std::string::npos)
      << error_;
  EXPECT_NE(open(10), nullptr) << error_;
}

/// A controller whose registers libmodbus's own server serves: sequence in 10, positions in 12 and 14.
class Controller {
 public:
  Controller() : registers_(modbus_mapping_new(0, 0, 100, 0)), context_(modbus_new_tcp("127.0.0.1", 0)) {
    listening_ = modbus_tcp_listen(context_, 1);
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~Controller() {
    stop_ = true;
    thread_.join();
    modbus_close(context_);
    modbus_free(context_);
    modbus_mapping_free(registers_);
    ::close(listening_);
  }
  void put(std::uint16_t sequence, std::int32_t x, std::int32_t y) {
    const std::scoped_lock lock(guard_);
    registers_->tab_registers[10] = sequence;
    put32(12, x), put32(14, y);
  }
  int port() const { return port_; }
  std::atomic<bool> silent{false};

 private:
  void put32(int at, std::int32_t value) {
    registers_->tab_registers[at] = static_cast<std::uint16_t>(static_cast<std::uint32_t>(value) >> 16);
    registers_->tab_registers[at + 1] = static_cast<std::uint16_t>(value);
  }
  void serve() {
    int line = -1;
    while (!stop_) {
      pollfd waiting{line >= 0 ? line : listening_, POLLIN, 0};
      if (::poll(&waiting, 1, 5) <= 0) continue;
      if (line < 0) {
        line = modbus_tcp_accept(context_, &listening_);
        continue;
      }
      std::uint8_t query[MODBUS_TCP_MAX_ADU_LENGTH];
      const int size = modbus_receive(context_, query);
      if (size < 0) {
        ::close(line), line = -1;
      } else if (!silent) {
        const std::scoped_lock lock(guard_);
        modbus_reply(context_, query, size, registers_);
      }
    }
    if (line >= 0) ::close(line);
  }
  modbus_mapping_t* registers_;
  modbus_t* context_;
  int listening_ = -1, port_ = 0;
  std::mutex guard_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

ModbusAxesSettings settings() {
  ModbusAxesSettings made;
  made.sequence = 10;
  made.period = TimeUs(1'000);
  made.axes = {{12, {1'000, 1, 0, false}}, {14, {1'000, 1, 0, true}}};
  return made;
}

/// The first reading within two seconds.
std::int64_t wait_for(AxisReader& axes) {
  for (const auto end = std::chrono::steady_clock::now() + 2s; std::chrono::steady_clock::now() < end;) {
    if (const std::int64_t position = tick(axes); position != kNothing) return position;
    std::this_thread::sleep_for(1ms);
  }
  return kNothing;
}

class ModbusPositions : public testing::Test {
 protected:
  ModbusPositions() {
    std::string error;
    controller_.put(1, 0, 0);  // before the first request: a number that changes after it is a reading
    const auto line = ModbusLine::tcp("127.0.0.1", controller_.port(), TimeUs(50'000), error);
    axes_ = std::make_unique<ModbusAxes>(line, settings());
  }
  Controller controller_;
  std::unique_ptr<ModbusAxes> axes_;
};

TEST_F(ModbusPositions, AllAxesOfOneRequestBelongToOneSequenceNumber) {
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(tick(*axes_), kNothing) << "the first number may be an old one";
  std::int32_t readings = 0;
  std::atomic<bool> stop{false};
  std::thread program([&] {
    for (std::int32_t i = 2; !stop; ++i) {
      controller_.put(static_cast<std::uint16_t>(i), -i, 100 * i);
      std::this_thread::sleep_for(300us);
    }
  });
  for (int i = 0; i < 1000; ++i) {
    axes_->begin_tick();
    AxisReading x, y;
    const HalFault fault = axes_->read_axis(0, x);
    ASSERT_EQ(axes_->read_axis(1, y), fault);
    if (fault == HalFault::kNone) {
      ++readings;
      ASSERT_EQ(x.position.count * 100, y.position.count) << "Y is inverted";
      ASSERT_EQ(x.position.count % 1'000, 0);
    }
    std::this_thread::sleep_for(500us);
  }
  stop = true;
  program.join();
  EXPECT_GT(readings, 200);
  std::printf("%d readings of 1000 ticks; %s\n", readings, axes_->account().c_str());
}

TEST_F(ModbusPositions, SequenceNumberThatStandsStillIsNoReading) {
  controller_.put(1, 5, 0);
  std::this_thread::sleep_for(20ms);
  controller_.put(2, 6, 0);
  EXPECT_EQ(wait_for(*axes_), 6'000);
  controller_.put(2, 7, 0);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(tick(*axes_), kNothing) << "the program of the controller has not set it";
  controller_.put(3, 7, 0);
  EXPECT_EQ(wait_for(*axes_), 7'000);
}

TEST_F(ModbusPositions, ControllerThatIsGoneIsNoReadingAndComesBack) {
  controller_.put(1, 5, 0);
  std::this_thread::sleep_for(20ms);
  controller_.put(2, 6, 0);
  EXPECT_EQ(wait_for(*axes_), 6'000);
  controller_.silent = true;
  std::this_thread::sleep_for(20ms);
  controller_.put(3, 8, 0);
  EXPECT_EQ(tick(*axes_), kNothing);
  controller_.silent = false;
  EXPECT_EQ(wait_for(*axes_), 8'000);
}

}  // namespace
}  // namespace vernier::positions_test
