// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/modbus/modbus_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace vernier {
namespace {

constexpr std::size_t kMostClients = 16;
constexpr int kMostAccepted = 16;     // in one round
constexpr int kRequestsInARound = 4;  // of one client, before the others have their turn
constexpr InstantNs kFrameTime(500'000'000);
constexpr InstantNs kIdle(2'000'000'000);        // a client without a request for this time may be removed
constexpr InstantNs kIntroduction(200'000'000);  // and one that is new, after that

InstantNs now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return InstantNs(std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec);
}

std::string last_error(const std::string& what) { return what + ": " + modbus_strerror(errno); }

}  // namespace

ModbusServer::~ModbusServer() {
  if (listening_ >= 0) ::close(listening_);
  if (line_ != nullptr) {
    modbus_close(line_);
    modbus_free(line_);
    return;
  }
  for (const Client& client : clients_) ::close(client.fd);
}

std::unique_ptr<ModbusServer> ModbusServer::tcp(const std::string& address, int port,
                                                const ModbusLayout& layout, std::string& error) {
  in_addr numeric{};
  if (inet_pton(AF_INET, address.c_str(), &numeric) != 1) {
    error = address + ": not a numeric address";
    return nullptr;
  }
  // libmodbus takes port 0 for the standard one, so it is bound here.
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int yes = 1;
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr = numeric;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t length = sizeof(name);
  if (fd < 0 || ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) != 0 ||
      ::bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0 || ::listen(fd, 4) != 0 ||
      ::getsockname(fd, reinterpret_cast<sockaddr*>(&name), &length) != 0) {
    error = last_error(address + ":" + std::to_string(port));
    if (fd >= 0) ::close(fd);
    return nullptr;
  }
  std::unique_ptr<ModbusServer> server(new ModbusServer(layout, 0, kFrameTime));
  server->listening_ = fd;
  server->port_ = ntohs(name.sin_port);
  return server;
}

std::unique_ptr<ModbusServer> ModbusServer::rtu(const std::string& device, int baud, char parity, int unit,
                                                const ModbusLayout& layout, std::string& error) {
  modbus_t* const context = modbus_new_rtu(device.c_str(), baud, parity, 8, 1);
  if (context == nullptr || modbus_set_slave(context, unit) != 0 || modbus_connect(context) != 0) {
    error = last_error(device);
    if (context != nullptr) modbus_free(context);
    return nullptr;
  }
  // Eleven bits per byte, and half a second for a user who types.
  const std::int64_t longest = 11'000'000'000 * ModbusConversation::kMostFrame / std::max(baud, 1);
  std::unique_ptr<ModbusServer> server(new ModbusServer(layout, unit, kFrameTime + InstantNs(longest)));
  server->line_ = context;
  const int fd = modbus_get_socket(context);
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
  server->clients_.push_back({fd, ModbusConversation(layout, unit, server->frame_time_)});
  return server;
}

// First a client that does not take its reply is removed, then the client that was idle longest; never a
// client that is being served. A tool that ended without closing, or many idle clients, therefore cannot
// block a working one.
std::vector<ModbusServer::Client>::const_iterator ModbusServer::first_to_go() const noexcept {
  return std::min_element(clients_.begin(), clients_.end(),
                          [](const Client& a, const Client& b) { return a.talk.worth() < b.talk.worth(); });
}

// If no client can be removed now, a new client waits in the queue of the socket. It is not refused, because
// an inactive client is removed soon.
bool ModbusServer::has_room(InstantNs now) const noexcept {
  return clients_.size() < kMostClients || first_to_go()->talk.worth() <= (now - kIdle).count;
}

void ModbusServer::remove(std::size_t client, CommandHandler& handler) noexcept {
  handler.ends(clients_[client].talk.connection());
  ::close(clients_[client].fd);
  clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(client));
}

void ModbusServer::accept_clients(CommandHandler& handler, InstantNs now) {
  for (int i = 0; i < kMostAccepted && has_room(now); ++i) {
    const int fd = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd < 0) return;
    const int yes = 1;
    // A small buffer, so that a peer that does not take its replies shows soon.
    const int buffer = 4096;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
    ::setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &buffer, sizeof(buffer));
    if (clients_.size() >= kMostClients)
      remove(static_cast<std::size_t>(first_to_go() - clients_.begin()), handler);
    clients_.push_back({fd, ModbusConversation(layout_, unit_, frame_time_)});
    clients_.back().talk.begin(now - kIdle + kIntroduction, ++connections_);
  }
}

// False: the connection is at its end.
bool ModbusServer::receive(Client& client, InstantNs now) noexcept {
  if (client.talk.room() == 0) return true;
  const ssize_t got = ::read(client.fd, client.talk.space(), client.talk.room());
  if (got > 0) client.talk.took(static_cast<std::uint32_t>(got), now);
  if (got == 0) return line_ != nullptr;
  return got > 0 || errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

bool ModbusServer::send(Client& client) noexcept {
  if (client.talk.waiting() == 0) return true;
  const ssize_t put = line_ != nullptr
                          ? ::write(client.fd, client.talk.out(), client.talk.waiting())
                          : ::send(client.fd, client.talk.out(), client.talk.waiting(), MSG_NOSIGNAL);
  if (put > 0) client.talk.sent(static_cast<std::uint32_t>(put));
  return put > 0 || errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

bool ModbusServer::serve_client(Client& client, CommandHandler& handler, InstantNs now) noexcept {
  bool alive = true;
  for (int i = 0; alive && i < kRequestsInARound; ++i) {
    alive = receive(client, now);
    client.talk.work(handler, now);
    if (client.talk.waiting() == 0) break;
    alive = send(client) && alive;
  }
  return alive && !client.talk.broken(now);
}

std::uint32_t ModbusServer::handles(int* handles, std::uint32_t room) const noexcept {
  std::uint32_t count = 0;
  if (listening_ >= 0 && room > 0 && has_room(now_ns())) handles[count++] = listening_;
  // A client that is not listened to wakes no thread.
  for (const Client& client : clients_)
    if (count < room && client.talk.room() > 0) handles[count++] = client.fd;
  return count;
}

HalFault ModbusServer::serve(CommandHandler& handler, TimeUs wait) noexcept {
  pollfd waiting[kMostClients + 1];
  int fds[kMostClients + 1];
  const std::uint32_t count = handles(fds, kMostClients + 1);
  for (std::uint32_t i = 0; i < count; ++i) waiting[i] = {fds[i], POLLIN, 0};
  if (wait.count > 0 && ::poll(waiting, count, static_cast<int>(wait.count / 1000)) < 0)
    return errno == EINTR ? HalFault::kNone : HalFault::kRefused;
  const InstantNs now = now_ns();
  for (std::size_t i = clients_.size(); i-- > 0;) {
    if (!serve_client(clients_[i], handler, now) && line_ == nullptr) remove(i, handler);
  }
  if (listening_ >= 0) accept_clients(handler, now);
  return HalFault::kNone;
}

}  // namespace vernier
