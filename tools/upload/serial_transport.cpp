// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/upload/serial_transport.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "tables/serial_frame.h"
#include "tools/text/error.h"

namespace vernier::upload {
namespace {

speed_t speed_of(std::uint32_t baud) {
  switch (baud) {
    case 9600:
      return B9600;
    case 19200:
      return B19200;
    case 38400:
      return B38400;
    case 57600:
      return B57600;
    case 115200:
      return B115200;
    case 230400:
      return B230400;
    case 460800:
      return B460800;
    case 921600:
      return B921600;
    default:
      throw text::InputError(fmt::format("board address: no serial line has {} baud", std::to_string(baud)));
  }
}

class SerialTransport : public Transport {
 public:
  SerialTransport(const BoardUrl& url, std::chrono::milliseconds wait)
      : wait_(wait), name_("serial://" + url.place) {
    const speed_t speed = speed_of(url.number("baud", 115200));
    line_ = ::open(url.place.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (line_ < 0) fail(errno);
    if (set_up(speed)) return;
    const int error = errno;
    ::close(line_);
    fail(error);
  }
  ~SerialTransport() override { ::close(line_); }
  SerialTransport(const SerialTransport&) = delete;
  SerialTransport& operator=(const SerialTransport&) = delete;

  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    std::uint8_t frame[kMaxFrameBytes];
    const std::uint32_t size = write_frame(request.data(), static_cast<std::uint32_t>(request.size()), frame);
    for (std::uint32_t sent = 0; sent < size;) {
      const ssize_t now = ::write(line_, frame + sent, size - sent);
      if (now < 0 && errno != EINTR) fail(errno);
      if (now > 0) sent += static_cast<std::uint32_t>(now);
    }
    const auto end = std::chrono::steady_clock::now() + wait_;
    for (;;) {
      const std::vector<std::uint8_t> reply = next_message(end);
      // What answers an earlier request, whose time had run out, is not ours.
      if (reply.size() >= 2 && reply[0] == request[0] && reply[1] == request[1]) return reply;
    }
  }

 private:
  bool set_up(speed_t speed) const {
    termios settings{};
    if (::tcgetattr(line_, &settings) != 0) return false;
    ::cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    return ::cfsetspeed(&settings, speed) == 0 && ::tcsetattr(line_, TCSANOW, &settings) == 0 &&
           ::tcflush(line_, TCIOFLUSH) == 0;
  }
  [[noreturn]] void fail(int error) const { throw text::InputError(name_ + ": " + std::strerror(error)); }
  /// Bytes that come do not move the end.
  std::vector<std::uint8_t> next_message(std::chrono::steady_clock::time_point end) {
    for (;;) {
      pollfd waiting{line_, POLLIN, 0};
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
      const int ready = left <= 0 ? 0 : ::poll(&waiting, 1, static_cast<int>(left));
      if (ready < 0 && errno == EINTR) continue;
      if (ready == 0) throw text::InputError(name_ + ": no reply");
      std::uint8_t byte = 0;
      const ssize_t got = ready < 0 ? -1 : ::read(line_, &byte, 1);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(errno);
      if (got == 0) throw text::InputError(fmt::format("{}: the serial line was closed", name_));
      if (reader_.take(byte)) return {reader_.message(), reader_.message() + reader_.size()};
    }
  }

  int line_ = -1;
  std::chrono::milliseconds wait_;
  std::string name_;
  FrameReader reader_;
};

}  // namespace

std::unique_ptr<Transport> open_serial_transport(const BoardUrl& url, std::chrono::milliseconds wait) {
  return std::make_unique<SerialTransport>(url, wait);
}

}  // namespace vernier::upload
