// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// A lock (flock(2)) on a file or directory. A process has the lock until it closes the file descriptor or
/// ends.
class FileLock {
 public:
  /// Locks the existing file or directory `path`. Returns an empty text, or the reason of a failure: "in use
  /// by another process". Not real-time safe.
  std::string take(const std::string& path);
  FileLock() = default;
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int fd_ = -1;
};

/// Locks an open file descriptor. Returns false if another process has the lock. Not real-time safe.
bool lock_descriptor(int fd) noexcept;

}  // namespace vernier
