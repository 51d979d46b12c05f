// SPDX-License-Identifier: GPL-3.0-or-later
// Loaded before the C library: every fsync takes so many milliseconds as the file VERNIER_SLOW_FSYNC says.
#include <fcntl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <cstdlib>

extern "C" int fsync(int fd) {
  char text[16] = {};
  const char* const path = std::getenv("VERNIER_SLOW_FSYNC");
  const int file = path != nullptr ? ::open(path, O_RDONLY | O_CLOEXEC) : -1;
  if (file >= 0 && ::read(file, text, sizeof(text) - 1) < 0) text[0] = 0;
  if (file >= 0) ::close(file);
  const long ms = std::atol(text);
  const timespec wait{ms / 1000, ms % 1000 * 1'000'000};
  ::nanosleep(&wait, nullptr);
  return static_cast<int>(::syscall(SYS_fsync, fd));
}
