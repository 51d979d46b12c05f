// SPDX-License-Identifier: GPL-3.0-or-later
// Modbus sensors on a joined pseudo terminal, whose far end answers by hand: values to the digit, and what a
// silent, a late, a babbling and a lying peer look like.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <cstring>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "hal/linux/modbus/modbus_input.h"
#include "tests/conformance/raw_terminal.h"

namespace vernier::modbus_input_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr TimeUs kWait(60'000);

/// CRC-16 of MODBUS over serial line V1.02, 6.2.2.
Bytes with_crc(Bytes frame) {
  unsigned crc = 0xffff;
  for (const std::uint8_t byte : frame) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? (crc >> 1) ^ 0xa001 : crc >> 1;
  }
  frame.push_back(static_cast<std::uint8_t>(crc & 0xff)),
      frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  return frame;
}

/// The sensors' end of a serial line: answers each request of 8 bytes with what `answer` makes of it.
class FarEnd {
 public:
  using Answer = std::function<Bytes(const Bytes&)>;
  explicit FarEnd(Answer answer) : answer_(std::move(answer)), fd_(raw_terminal(path_)) {
    thread_ = std::thread([this] { serve(); });
  }
  ~FarEnd() {
    stop_ = true;
    thread_.join();
    ::close(fd_);
  }
  const std::string& path() const { return path_; }
  void set(Answer answer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    answer_ = std::move(answer);
  }
  std::atomic<int> drip_ms{0};  // time before each byte of an answer

 private:
  void serve() {
    Bytes request;
    while (!stop_) {
      pollfd waiting{fd_, POLLIN, 0};
      std::uint8_t byte = 0;
      if (::poll(&waiting, 1, 5) <= 0 || ::read(fd_, &byte, 1) != 1) continue;
      request.push_back(byte);
      if (request.size() < 8) continue;
      Bytes reply;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        reply = answer_(request);
      }
      for (std::size_t i = 0; drip_ms > 0 && i < reply.size(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(drip_ms));
        static_cast<void>(::write(fd_, &reply[i], 1) == 1);
      }
      if (drip_ms > 0) {
        request.clear();
        continue;
      }
      EXPECT_EQ(::write(fd_, reply.data(), reply.size()), static_cast<ssize_t>(reply.size()));
      request.clear();
    }
  }

  std::mutex mutex_;
  Answer answer_;
  std::string path_;
  int fd_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// What a sensor answers that holds `words` from the register that was asked for.
FarEnd::Answer holds(const std::vector<std::uint16_t>& words) {
  return [words](const Bytes& request) {
    Bytes reply = {request[0], request[1], static_cast<std::uint8_t>(2 * words.size())};
    for (const std::uint16_t word : words)
      reply.push_back(static_cast<std::uint8_t>(word >> 8)), reply.push_back(static_cast<std::uint8_t>(word));
    return with_crc(reply);
  };
}

class ModbusSensor : public testing::Test {
 protected:
  ModbusSensor() : far_(holds({215})), line_(ModbusLine::rtu(far_.path(), 9600, 'N', kWait, error_)) {}
  ModbusValue value(ModbusValue::Type type = ModbusValue::Type::kInt16) const {
    return {.unit = 3, .address = 7, .type = type, .scale = 0.1};
  }
  std::int64_t reading(ModbusInput& input) {
    InputMicro micro(-7);
    if (input.sample() != HalFault::kNone) return INT64_MIN;
    return input.read_input(0, micro) == HalFault::kNone ? micro.count : INT64_MIN;
  }
  std::string error_;
  FarEnd far_;
  std::shared_ptr<ModbusLine> line_;
};

TEST_F(ModbusSensor, AsksForItsRegisterAndGivesItsUnit) {
  ASSERT_NE(line_, nullptr) << error_;
  ModbusInput input(line_, value(), 3);
  InputMicro before;
  EXPECT_EQ(input.read_input(0, before), HalFault::kNoReading) << "no sample yet";
  Bytes asked;
  far_.set([&](const Bytes& request) { return asked = request, holds({215})(request); });
  EXPECT_EQ(reading(input), 21'500'000);
  EXPECT_EQ(asked, with_crc({3, 4, 0, 7, 0, 1}));
  EXPECT_EQ(input.read_input(1, before), HalFault::kNoDevice);
}

