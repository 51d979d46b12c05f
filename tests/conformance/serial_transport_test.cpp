// SPDX-License-Identifier: GPL-3.0-or-later
// The way to a board at a plain serial line, on a pseudo terminal whose other end is the board.
#include "tools/upload/serial_transport.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <random>
#include <thread>

#include "tables/serial_frame.h"
#include "tools/text/error.h"
#include "tools/upload/open_transport.h"

namespace vernier {

using namespace vernier::text;
using namespace vernier::upload;
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Answers op, sequence, payload with op, sequence, 0 and the payload; before each answer it says what
/// `noise` holds.
class SerialBoard {
 public:
  explicit SerialBoard(Bytes noise = {})
      : noise_(std::move(noise)), line_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    EXPECT_GE(line_, 0);
    EXPECT_EQ(::grantpt(line_), 0);
    EXPECT_EQ(::unlockpt(line_), 0);
    name_ = ::ptsname(line_);
    thread_ = std::thread([this] { run(); });
  }
  ~SerialBoard() {
    hang_up();
    ::close(line_);
  }
  void hang_up() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  BoardUrl url() const { return parse_url("serial://" + name_ + "?baud=115200"); }
  std::atomic<int> requests{0};

 private:
  void run() {
    FrameReader reader;
    while (!stop_) {
      pollfd waiting{line_, POLLIN, 0};
      std::uint8_t byte = 0;
      if (::poll(&waiting, 1, 5) <= 0 || (waiting.revents & POLLIN) == 0 || ::read(line_, &byte, 1) != 1)
        continue;
      if (!reader.take(byte)) continue;
      ++requests;
      Bytes reply(reader.message(), reader.message() + reader.size());
      reply.insert(reply.begin() + 2, 0);
      std::uint8_t frame[kMaxFrameBytes];
      const std::uint32_t size = write_frame(reply.data(), static_cast<std::uint32_t>(reply.size()), frame);
      say(noise_.data(), noise_.size());
      say(frame, size);
    }
  }
  void say(const std::uint8_t* bytes, std::size_t size) const {
    while (size > 0) {
      const ssize_t sent = ::write(line_, bytes, size);
      if (sent <= 0) return;
      bytes += sent, size -= static_cast<std::size_t>(sent);
    }
  }

  Bytes noise_;
  int line_;
  std::string name_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void expect_answered(Transport& transport, std::mt19937& random, std::size_t size) {
  Bytes request(size);
  for (std::uint8_t& byte : request) byte = static_cast<std::uint8_t>(random());
  Bytes wanted = request;
  wanted.insert(wanted.begin() + 2, 0);
  ASSERT_EQ(transport.ask(request), wanted) << size << " bytes";
}

TEST(SerialTransport, CarriesRequestsOfEveryLength) {
  SerialBoard board;
  const auto transport = open_transport(board.url());
  std::mt19937 random(1);
  for (std::size_t size = kRequestHeaderBytes; size <= kMaxRequestBytes; ++size)
    expect_answered(*transport, random, size);
  EXPECT_EQ(board.requests, int{kMaxRequestBytes - kRequestHeaderBytes + 1});
}

// What a board says while it starts, half a frame, a frame with a wrong sum and the answer to another request
// stand before each reply.
TEST(SerialTransport, FindsTheReplyBehindWhatIsNone) {
  Bytes noise = {'b', 'o', 'o', 't', '\r', '\n', kFrameEnd, 1, 2, 3, 4, 5, 6, 7, kFrameEnd};
  std::uint8_t frame[kMaxFrameBytes];
  const std::uint8_t other[] = {99, 99, 0, 1, 2, 3};
  const std::uint32_t size = write_frame(other, sizeof(other), frame);
  noise.insert(noise.end(), frame, frame + size);
  noise.insert(noise.end(), frame, frame + size / 2);
  SerialBoard board(noise);
  const auto transport = open_transport(board.url());
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) expect_answered(*transport, random, 20);
}

TEST(SerialTransport, WhatIsNoLineIsSaid) {
  EXPECT_THROW(open_transport(parse_url("serial:///dev/null")), InputError);
  EXPECT_THROW(open_transport(parse_url("serial:///nowhere/tty")), InputError);
  SerialBoard board;
  BoardUrl url = board.url();
  url.options["baud"] = "115201";
  EXPECT_THROW(open_transport(url), InputError);
}

TEST(SerialTransport, LineThatIsClosedIsSaidAtOnce) {
  auto board = std::make_unique<SerialBoard>();
  const auto transport = open_transport(board->url());
  std::mt19937 random(3);
  expect_answered(*transport, random, 10);
  board.reset();
  EXPECT_THROW(transport->ask({1, 2}), InputError);
}

}  // namespace
}  // namespace vernier
