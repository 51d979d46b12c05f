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
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <thread>
#include <vector>

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
    signed_ = request[0] == kSignedByte;
    for (std::uint32_t i = 0; i < size; ++i) reply[i] = request[size - 1 - i];
    reply[size] = 0x5a;
    return size + 1;
  }
  void fill_registers(std::uint16_t* values) override {
    for (int i = 0; i < int{kLiveRegisters}; ++i) values[i] = static_cast<std::uint16_t>(1000 + i);
  }
  CommandGiven give(std::uint16_t command) override {
    if (command == 0 || command > 7) return CommandGiven::kRefused;
    ++commands;
    late_ = 3;
    stored_ = command == 6;
    return command <= 5 ? CommandGiven::kTaken : CommandGiven::kLater;
  }
  std::uint32_t ticket() const override { return 77; }
  std::uint32_t later(std::uint32_t ticket, std::uint8_t* reply) override {
    EXPECT_EQ(ticket, 77u);
    if (--late_ > 0) return kLater;
    reply[0] = stored_ ? 0 : 1;
    return 1;
  }
  bool was_signed() const override { return signed_; }
  static constexpr std::uint8_t kSignedByte = 0x77;
  std::atomic<int> requests{0}, commands{0};

 private:
  bool signed_ = false, stored_ = false;
  int late_ = 0;
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
  if (request[0] == Mirror::kSignedByte) ++request[0];
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
  int raw(std::uint32_t from = INADDR_LOOPBACK) const {
    const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_addr.s_addr = htonl(from);
    EXPECT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
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
  // The effect of a command is stored, or not, before the answer.
  EXPECT_EQ(modbus_write_register(master, 0, 6), 1);
  EXPECT_EQ(modbus_write_register(master, 0, 7), -1);
  EXPECT_EQ(errno, EMBXSFAIL);
  ASSERT_EQ(modbus_read_input_registers(master, 0, 2, values), 2) << "the frames after it are in step";
  EXPECT_EQ(serving_->mirror.commands.exchange(1), 3);
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

// A byte each 0.3 s kept `vernier status` for 58 s: the time was that of each byte.
TEST(TransportDeadline, AnswerInSingleBytesHasOneDeadline) {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(name);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&name), size), 0);
  ASSERT_EQ(::listen(listener, 1), 0);
  ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&name), &size), 0);
  std::thread board([&] {
    const int fd = ::accept(listener, nullptr, nullptr);
    std::uint8_t request[300];
    if (::recv(fd, request, sizeof(request), 0) < 12) ADD_FAILURE() << "no request";
    const std::uint8_t answer[] = {request[0], request[1], 0, 0, 0, 6, request[6], 16, 1, 0, 0, 2};
    for (const std::uint8_t byte : answer) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      if (::send(fd, &byte, 1, MSG_NOSIGNAL) != 1) break;
    }
    ::close(fd);
  });
  const auto transport = open_transport(parse_url("tcp://127.0.0.1:" + std::to_string(ntohs(name.sin_port))),
                                        std::chrono::milliseconds(300));
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<std::uint8_t> asked = {1, 2};
  EXPECT_ANY_THROW(transport->ask(asked));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(900));
  board.join();
  ::close(listener);
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

using Seconds = std::chrono::duration<double>;

/// Clients that ask for a register now and then, and come again when they are closed.
class Readers {
 public:
  Readers(std::function<int()> connect, int count, std::chrono::milliseconds pause) {
    for (int i = 0; i < count; ++i) {
      threads_.emplace_back([this, connect, pause] { run(connect, pause); });
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // one after the other
    }
  }
  ~Readers() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  int answered() const { return answered_; }
  int closed() const { return closed_; }

