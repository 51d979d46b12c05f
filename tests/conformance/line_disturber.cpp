// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/conformance/line_disturber.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>

#include "tests/conformance/raw_terminal.h"

namespace vernier {
namespace {

using namespace std::chrono_literals;
using Frame = LineDisturber::Frame;

constexpr std::uint8_t kRead = 3, kWrite = 16, kFailed = 0x80, kDeviceFailure = 4;
constexpr std::size_t kHead = 6;  // unit, function, address, number: the same for each request of one kind

std::size_t request_size(const Frame& frame) {
  if (frame.size() < 7) return 7;
  return frame[1] == kWrite ? 9u + frame[6] : 8u;
}
std::size_t answer_size(const Frame& frame) {
  if (frame.size() < 3) return 3;
  return frame[1] == kRead ? 5u + frame[2] : frame[1] == kWrite ? 8u : 5u;
}

void close_with_checksum(Frame& frame) {
  std::uint32_t crc = 0xffff;
  for (const std::uint8_t byte : frame) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? crc >> 1 ^ 0xa001 : crc >> 1;
  }
  frame.push_back(static_cast<std::uint8_t>(crc));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
}

bool has_input(int fd, std::chrono::milliseconds wait) {
  pollfd one{fd, POLLIN, 0};
  return ::poll(&one, 1, static_cast<int>(wait.count())) > 0 && (one.revents & POLLIN) != 0;
}

}  // namespace

LineDisturber::LineDisturber(const std::string& server, unsigned seed)
    : client_(raw_terminal(path_)),
      server_(::open(server.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)),
      random_(seed) {
  thread_ = std::thread([this] { run(); });
}

LineDisturber::~LineDisturber() {
  stop_ = true;
  thread_.join();
  ::close(client_);
  ::close(server_);
}

/// A whole frame, or what has come before a pause.
Frame LineDisturber::read_frame(int fd, std::size_t (*size_of)(const Frame&),
                                std::chrono::milliseconds patience) const {
  Frame frame;
  while (frame.size() < size_of(frame) && has_input(fd, frame.empty() ? patience : 5ms)) {
    std::uint8_t bytes[300];
    const ssize_t got = ::read(fd, bytes, std::min(sizeof bytes, size_of(frame) - frame.size()));
    if (got <= 0) break;
    frame.insert(frame.end(), bytes, bytes + got);
  }
  return frame;
}

void LineDisturber::turn_a_bit(Frame& frame) {
  if (frame.empty()) return;
  const auto bit = random_() % (8 * frame.size());
  frame[bit / 8] = static_cast<std::uint8_t>(frame[bit / 8] ^ 1u << bit % 8);
}

void LineDisturber::send(const Frame& frame) const {
  if (fault != Fault::kSlowBytes) {
    static_cast<void>(::write(client_, frame.data(), frame.size()) > 0);
    return;
  }
  for (const std::uint8_t byte : frame) {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
    static_cast<void>(::write(client_, &byte, 1) > 0);
  }
}

void LineDisturber::answer(const Frame& request, Frame frame) {
  switch (fault.load()) {
    case Fault::kOtherUnit:
      frame.resize(frame.size() - 2);
      ++frame[0];
      close_with_checksum(frame);
      break;
    case Fault::kBitErrors:
      if (every_second()) turn_a_bit(frame);
      break;
    case Fault::kException:
      frame = {request[0], static_cast<std::uint8_t>(request[1] | kFailed), kDeviceFailure};
      close_with_checksum(frame);
      break;
    case Fault::kNoAnswer:
      return;
    case Fault::kLate:
      late_.emplace_back(Clock::now() + std::chrono::milliseconds(ms), frame);
      return;
    case Fault::kGarbage:
      if (every_second()) {
        Frame noise(1 + random_() % 20);
        for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random_());
        frame.insert(frame.begin(), noise.begin(), noise.end());
      }
      break;
    case Fault::kCutAnswers:
      if (every_second()) frame.resize(random_() % frame.size());
      break;
    case Fault::kTwice: {
      // In one write: between two, a busy computer lets the client ask again.
      const Frame once = frame;
      frame.insert(frame.end(), once.begin(), once.end());
      break;
    }
    case Fault::kAgain:
      late_.emplace_back(Clock::now() + std::chrono::milliseconds(ms), frame);
      break;
    case Fault::kOwnEcho:
      frame.insert(frame.begin(), request.begin(), request.end());
      break;
    default:
      break;
  }
  send(frame);
}

void LineDisturber::pass(Frame request) {
  const Fault now = fault;
  const Frame key(request.begin(),
                  request.begin() + static_cast<std::ptrdiff_t>(std::min(kHead, request.size())));
  if (now == Fault::kCutLine) return;
  if (now == Fault::kOldAnswers) {
    if (const auto old = before_.find(key); old != before_.end()) send(old->second);
    return;
  }
  if (now == Fault::kBitsOfRequests && every_second()) turn_a_bit(request);
  // What the server answered too late to an earlier request is no answer to this one.
  while (has_input(server_, 0ms) && !read_frame(server_, answer_size, 0ms).empty()) {
  }
  static_cast<void>(::write(server_, request.data(), request.size()) > 0);
  const Frame frame = read_frame(server_, answer_size, 50ms);
  if (frame.size() < 5) return;
  if (now == Fault::kNone) before_[key] = frame;
  answer(request, frame);
}

void LineDisturber::run() {
  while (!stop_) {
    while (!late_.empty() && late_.front().first <= Clock::now()) {
      send(late_.front().second);
      late_.pop_front();
    }
    if (!has_input(client_, 1ms)) continue;
    const Frame request = read_frame(client_, request_size, 5ms);
    if (!request.empty()) pass(request);
  }
}

}  // namespace vernier
