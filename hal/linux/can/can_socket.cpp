// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/can_socket.h"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vernier {
namespace {

std::vector<can_filter> filters_of(const std::vector<std::uint32_t>& ids) {
  std::vector<can_filter> filters;
  for (const std::uint32_t id : ids)
    filters.push_back({can_identifier(id), CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_EFF_MASK});
  return filters;
}

bool is_local(const std::string& interface) { return interface.find('/') != std::string::npos; }

/// A program in the place of a bus: it gets the filters first, then keeps frames apart as the kernel does.
int open_local(const std::string& path, const std::vector<std::uint32_t>& ids, std::string& error) {
  const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) errno = ENAMETOOLONG;
  if (fd < 0 || path.size() >= sizeof address.sun_path)
    return can_failed(path, "cannot be a local socket", fd, error);
  path.copy(address.sun_path, path.size());
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return can_failed(path, "no program answers", fd, error);
  const std::vector<can_filter> filters = filters_of(ids);
  const std::size_t bytes = filters.size() * sizeof(can_filter);
  if (::send(fd, filters.data(), bytes, MSG_NOSIGNAL) != static_cast<ssize_t>(bytes))
    return can_failed(path, "the CAN interface does not accept filters", fd, error);
  return fd;
}

bool subscribe(int socket, const std::vector<std::uint32_t>& ids, bool bus_errors) {
  const std::vector<can_filter> filters = filters_of(ids);
  if (::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                   static_cast<socklen_t>(filters.size() * sizeof(can_filter))) != 0)
    return false;
  const can_err_mask_t errors = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;
  return !bus_errors || ::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof(errors)) == 0;
}

}  // namespace

canid_t can_identifier(std::uint32_t id) noexcept { return id > CAN_SFF_MASK ? (id | CAN_EFF_FLAG) : id; }

int can_failed(const std::string& interface, const char* what, int socket, std::string& error) {
  error = interface + ": " + what + ": " + std::strerror(errno);
  if (socket >= 0) ::close(socket);
  return -1;
}

bool bind_can(int socket, const std::string& interface, sockaddr_can address, std::string& error) {
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) return can_failed(interface, "no such interface", socket, error) >= 0;
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return true;
  return can_failed(interface, "cannot be used", socket, error) >= 0;
}

bool hear_own_frames(int socket, const std::string& interface, std::string& error) {
  const int on = 1;
  if (is_local(interface) || ::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &on, sizeof(on)) == 0)
    return true;
  return can_failed(interface, "the interface does not return the frames that the board sends", socket,
                    error) >= 0;
}

int open_can(const std::string& interface, const std::vector<std::uint32_t>& ids, bool bus_errors,
             std::string& error) {
  if (is_local(interface)) return open_local(interface, ids, error);
  const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (fd < 0) return can_failed(interface, "this kernel does not support CAN", fd, error);
  if (!subscribe(fd, ids, bus_errors))
    return can_failed(interface, "the interface refuses the filters", fd, error);
  return bind_can(fd, interface, sockaddr_can{}, error) ? fd : -1;
}

}  // namespace vernier
