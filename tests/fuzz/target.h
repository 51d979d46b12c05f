// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace vernier::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// A reader of something that comes from outside. `take` is given any bytes; it returns, or throws what is
/// not to happen: an error that names no place, a promise that does not hold.
struct Target {
  const char* name;
  void (*take)(Bytes bytes);
};

/// Those of this program: a source in targets/ holds one.
std::vector<Target>& targets();
struct Registered {
  Registered(const char* name, void (*take)(Bytes)) { targets().push_back({name, take}); }
};

inline std::string text_of(Bytes bytes) {
  return bytes.empty() ? std::string()
                       : std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}
inline void expect(bool holds, const char* promise) {
  if (!holds) throw std::logic_error(promise);
}
/// A refusal names the file, or is about no file at all.
inline void expect_place(const std::string& message, const std::string& file) {
  if (message.find(file) == std::string::npos) throw std::logic_error("names no file: " + message);
}

/// Bytes as a file, for readers that open one.
class MemoryFile {
 public:
  explicit MemoryFile(Bytes bytes);
  ~MemoryFile() { ::close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// Pieces of an input that is several messages: a length byte before each.
class Pieces {
 public:
  explicit Pieces(Bytes bytes) : rest_(bytes) {}
  bool next(Bytes& piece) {
    if (rest_.empty()) return false;
    const std::size_t size = std::min<std::size_t>(rest_[0], rest_.size() - 1);
    piece = rest_.subspan(1, size);
    rest_ = rest_.subspan(1 + size);
    return true;
  }
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t first = rest_[0];
    rest_ = rest_.subspan(1);
    return first;
  }

 private:
  Bytes rest_;
};

}  // namespace vernier::fuzz
