// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>

namespace vernier::text {

/// Functions that files.h calls for every file that this process reads or writes.
struct FileHooks {
  std::function<void(const std::string& path, const std::string& text)> read;  // called after a file was read
                                                                               // successfully
  /// Returns the text that write_file writes instead of `text`.
  std::function<std::string(const std::string& path, const std::string& text)> write;
};

/// Sets the file hooks of this process. If no hooks are set, files are read and written without change. Do
/// not call set_file_hooks while another thread reads or writes files.
void set_file_hooks(FileHooks hooks);

}  // namespace vernier::text
