// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>

namespace vernier::text {

/// Functions that see every file which this process reads and writes through files.h.
struct FileHooks {
  std::function<void(const std::string& path, const std::string& text)> read;  // after a successful read
  /// Returns the text that write_file writes instead of `text`.
  std::function<std::string(const std::string& path, const std::string& text)> write;
};

/// Sets the hooks of the process. A process without hooks reads and writes files as they are. Not safe while
/// another thread reads or writes.
void set_file_hooks(FileHooks hooks);

}  // namespace vernier::text
