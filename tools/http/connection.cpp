// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/http/connection.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>
#include <system_error>

namespace vernier::http {
namespace {

constexpr std::size_t kPiece = 16384;  // bytes of one read

using NameOf = int (*)(int, sockaddr*, socklen_t*);

void address_of(int fd, NameOf name_of, std::string& ip, int& port) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (name_of(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return;
  char text[INET6_ADDRSTRLEN] = "";
  if (address.ss_family == AF_INET) {
    const auto& four = reinterpret_cast<const sockaddr_in&>(address);
    ::inet_ntop(AF_INET, &four.sin_addr, text, sizeof text);
    port = ntohs(four.sin_port);
  } else if (address.ss_family == AF_INET6) {
    const auto& six = reinterpret_cast<const sockaddr_in6&>(address);
    ::inet_ntop(AF_INET6, &six.sin6_addr, text, sizeof text);
    port = ntohs(six.sin6_port);
  }
  ip = text;
}

/// Content-Length of a header (RFC 9110, 8.6); 0 without one. A number that is not valid is the library's to
/// refuse.
std::size_t stated_length(std::string_view header) {
  constexpr std::string_view kName = "\ncontent-length:";
  const auto same = [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  };
  const auto found = std::search(header.begin(), header.end(), kName.begin(), kName.end(), same);
  if (found == header.end()) return 0;
  std::string_view value = header.substr(static_cast<std::size_t>(found - header.begin()) + kName.size());
  value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), length);
  return error == std::errc() ? length : 0;
}

bool try_later() { return errno == EAGAIN || errno == EINTR; }

}  // namespace

Connection::Connection(int socket) : fd(socket) {
  int port = 0;
  address_of(fd, ::getpeername, peer, port);
}

Connection::~Connection() {
  ::shutdown(fd, SHUT_RDWR);
  ::close(fd);
}

bool Connection::has_header() {
  if (header_bytes > 0) return true;
  const std::size_t end = bytes.find("\r\n\r\n");
  if (end == std::string::npos) return false;
  header_bytes = end + 4;
  body_bytes = stated_length(std::string_view(bytes).substr(0, header_bytes));
  return true;
}

bool Connection::has_request(std::size_t most_body) {
  return has_header() && (body_bytes > most_body || bytes.size() - header_bytes >= body_bytes);
}

bool Connection::take_bytes() {
  char piece[kPiece];
  const ssize_t count = ::recv(fd, piece, sizeof piece, MSG_DONTWAIT);
  if (count < 0) return try_later();
  bytes.append(piece, static_cast<std::size_t>(count));
  return count > 0;
}

bool RequestStream::wait(short events) const {
  const Clock::time_point until = std::min(Clock::now() + pause_, end_);
  pollfd one{connection_.fd, events, 0};
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    const int count = ::poll(&one, 1, static_cast<int>(left));
    if (count > 0) return (one.revents & events) != 0;
    if (count < 0 && errno != EINTR) return false;
  }
}

bool RequestStream::is_readable() const { return at_ < connection_.bytes.size() || wait(POLLIN); }
bool RequestStream::is_writable() const { return wait(POLLOUT); }

ssize_t RequestStream::read(char* bytes, std::size_t size) {
  while (at_ == connection_.bytes.size()) {
    if (!wait(POLLIN) || !connection_.take_bytes()) return 0;
  }
  const std::size_t count = std::min(size, connection_.bytes.size() - at_);
  std::memcpy(bytes, connection_.bytes.data() + at_, count);
  at_ += count;
  if (at_ == connection_.bytes.size()) {
    connection_.bytes.clear();
    at_ = 0;
  }
  return static_cast<ssize_t>(count);
}

ssize_t RequestStream::write(const char* bytes, std::size_t size) {
  for (std::size_t sent = 0; sent < size;) {
    if (!wait(POLLOUT)) return -1;
    const ssize_t count = ::send(connection_.fd, bytes + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && !try_later()) return -1;
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
  return static_cast<ssize_t>(size);
}

void RequestStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  address_of(connection_.fd, ::getpeername, ip, port);
}
void RequestStream::get_local_ip_and_port(std::string& ip, int& port) const {
  address_of(connection_.fd, ::getsockname, ip, port);
}

}  // namespace vernier::http
