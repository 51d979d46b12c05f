// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <sys/types.h>

#include <chrono>
#include <string>

namespace vernier::registry {

/// Replaces {machine} in a command by the name, as one word of a shell with any characters. tool.
std::string command_for(const std::string& command, const std::string& machine);

/// A running shell command in a separate process group. It ends together with the process that started it.
/// Its output is read, and the last line of the output is kept. tool.
class ShellCommand {
 public:
  /// Throws InputError if no process can be started.
  explicit ShellCommand(const std::string& command);
  ~ShellCommand() { end(); }
  ShellCommand(const ShellCommand&) = delete;
  ShellCommand& operator=(const ShellCommand&) = delete;

  /// Waits; true once it has ended.
  bool wait(std::chrono::milliseconds patience);
  bool ended() const { return pid_ == 0; }
  /// Exit status, or 128 + the signal that ended it.
  int status() const { return status_; }
  /// The last line of its output that is not empty, 400 letters at most.
  std::string last_line() const;
  /// Ends it, and all that it started, immediately.
  void end();

 private:
  void read();
  pid_t pid_ = 0;
  int output_ = -1, status_ = 0;
  std::string tail_;
};

}  // namespace vernier::registry
