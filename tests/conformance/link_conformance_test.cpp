// SPDX-License-Identifier: GPL-3.0-or-later
// What every CommandLink owes the firmware and the tools, on real sockets and lines: Modbus TCP on loopback,
// Modbus RTU on a pair of pseudo terminals, ISO-TP where the kernel has virtual CAN.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <modbus.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <thread>

#include "hal/linux/modbus/modbus_server.h"
#include "tables/link_format.h"
#include "tools/upload/open_transport.h"
#include "tools/upload/transport.h"

namespace vernier::link_conformance_test {

using namespace vernier::upload;
namespace {

/// Answers a request with its bytes, reversed and one more; counts what it was given.
class Mirror : public CommandHandler {
 public:
  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) override {
    ++requests;
    for (std::uint32_t i = 0; i < size; ++i) reply[i] = request[size - 1 - i];
    reply[size] = 0x5a;
    return size + 1;
  }
  void fill_registers(std::uint16_t* values) override {
    for (int i = 0; i < int{kLiveRegisters}; ++i) values[i] = static_cast<std::uint16_t>(1000 + i);
  }
  bool give(std::uint16_t command) override {
    if (command == 0 || command > 5) return false;
    ++commands;
    return true;
  }
  std::atomic<int> requests{0}, commands{0};
};

constexpr ModbusLayout kLayout{kMailboxRegister, kMailboxRegisters, kLiveRegisters};

/// A server that serves in a thread of its own until it is destroyed.
class Serving {
 public:
  explicit Serving(std::unique_ptr<CommandLink> link)
      : link_(std::move(link)), thread_([this] {
          while (!stop_) link_->serve(mirror, TimeUs(5'000));
        }) {}
  ~Serving() {
    stop_ = true;
    thread_.join();
  }
  Mirror mirror;

 private:
  std::unique_ptr<CommandLink> link_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

std::vector<std::uint8_t> request_of(std::mt19937_64& random, std::size_t size) {
  std::vector<std::uint8_t> request(size);
  for (std::uint8_t& byte : request) byte = static_cast<std::uint8_t>(random());
  return request;
}

void expect_mirrored(Transport& transport, std::mt19937_64& random, std::size_t size) {
  const std::vector<std::uint8_t> request = request_of(random, size);
  std::vector<std::uint8_t> wanted(request.rbegin(), request.rend());
  wanted.push_back(0x5a);
  ASSERT_EQ(transport.ask(request), wanted) << size << " bytes";
}

class ModbusTcp : public testing::Test {
 protected:
  ModbusTcp() {
    std::string error;
    auto server = ModbusServer::tcp("127.0.0.1", 0, kLayout, error);
    EXPECT_TRUE(server) << error;
    port_ = server->port();
    serving_ = std::make_unique<Serving>(std::move(server));
  }
  std::unique_ptr<Transport> transport() const {
    return open_transport(parse_url("tcp://127.0.0.1:" + std::to_string(port_)));
  }
  int raw() const {
    const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_port = htons(static_cast<std::uint16_t>(port_));
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
    return fd;
  }
  int port_ = 0;
  std::unique_ptr<Serving> serving_;
};

TEST_F(ModbusTcp, CarriesRequestsOfEveryLength) {
  std::mt19937_64 random(1);
  const auto client = transport();
  for (std::size_t size = 1; size <= kMaxRequestBytes; ++size) expect_mirrored(*client, random, size);
}

TEST_F(ModbusTcp, ClientsDoNotSeeEachOthersReplies) {
  std::mt19937_64 random(2);
  const auto one = transport(), two = transport();
  std::thread other([&] {
    std::mt19937_64 own(3);
    for (int i = 0; i < 200; ++i) expect_mirrored(*two, own, 1 + static_cast<std::size_t>(own() % 200));
  });
  for (int i = 0; i < 200; ++i) expect_mirrored(*one, random, 1 + static_cast<std::size_t>(random() % 200));
  other.join();
}

TEST_F(ModbusTcp, PlainMasterReadsRegistersAndGivesCommands) {
  modbus_t* const master = modbus_new_tcp("127.0.0.1", port_);
  ASSERT_EQ(modbus_connect(master), 0);
  std::uint16_t values[kLiveRegisters];
  ASSERT_EQ(modbus_read_input_registers(master, 0, kLiveRegisters, values), int{kLiveRegisters});
  EXPECT_EQ(values[0], 1000);
  EXPECT_EQ(values[kLiveRegisters - 1], 1000 + kLiveRegisters - 1);
  EXPECT_EQ(modbus_write_register(master, 0, 1), 1);
  EXPECT_EQ(serving_->mirror.commands, 1);
  // What is no command, no register or no function of ours is refused with the exception of the standard.
  EXPECT_EQ(modbus_write_register(master, 0, 77), -1);
  EXPECT_EQ(errno, EMBXILVAL);
  EXPECT_EQ(modbus_write_register(master, 5, 1), -1);
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(modbus_write_registers(master, 10, 3, values), -1);
  EXPECT_EQ(errno, EMBXILADD);
  std::uint8_t bits[8];
  EXPECT_EQ(modbus_read_bits(master, 0, 8, bits), -1);
  EXPECT_EQ(errno, EMBXILFUN);
  EXPECT_EQ(modbus_read_input_registers(master, 370, 20, values), -1);
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(serving_->mirror.commands, 1);
  modbus_close(master);
  modbus_free(master);
}

TEST_F(ModbusTcp, StalledPeersDoNotLockOthersOut) {
  // Many peers that connect, send half a request and stay.
  std::vector<int> stalled;
  const std::uint8_t half[] = {0, 1, 0, 0, 0, 6, 1};
  for (int i = 0; i < 20; ++i) {
    stalled.push_back(raw());
    ASSERT_GT(::send(stalled.back(), half, sizeof(half), MSG_NOSIGNAL), 0);
  }
  std::mt19937_64 random(4);
  const auto client = transport();
  for (int i = 0; i < 10; ++i) expect_mirrored(*client, random, 50);
  for (const int fd : stalled) ::close(fd);
}

std::uint64_t from_environment(const char* name, std::uint64_t value) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : value;
}

// A frame that is right, with some of its bytes changed, cut or followed by others.
std::vector<std::uint8_t> hostile_frame(std::mt19937_64& random) {
  std::vector<std::uint8_t> frame = {0, 1, 0, 0, 0, 0, 1, 16, 1, 0, 0, 3, 6, 0, 2, 1, 2, 0, 0};
  if (random() % 2 == 0) frame = {0, 1, 0, 0, 0, 6, 1, static_cast<std::uint8_t>(random() % 25), 0, 0, 0, 8};
  frame[5] = static_cast<std::uint8_t>(frame.size() - 6);
  const auto changes = random() % 4;
  for (std::uint64_t i = 0; i < changes; ++i)
    frame[random() % frame.size()] = static_cast<std::uint8_t>(random());
  if (random() % 60 == 0) frame.resize(1 + random() % frame.size());  // costs the server its time-out
  if (random() % 8 == 0)
    for (std::uint64_t i = random() % 300; i > 0; --i) frame.push_back(static_cast<std::uint8_t>(random()));
  return frame;
}

// VERNIER_SEED and VERNIER_COUNT repeat or extend a run. Whether a frame is answered does not matter; that
// the server lives and goes on serving others does.
TEST_F(ModbusTcp, SurvivesMutatedExchanges) {
  const std::uint64_t seed = from_environment("VERNIER_SEED", 5),
                      count = from_environment("VERNIER_COUNT", 3000);
  std::printf("seed %llu, %llu exchanges\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(count));
  std::mt19937_64 random(seed);
  int fd = raw();
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::vector<std::uint8_t> frame = hostile_frame(random);
    const bool sent = ::send(fd, frame.data(), frame.size(), MSG_NOSIGNAL) > 0;
    std::uint8_t reply[600];
    const ssize_t got = sent ? ::recv(fd, reply, sizeof(reply), MSG_DONTWAIT) : -1;
    if (!sent || got == 0 || random() % 20 == 0) {
      ::close(fd);
      fd = raw();
    }
  }
  ::close(fd);
  const auto client = transport();
  expect_mirrored(*client, random, 100);
}

/// Two pseudo terminals joined by a thread: what is written to one end is read from the other.
class Line {
 public:
  Line() {
    for (int i = 0; i < 2; ++i) {
      master_[i] = ::posix_openpt(O_RDWR | O_NOCTTY);
      EXPECT_EQ(::grantpt(master_[i]), 0);
      EXPECT_EQ(::unlockpt(master_[i]), 0);
      name_[i] = ::ptsname(master_[i]);
    }
    thread_ = std::thread([this] {
      while (!stop_) carry();
    });
  }
  ~Line() {
    stop_ = true;
    thread_.join();
    for (const int fd : master_) ::close(fd);
  }
  const std::string& end(int i) const { return name_[i]; }

 private:
  void carry() {
    pollfd waiting[2] = {{master_[0], POLLIN, 0}, {master_[1], POLLIN, 0}};
    ::poll(waiting, 2, 5);
    for (int i = 0; i < 2; ++i) {
      std::uint8_t bytes[512];
      if ((waiting[i].revents & POLLIN) == 0) continue;
      const ssize_t got = ::read(master_[i], bytes, sizeof(bytes));
      if (got > 0 && ::write(master_[1 - i], bytes, static_cast<std::size_t>(got)) != got) stop_ = true;
    }
  }
  int master_[2] = {-1, -1};
  std::string name_[2];
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(ModbusRtu, CarriesRequestsOverALine) {
  Line line;
  std::string error;
  auto server = ModbusServer::rtu(line.end(0), 115200, 'N', 7, kLayout, error);
  ASSERT_TRUE(server) << error;
  Serving serving(std::move(server));
  std::mt19937_64 random(6);
  const auto client = open_transport(parse_url("rtu://" + line.end(1) + "?baud=115200&parity=N&unit=7"));
  for (const std::size_t size : {1u, 2u, 50u, 199u, 240u}) expect_mirrored(*client, random, size);
}

TEST(ModbusServerSetUp, SaysWhyItCannotListen) {
  std::string error;
  EXPECT_EQ(ModbusServer::tcp("localhost", 0, kLayout, error), nullptr);
  EXPECT_EQ(error, "localhost: not a numeric address");
  EXPECT_EQ(ModbusServer::tcp("192.0.2.1", 0, kLayout, error), nullptr);  // nobody's address (RFC 5737)
  EXPECT_NE(error.find("192.0.2.1"), std::string::npos);
  EXPECT_EQ(ModbusServer::rtu("/dev/nothing", 9600, 'E', 1, kLayout, error), nullptr);
  EXPECT_NE(error.find("/dev/nothing"), std::string::npos);
}

}  // namespace
}  // namespace vernier::link_conformance_test
