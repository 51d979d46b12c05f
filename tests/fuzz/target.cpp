// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/target.h"

#include <sys/mman.h>

namespace vernier::fuzz {

std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

MemoryFile::MemoryFile(Bytes bytes) : fd_(::memfd_create("input", MFD_CLOEXEC)) {
  if (fd_ < 0 || ::write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("no file in memory");
}

}  // namespace vernier::fuzz