 private:
  void run(const std::function<int()>& connect, std::chrono::milliseconds pause) {
    const std::uint8_t request[] = {0, 1, 0, 0, 0, 6, 1, 4, 0, 0, 0, 1};
    while (!stop_) {
      const int fd = connect();
      const timeval patience{0, 100'000};
      ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
      bool open = true;
      for (bool asked = false; open && !stop_;) {
        if (!asked) open = ::send(fd, request, sizeof(request), MSG_NOSIGNAL) == sizeof(request);
        std::uint8_t reply[64];
        const ssize_t got = ::recv(fd, reply, sizeof(reply), 0);
        asked = got < 0 && errno == EAGAIN;
        open = open && (got > 0 || asked);
        if (got > 0) ++answered_, std::this_thread::sleep_for(pause);
      }
      if (!stop_) ++closed_;
      ::close(fd);
    }
  }
  std::atomic<bool> stop_{false};
  std::atomic<int> answered_{0}, closed_{0};
  std::vector<std::thread> threads_;
};

double seconds_for(const std::function<void()>& work) {
  const auto begun = std::chrono::steady_clock::now();
  work();
  return Seconds(std::chrono::steady_clock::now() - begun).count();
}

// Sixteen that asked every 0.2 s kept the seventeenth out for as long as they liked.
TEST_F(ModbusTcp, QuietClientsDoNotKeepTheNextOneOut) {
  const Readers readers([this] { return raw(); }, 16, std::chrono::milliseconds(200));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  std::mt19937_64 random(7);
  const double took_s = seconds_for([&] {
    const auto client = transport();
    for (int i = 0; i < 10; ++i) expect_mirrored(*client, random, 50);
  });
  EXPECT_LT(took_s, 1);
  EXPECT_EQ(readers.closed(), 0) << "who reads within the sixteen is left alone";
  EXPECT_GT(readers.answered(), 16);
}

// Even where they fill the places to sign in, and come again at once.
TEST_F(ModbusTcp, ManyClientsDoNotKeepTheNextOneOut) {
  const Readers readers([this] { return raw(); }, 24, std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  std::mt19937_64 random(8);
  for (int i = 0; i < 3; ++i) {
    const double took_s = seconds_for([&] {
      const auto client = transport();
      for (int k = 0; k < 10; ++k) expect_mirrored(*client, random, 50);
    });
    // Four come in in half a second; four wait before it.
    EXPECT_LT(took_s, 3);
  }
  EXPECT_GT(readers.closed(), 3);
}

TEST_F(ModbusTcp, ClientThatSignedKeepsItsPlace) {
  std::mt19937_64 random(9);
  // A mailbox of two bytes, the first says that it is signed (Mirror).
  const std::uint8_t request[] = {0, 1, 0, 0, 0, 11, 1, 16, 1, 0, 0, 2, 4, 0, 2, Mirror::kSignedByte, 1};
  const int fd = raw();
  std::uint8_t reply[64];
  ASSERT_GT(::send(fd, request, sizeof(request), MSG_NOSIGNAL), 0);
  ASSERT_GT(::recv(fd, reply, sizeof(reply), 0), 0);
  {
    // It is silent for longer than others may be, while far more clients come than there are places.
    const Readers readers([this] { return raw(); }, 30, std::chrono::milliseconds(20));
    std::this_thread::sleep_for(std::chrono::milliseconds(2600));
    EXPECT_GT(readers.closed(), 10);
  }
  ASSERT_GT(::send(fd, request, sizeof(request), MSG_NOSIGNAL), 0);
  EXPECT_GT(::recv(fd, reply, sizeof(reply), 0), 0) << "it was closed";
  ::close(fd);
}

TEST_F(ModbusTcp, PeersShareThePlaces) {
  constexpr std::uint32_t kOther = INADDR_LOOPBACK + 1;
  const Readers greedy([this] { return raw(kOther); }, 40, std::chrono::milliseconds(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const Readers modest([this] { return raw(); }, 3, std::chrono::milliseconds(20));
  std::mt19937_64 random(10);
  const double took_s = seconds_for([&] {
    const auto client = transport();
    for (int i = 0; i < 10; ++i) expect_mirrored(*client, random, 50);
  });
  EXPECT_LT(took_s, 0.5) << "no turn to be waited for";
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(modest.closed(), 0) << "they make no room for a peer that has more";
  EXPECT_GT(greedy.closed(), 4);
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
