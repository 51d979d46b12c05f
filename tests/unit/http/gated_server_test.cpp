// SPDX-License-Identifier: GPL-3.0-or-later
// Clients that open requests and do not end them, over real sockets.
#include "tools/http/gated_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace vernier::http_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kHeader = 300ms, kBody = 600ms;
/// A new request among many bad ones: a few ms, and what a busy computer adds.
constexpr auto kSoon = 200ms;
const std::string kRequest = "GET / HTTP/1.1\r\nHost: x\r\n\r\n", kHalf = "GET / HTTP/1.1\r\nHost: x\r\n";

class Client {
 public:
  explicit Client(int port, const char* from = "127.0.0.1") : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    ::inet_pton(AF_INET, from, &address.sin_addr);
    ::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    ::inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    const timeval patience{5, 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    open_ = ::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~Client() { ::close(fd_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool is_open() const { return open_; }
  bool send(const std::string& bytes) const {
    return ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  /// Reads until `end` came, or the server closed the connection.
  std::string answer(const std::string& end) const {
    std::string all;
    char piece[4096];
    while (all.find(end) == std::string::npos) {
      const ssize_t count = ::recv(fd_, piece, sizeof piece, 0);
      if (count <= 0) break;
      all.append(piece, static_cast<std::size_t>(count));
    }
    return all;
  }

 private:
  int fd_;
  bool open_ = false;
};

class Gate : public testing::Test {
 protected:
  Gate() {
    server_.Get("/", [](const httplib::Request&, httplib::Response& response) {
      response.set_content("yes", "text/plain");
    });
    server_.Post("/", [](const httplib::Request&, httplib::Response& response) {
      response.set_content("posted", "text/plain");
    });
    port_ = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::sleep_for(1ms);
  }
  ~Gate() override { end(); }
  void end() {
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }
  std::vector<std::unique_ptr<Client>> half_open(std::size_t count, const char* from = "127.0.0.1") {
    std::vector<std::unique_ptr<Client>> clients;
    for (std::size_t i = 0; i < count; ++i) {
      clients.push_back(std::make_unique<Client>(port_, from));
      EXPECT_TRUE(clients.back()->is_open() && clients.back()->send(kHalf));
    }
    return clients;
  }

  http::GatedServer server_{
      {.threads = 2, .most_waiting = 50, .header = kHeader, .idle = 5000ms, .body = kBody}};
  int port_ = 0;
  std::thread thread_;
};

TEST_F(Gate, ManyHalfOpenRequestsDelayNoNewOne) {
  const auto clients = half_open(300);
  const auto begin = Clock::now();
  const Client fresh(port_);
  ASSERT_TRUE(fresh.send(kRequest));
  EXPECT_NE(fresh.answer("yes").find("200 OK"), std::string::npos);
  EXPECT_LT(Clock::now() - begin, kSoon);
}

TEST_F(Gate, AHeaderHasADeadlineHoweverOftenAByteComes) {
  const auto begin = Clock::now();
  const Client slow(port_);
  std::thread drip([&] {
    for (bool open = slow.send(kHalf); open && Clock::now() - begin < 4s;) {
      std::this_thread::sleep_for(20ms);
      open = slow.send("A");
    }
  });
  EXPECT_NE(slow.answer("\r\n\r\n").find("408"), std::string::npos);
  const auto took = Clock::now() - begin;
  drip.join();
  EXPECT_GE(took, kHeader);
  EXPECT_LT(took, kHeader + kSoon);
}

// The peer with the most open requests loses its own; a slow client elsewhere keeps its place.
TEST_F(Gate, PlacesAreSharedAmongPeers) {
  const Client other(port_, "127.0.0.2");
  ASSERT_TRUE(other.is_open() && other.send(kHalf));
  const auto clients = half_open(200);
  ASSERT_TRUE(other.send("\r\n"));
  EXPECT_NE(other.answer("yes").find("200 OK"), std::string::npos);
  EXPECT_EQ(clients.front()->answer("never"), "");
}

TEST_F(Gate, AConnectionIsUsedAgainAndBytesThatCameEarlyAreKept) {
  const Client client(port_);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(client.send("POST / HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc" + kRequest));
    const std::string both = client.answer("yes");
    EXPECT_NE(both.find("posted"), std::string::npos);
    EXPECT_NE(both.find("yes"), std::string::npos);
  }
}

// Each body held a thread until its end: as many as threads, and nobody had an answer.
TEST_F(Gate, BodiesThatAreNotCompleteHoldNoThreadAndHaveADeadline) {
  std::vector<std::unique_ptr<Client>> bodies;
  for (int i = 0; i < 40; ++i) {
    bodies.push_back(std::make_unique<Client>(port_));
    ASSERT_TRUE(bodies.back()->send("POST / HTTP/1.1\r\nHost: x\r\ncontent-length:  30\r\n\r\nabc"));
  }
  std::this_thread::sleep_for(50ms);
  const auto begin = Clock::now();
  const Client fresh(port_);
  ASSERT_TRUE(fresh.send(kRequest));
  EXPECT_NE(fresh.answer("yes").find("200 OK"), std::string::npos);
  EXPECT_LT(Clock::now() - begin, kSoon);
  // One that completes its body has its answer; the others a refusal.
  ASSERT_TRUE(bodies[3]->send(std::string(27, 'd')));
  EXPECT_NE(bodies[3]->answer("posted").find("200 OK"), std::string::npos);
  EXPECT_NE(bodies[7]->answer("\r\n\r\n").find("408"), std::string::npos);
  EXPECT_LT(Clock::now() - begin, kBody + kSoon);
}

TEST_F(Gate, ALargeBodyArrivesWhole) {
  const Client client(port_);
  const std::string body(3'000'000, 'b');
  ASSERT_TRUE(client.send("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 3000000\r\n\r\n" + body + kRequest));
  const std::string both = client.answer("yes");
  EXPECT_NE(both.find("posted"), std::string::npos);
  EXPECT_NE(both.find("yes"), std::string::npos);
}

TEST_F(Gate, StopsWhileClientsAreSilent) {
  const auto clients = half_open(20);
  std::vector<std::unique_ptr<Client>> bodies;
  for (int i = 0; i < 2; ++i) {
    bodies.push_back(std::make_unique<Client>(port_));
    ASSERT_TRUE(bodies.back()->send("POST / HTTP/1.1\r\nContent-Length: 30\r\n\r\nabc"));
  }
  std::this_thread::sleep_for(50ms);
  const auto begin = Clock::now();
  end();
  EXPECT_LT(Clock::now() - begin, kSoon);
}

}  // namespace
}  // namespace vernier::http_test
