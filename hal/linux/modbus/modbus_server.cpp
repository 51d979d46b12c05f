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
#include <tuple>

namespace vernier {
namespace {

// Places of unsigned clients for as long as they ask, and further places, in which a client without a valid
// signature stays only until the next one waits. A further client thus always gets a place to sign in.
constexpr std::size_t kOrdinaryPlaces = 16, kPlacesToSign = 4;
constexpr std::size_t kMostClients = kOrdinaryPlaces + kPlacesToSign;
constexpr std::size_t kMostArrivals = 32;  // that wait for a place
constexpr int kMostAccepted = 16;          // in one round
constexpr int kBacklog = 64;               // of the socket, for what comes in one round
constexpr int kRequestsInARound = 4;       // of one client, before the others have their turn
constexpr InstantNs kFrameTime(500'000'000);
constexpr InstantNs kIdle(2'000'000'000);         // a client without a request for this time may be removed
constexpr InstantNs kIntroduction(200'000'000);   // and one that is new, after that
constexpr InstantNs kTimeToSign(500'000'000);     // in a place to sign in: a command needs 50 ms on a LAN
constexpr InstantNs kSignedIdle(30'000'000'000);  // as kIdle, of a client that signed
constexpr std::size_t kUnfair = 2;  // unsigned clients more than the peer of an arrival has: one goes

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
  for (const Arrival& arrival : arrivals_) ::close(arrival.fd);
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
      ::bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0 ||
      ::listen(fd, kBacklog) != 0 || ::getsockname(fd, reinterpret_cast<sockaddr*>(&name), &length) != 0) {
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
  server->clients_.push_back({fd, ModbusConversation(layout, unit, server->frame_time_), 0, {}});
  return server;
}

std::size_t ModbusServer::places_of(std::uint32_t peer) const noexcept {
  return static_cast<std::size_t>(std::count_if(clients_.begin(), clients_.end(), [&](const Client& client) {
    return client.peer == peer && !client.talk.is_signed();
  }));
}

// A client that is being served never goes; a client that signed goes after a long pause only.
bool ModbusServer::may_go(std::size_t index, std::size_t places, InstantNs now) const noexcept {
  const Client& client = clients_[index];
  const InstantNs idle = now - client.talk.last_request();
  if (client.talk.waits_for_medium()) return false;
  if (client.talk.has_reply()) return true;
  if (client.talk.is_signed()) return idle >= kSignedIdle;
  const auto before = std::count_if(clients_.begin(), clients_.begin() + static_cast<std::ptrdiff_t>(index),
                                    [](const Client& other) { return !other.talk.is_signed(); });
  const std::size_t held = places_of(client.peer);
  const bool has_to_sign = static_cast<std::size_t>(before) >= kOrdinaryPlaces && held >= places;
  return idle >= kIdle || (has_to_sign && now - client.since >= kTimeToSign) || held >= places + kUnfair;
}

// The client that makes room for one whose peer has `places`, or kMostClients: first one that does not take
// its reply, then one of the peer with the most unsigned clients, then the one that was idle longest.
std::size_t ModbusServer::first_to_go(std::size_t places, InstantNs now) const noexcept {
  const auto rank = [&](const Client& client) {
    const std::size_t held = client.talk.is_signed() ? 0 : places_of(client.peer);
    return std::tuple(!client.talk.has_reply(), kMostClients - held, client.talk.last_request());
  };
  std::size_t first = kMostClients;
  for (std::size_t i = 0; i < clients_.size(); ++i)
    if (may_go(i, places, now) && (first == kMostClients || rank(clients_[i]) < rank(clients_[first])))
      first = i;
  return first;
}

void ModbusServer::remove(std::size_t client, CommandHandler& handler) noexcept {
  handler.ends(clients_[client].talk.connection());
  ::close(clients_[client].fd);
  clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(client));
}

// An arrival waits for a place. If too many wait, one of the peer with the most of them is closed.
void ModbusServer::accept_arrivals() {
  for (int i = 0; i < kMostAccepted; ++i) {
    sockaddr_in name{};
    socklen_t length = sizeof(name);
    const int fd =
        ::accept4(listening_, reinterpret_cast<sockaddr*>(&name), &length, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd < 0) return;
    arrivals_.push_back({fd, name.sin_addr.s_addr});
    if (arrivals_.size() <= kMostArrivals) continue;
    const auto waiting = [&](const Arrival& one) {
      return std::count_if(arrivals_.begin(), arrivals_.end(),
                           [&](const Arrival& other) { return other.peer == one.peer; });
    };
    const auto most = std::max_element(arrivals_.begin(), arrivals_.end(),
                                       [&](const auto& a, const auto& b) { return waiting(a) < waiting(b); });
    ::close(most->fd);
    arrivals_.erase(most);
  }
}

// The arrival whose peer has the fewest clients comes in first.
void ModbusServer::admit_arrivals(CommandHandler& handler, InstantNs now) {
  while (!arrivals_.empty()) {
    const auto next = std::min_element(
        arrivals_.begin(), arrivals_.end(),
        [&](const Arrival& a, const Arrival& b) { return places_of(a.peer) < places_of(b.peer); });
    if (clients_.size() >= kMostClients) {
      const std::size_t first = first_to_go(places_of(next->peer), now);
      if (first == kMostClients) return;
      remove(first, handler);
    }
    const int yes = 1;
    // A small buffer, so that a peer that does not take its replies shows soon.
    const int buffer = 4096;
    ::setsockopt(next->fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
    ::setsockopt(next->fd, SOL_SOCKET, SO_SNDBUF, &buffer, sizeof(buffer));
    clients_.push_back({next->fd, ModbusConversation(layout_, unit_, frame_time_), next->peer, now});
    clients_.back().talk.begin(now - kIdle + kIntroduction, ++connections_);
    arrivals_.erase(next);
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
  if (listening_ >= 0 && room > 0) handles[count++] = listening_;
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
  if (listening_ >= 0) {
    accept_arrivals();
    admit_arrivals(handler, now);
  }
  return HalFault::kNone;
}

}  // namespace vernier
