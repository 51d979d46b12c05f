// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vernier {

bool lock_descriptor(int fd) noexcept { return ::flock(fd, LOCK_EX | LOCK_NB) == 0; }

std::string FileLock::take(const std::string& path) {
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd_ < 0) return std::strerror(errno);
  if (lock_descriptor(fd_)) return "";
  return errno == EWOULDBLOCK ? "in use by another process" : std::strerror(errno);
}

FileLock::~FileLock() {
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace vernier
