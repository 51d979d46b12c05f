// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/isotp_link.h"

#include <linux/can.h>
#include <linux/can/isotp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "hal/linux/can/can_socket.h"

namespace vernier {
namespace {

constexpr std::uint32_t kMostBytes = 4095;  // of a message with a 12-bit length

}  // namespace

std::unique_ptr<IsotpLink> IsotpLink::open(const std::string& interface, std::uint32_t receive,
                                           std::uint32_t transmit, std::string& error) {
  const int fd = ::socket(PF_CAN, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_ISOTP);
  if (fd < 0) {
    can_failed(interface, "this kernel does not support ISO-TP", fd, error);
    return nullptr;
  }
  sockaddr_can address{};
  address.can_addr.tp.rx_id = can_identifier(receive);
  address.can_addr.tp.tx_id = can_identifier(transmit);
  if (!bind_can(fd, interface, address, error)) return nullptr;
  return std::unique_ptr<IsotpLink>(new IsotpLink(fd));
}

IsotpLink::~IsotpLink() { ::close(fd_); }

// A peer that does not take its reply gets no further one: the kernel refuses the next reply until it has
// given up the first one.
HalFault IsotpLink::send(const std::uint8_t* reply, std::uint32_t size) noexcept {
  if (size == 0 || ::write(fd_, reply, size) >= 0) return HalFault::kNone;
  return errno == EAGAIN || errno == EWOULDBLOCK ? HalFault::kNone : HalFault::kRefused;
}

HalFault IsotpLink::serve(CommandHandler& handler, TimeUs wait) noexcept {
  std::uint8_t request[kMostBytes], reply[256];
  if (waits_for_reply_) {
    const std::uint32_t answered = handler.later(ticket_, reply);
    if (answered == CommandHandler::kLater) return HalFault::kNone;
    waits_for_reply_ = false;
    return send(reply, answered);
  }
  pollfd waiting{fd_, POLLIN, 0};
  const int ready = ::poll(&waiting, 1, static_cast<int>(wait.count / 1000));
  if (ready <= 0) return ready == 0 || errno == EINTR ? HalFault::kNone : HalFault::kRefused;
  const ssize_t size = ::read(fd_, request, sizeof(request));
  // A peer that stopped in the middle of a message shows as an error of the socket and is forgotten with it.
  if (size < 0) return errno == ENETDOWN || errno == ENODEV ? HalFault::kRefused : HalFault::kNone;
  const std::uint32_t answered = handler.answer(request, static_cast<std::uint32_t>(size), reply);
  waits_for_reply_ = answered == CommandHandler::kLater;
  if (!waits_for_reply_) return send(reply, answered);
  ticket_ = handler.ticket();
  return HalFault::kNone;
}

int IsotpLink::ask(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply, std::uint32_t room,
                   TimeUs wait) noexcept {
  if (::write(fd_, request, size) != static_cast<ssize_t>(size)) return -1;
  pollfd waiting{fd_, POLLIN, 0};
  const int ready = ::poll(&waiting, 1, static_cast<int>(wait.count / 1000));
  if (ready == 0) errno = ETIMEDOUT;
  return ready > 0 ? static_cast<int>(::read(fd_, reply, room)) : -1;
}

}  // namespace vernier