TEST_F(ModbusSensor, ReadsEveryTypeToTheDigit) {
  using Type = ModbusValue::Type;
  ASSERT_NE(line_, nullptr) << error_;
  const auto bits = std::bit_cast<std::uint32_t>(-12.75f);
  const std::tuple<Type, std::vector<std::uint16_t>, std::int64_t> kCases[] = {
      {Type::kInt16, {0xff9c}, -10'000'000},
      {Type::kUint16, {0xff9c}, 6'543'600'000},
      {Type::kInt32, {0xffff, 0xfc18}, -100'000'000},
      {Type::kFloat32,
       {static_cast<std::uint16_t>(bits >> 16), static_cast<std::uint16_t>(bits)},
       -1'275'000}};
  for (const auto& [type, words, micro] : kCases) {
    far_.set(holds(words));
    ModbusInput input(line_, value(type), 3);
    EXPECT_EQ(reading(input), micro);
  }
  ModbusValue shifted = value();
  shifted.kind = ModbusLine::Registers::kHolding, shifted.offset = -15;
  Bytes asked;
  far_.set([&](const Bytes& request) { return asked = request, holds({215})(request); });
  ModbusInput holding(line_, shifted, 3);
  EXPECT_EQ(reading(holding), 20'000'000);
  EXPECT_EQ(asked[1], 3);
}

TEST_F(ModbusSensor, LyingPeerGivesNoReading) {
  ASSERT_NE(line_, nullptr) << error_;
  ModbusInput input(line_, value(), 3);
  const std::pair<const char*, FarEnd::Answer> kLies[] = {
      {"silence", [](const Bytes&) { return Bytes{}; }},
      {"another unit",
       [](const Bytes&) {
         return with_crc({4, 4, 2, 0, 215});
       }},
      {"another function",
       [](const Bytes&) {
         return with_crc({3, 3, 2, 0, 215});
       }},
      {"a wrong checksum", [](const Bytes&) { return Bytes{3, 4, 2, 0, 215, 0, 0}; }},
      {"more registers",
       [](const Bytes&) {
         return with_crc({3, 4, 4, 0, 215, 0, 215});
       }},
      {"fewer registers",
       [](const Bytes&) {
         return with_crc({3, 4, 0});
       }},
      {"an answer cut off",
       [](const Bytes&) {
         return Bytes{3, 4, 2, 0};
       }},
      {"an exception",
       [](const Bytes&) {
         return with_crc({3, 0x84, 2});
       }},
      {"babble", [](const Bytes&) { return Bytes(256, 0x55); }}};
  for (const auto& [what, lie] : kLies) {
    far_.set(lie);
    EXPECT_EQ(reading(input), INT64_MIN) << what;
    far_.set(holds({215}));
    EXPECT_EQ(reading(input), 21'500'000) << "recovers at once from " << what;
  }
}

TEST_F(ModbusSensor, LateAnswerIsNotTakenForTheNext) {
  ASSERT_NE(line_, nullptr) << error_;
  ModbusInput input(line_, value(), 3);
  far_.set([](const Bytes& request) {
    ::usleep(static_cast<useconds_t>(kWait.count * 3 / 2));
    return holds({999})(request);
  });
  EXPECT_EQ(reading(input), INT64_MIN);
  far_.set(holds({215}));
  EXPECT_EQ(reading(input), 21'500'000) << "not the 99.9 that came late";
}

TEST_F(ModbusSensor, NumberThatIsNoneIsNoReading) {
  ASSERT_NE(line_, nullptr) << error_;
  ModbusInput input(line_, value(ModbusValue::Type::kFloat32), 3);
  far_.set(holds({0x7fc0, 0}));
  EXPECT_EQ(reading(input), INT64_MIN) << "not a number";
  far_.set(holds({0x7f80, 0}));
  EXPECT_EQ(reading(input), INT64_MIN) << "infinite";
}

TEST_F(ModbusSensor, ChangedFramesAreNeverTaken) {
  ASSERT_NE(line_, nullptr) << error_;
  constexpr unsigned kSeed = 1;
  RecordProperty("seed", kSeed);
  std::mt19937 random(kSeed);
  ModbusInput input(line_, value(), 3);
  const Bytes good = with_crc({3, 4, 2, 0, 215});
  int refused = 0;
  // One to three changed bits are always seen by the checksum (its distance is 4 at this length).
  for (int i = 0; i < 25; ++i) {
    Bytes changed = good;
    const int bits = 1 + static_cast<int>(random() % 3);
    for (int k = 0; k < bits; ++k)
      changed[random() % changed.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    if (changed == good) continue;
    far_.set([changed](const Bytes&) { return changed; });
    ASSERT_EQ(reading(input), INT64_MIN);
    ++refused;
  }
  EXPECT_GT(refused, 15);
}

TEST(ModbusTcpSensor, PeerThatIsNotThereIsTriedAgain) {
  // GIVEN a port on which nobody listens
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  std::string error;
  ModbusInput input(ModbusLine::tcp("127.0.0.1", ntohs(address.sin_port), kWait, error),
                    {.unit = 3, .address = 7, .scale = 0.1}, 3);
  EXPECT_EQ(input.sample(), HalFault::kNoReading);
  // WHEN it comes up, answers once, and breaks off in the middle of the next answer
  ASSERT_EQ(::listen(listener, 1), 0);
  std::thread peer([&] {
    for (const std::size_t bytes : {std::size_t{11}, std::size_t{5}, std::size_t{11}}) {
      static int fd = -1;
      if (fd < 0) fd = ::accept(listener, nullptr, nullptr);
      std::uint8_t query[12];
      if (::recv(fd, query, sizeof(query), MSG_WAITALL) != 12) return;
      const std::uint8_t reply[11] = {query[0], query[1], 0, 0, 0, 5, 3, 4, 2, 0, 215};
      EXPECT_EQ(::send(fd, reply, bytes, MSG_NOSIGNAL), static_cast<ssize_t>(bytes));
      if (bytes < 11) ::close(fd), fd = -1;
    }
  });
  // THEN it is read, then silent, then read again
  EXPECT_EQ(input.sample(), HalFault::kNone);
  EXPECT_EQ(input.sample(), HalFault::kNoReading);
  EXPECT_EQ(input.sample(), HalFault::kNone);
  InputMicro micro;
  EXPECT_EQ(input.read_input(0, micro), HalFault::kNone);
  EXPECT_EQ(micro, InputMicro(21'500'000));
  peer.join();
  ::close(listener);
}

/// A device over TCP: answers each request of so many bytes with what `answer` makes of it, to one client
/// after the other.
class FarServer {
 public:
  using Answer = std::function<Bytes(const Bytes&)>;
  explicit FarServer(std::size_t bytes = 12) : bytes_(bytes), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    EXPECT_EQ(::listen(listener_, 4), 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~FarServer() {
    stop_ = true;
    thread_.join();
    ::close(listener_);
  }
  int port() const { return port_; }
  void set(Answer answer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    answer_ = std::move(answer);
  }
  std::atomic<int> drip_ms{0};  // time before each byte of an answer

 private:
  void serve() {
    int fd = -1;
    while (!stop_) {
      pollfd waiting{fd < 0 ? listener_ : fd, POLLIN, 0};
      if (::poll(&waiting, 1, 5) <= 0) continue;
      if (fd < 0) {
        fd = ::accept(listener_, nullptr, nullptr);
        continue;
      }
      Bytes request(bytes_);
      if (::recv(fd, request.data(), bytes_, MSG_WAITALL) != static_cast<ssize_t>(bytes_)) {
        ::close(fd), fd = -1;
        continue;
      }
      const std::lock_guard<std::mutex> lock(mutex_);
      const Bytes reply = answer_(request);
      for (std::size_t i = 0; drip_ms > 0 && i < reply.size(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(drip_ms));
        static_cast<void>(::send(fd, &reply[i], 1, MSG_NOSIGNAL) == 1);
      }
      if (drip_ms > 0) continue;
      EXPECT_EQ(::send(fd, reply.data(), reply.size(), MSG_NOSIGNAL), static_cast<ssize_t>(reply.size()));
    }
    if (fd >= 0) ::close(fd);
  }

  std::mutex mutex_;
  Answer answer_;
  std::size_t bytes_;
  int listener_, port_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(ModbusTcpSensor, AnswerToSomethingElseIsNoReadingAndCounted) {
  // GIVEN a sensor, unit 3, that holds 215
  const auto truth = [](const Bytes& q) {
    EXPECT_EQ(Bytes(q.begin() + 2, q.end()), (Bytes{0, 0, 0, 6, 3, 4, 0, 7, 0, 1}));
    return Bytes{q[0], q[1], 0, 0, 0, 5, 3, 4, 2, 0, 215};
  };
  const auto changed = [&](std::size_t byte, std::uint8_t to) {
    return [=](const Bytes& q) {
      Bytes reply = truth(q);
      reply[byte] = to;
      return reply;
    };
  };
  const std::pair<const char*, FarServer::Answer> kLies[] = {
      {"another unit", changed(6, 4)},
      {"unit 0", changed(6, 0)},
      {"unit 255", changed(6, 255)},
      {"another function", changed(7, 3)},
      {"another protocol", changed(3, 1)},
      {"a wrong length", changed(5, 6)},
      {"an earlier transaction",
       [&](const Bytes& q) {
         Bytes reply = truth(q);
         --reply[1];
         return reply;
       }},
      {"an exception of another unit",
       [](const Bytes& q) { return Bytes{q[0], q[1], 0, 0, 0, 3, 4, 0x84, 2}; }},
      {"more registers",
       [](const Bytes& q) { return Bytes{q[0], q[1], 0, 0, 0, 7, 3, 4, 4, 0, 215, 0, 215}; }}};
  FarServer far;
  std::string error;
  const std::shared_ptr<ModbusLine> line = ModbusLine::tcp("127.0.0.1", far.port(), kWait, error);
  ModbusInput input(line, {.unit = 3, .address = 7, .scale = 0.1}, 3);
  std::uint64_t wrong = 0;
  for (const auto& [what, lie] : kLies) {
    // WHEN an answer belongs to something else
    far.set(lie);
    EXPECT_EQ(input.sample(), HalFault::kNoReading) << what;
    InputMicro micro;
    EXPECT_EQ(input.read_input(0, micro), HalFault::kNoReading) << what;
    // THEN it is counted, and the next right one is a reading
    EXPECT_EQ(line->wrong_answers(), ++wrong) << what;
    far.set(truth);
    EXPECT_EQ(input.sample(), HalFault::kNone) << "recovers from " << what;
    EXPECT_EQ(input.read_input(0, micro), HalFault::kNone);
    EXPECT_EQ(micro, InputMicro(21'500'000));
  }
  // An exception of the right unit is an answer, though not a reading.
  far.set([](const Bytes& q) { return Bytes{q[0], q[1], 0, 0, 0, 3, 3, 0x84, 2}; });
  EXPECT_EQ(input.sample(), HalFault::kNoReading);
  EXPECT_EQ(line->wrong_answers(), wrong);
}

TEST(ModbusTcpWrite, IsDoneOnlyWithTheAnswerToIt) {
  // GIVEN a controller, unit 3, that takes two registers from 100 on
  const auto truth = [](const Bytes& q) {
    EXPECT_EQ(Bytes(q.begin() + 2, q.end()),
              (Bytes{0, 0, 0, 11, 3, 16, 0, 100, 0, 2, 4, 0x12, 0x34, 0xff, 0xfe}));
    return Bytes{q[0], q[1], 0, 0, 0, 6, 3, 16, 0, 100, 0, 2};
  };
  FarServer far(17);
  std::string error;
  const std::shared_ptr<ModbusLine> line = ModbusLine::tcp("127.0.0.1", far.port(), kWait, error);
  const std::uint16_t values[] = {0x1234, 0xfffe};
  std::uint64_t wrong = 0;
  for (const std::size_t byte : {1U, 3U, 5U, 6U, 7U, 8U, 9U, 10U, 11U}) {
    // WHEN one byte of an answer is another: transaction, protocol, length, unit, function, address, number
    far.set([&](const Bytes& q) {
      Bytes reply = truth(q);
      ++reply[byte];
      return reply;
    });
    EXPECT_FALSE(line->write(3, 100, 2, values)) << byte;
    // THEN the write is not believed, and the next right answer is
    EXPECT_EQ(line->wrong_answers(), ++wrong) << byte;
    far.set(truth);
    EXPECT_TRUE(line->write(3, 100, 2, values)) << byte;
  }
  far.set([](const Bytes& q) { return Bytes{q[0], q[1], 0, 0, 0, 3, 3, 0x90, 2}; });
  EXPECT_FALSE(line->write(3, 100, 2, values)) << "an exception";
  EXPECT_FALSE(line->write(3, 100, 0, values));
  EXPECT_FALSE(line->write(3, 100, 124, values)) << "more than a request holds";
}

/// Time of one sample whose answer comes in single bytes.
std::chrono::milliseconds time_of(ModbusInput& input) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_NE(input.sample(), HalFault::kNone);
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin);
}

// The time was that of each byte: an answer of 45 ms a byte was waited for a second.
TEST_F(ModbusSensor, AnswerInSingleBytesHasOneDeadline) {
  ModbusInput input(line_, value(), 1);
  EXPECT_NE(reading(input), INT64_MIN);
  far_.drip_ms = 45;
  EXPECT_LT(time_of(input).count(), 2 * kWait.count / 1000) << "60 ms, and a busy computer";
}

TEST(ModbusTcpSensor, AnswerInSingleBytesHasOneDeadline) {
  FarServer far;
  far.set([](const Bytes& q) { return Bytes{q[0], q[1], 0, 0, 0, 5, q[6], q[7], 2, 0, 215}; });
  std::string error;
  ModbusInput input(ModbusLine::tcp("127.0.0.1", far.port(), kWait, error), {.unit = 3, .address = 7}, 1);
  EXPECT_EQ(input.sample(), HalFault::kNone);
  far.drip_ms = 45;
  EXPECT_LT(time_of(input).count(), 2 * kWait.count / 1000) << "60 ms, and a busy computer";
}

TEST(ModbusLineSetUp, MissingDeviceIsNamed) {
  std::string error;
  EXPECT_EQ(ModbusLine::rtu("/dev/no_such_line", 9600, 'E', kWait, error), nullptr);
  EXPECT_NE(error.find("/dev/no_such_line: No such file"), std::string::npos) << error;
}

}  // namespace
}  // namespace vernier::modbus_input_test
