// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/service_manager.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace vernier {

ServiceManager::ServiceManager() noexcept {
  const char* const path = std::getenv("NOTIFY_SOCKET");
  asked_ = path != nullptr;
  if (!asked_) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t length = std::strlen(path);
  if (length == 0 || length >= sizeof(address.sun_path)) return;
  std::memcpy(address.sun_path, path, length);
  // A name that begins with @ lives in the abstract namespace, whose names begin with a zero byte.
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';
  fd_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length);
  if (fd_ < 0 || ::connect(fd_, reinterpret_cast<const sockaddr*>(&address), size) == 0) return;
  ::close(fd_);
  fd_ = -1;
}

ServiceManager::~ServiceManager() {
  if (fd_ >= 0) ::close(fd_);
}

bool ServiceManager::notify(const char* state) noexcept {
  if (!asked_) return true;
  const std::size_t size = std::strlen(state);
  return fd_ >= 0 && ::send(fd_, state, size, MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(size);
}

}  // namespace vernier
