// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <sys/types.h>

#include <chrono>
#include <string>

namespace vernier::registry {

/// Replaces {machine} in a command by the name, as one word of a shell; the name may have any characters.
/// tool.
std::string command_for(const std::string& command, const std::string& machine);

/// A running shell command in a separate process group. The command ends together with the process that
/// started it. The output of the command is read; its last line is kept. tool.
class ShellCommand {
 public:
  /// Throws InputError if no process can be started.
  explicit ShellCommand(const std::string& command);
  ~ShellCommand() { end(); }
  ShellCommand(const ShellCommand&) = delete;
  ShellCommand& operator=(const ShellCommand&) = delete;

  /// Waits for the end of the command; true if the command has ended.
  bool wait(std::chrono::milliseconds patience);
  bool ended() const { return pid_ == 0; }
  /// Returns the exit status, or 128 + the signal that ended the command.
  int status() const { return status_; }
  /// Returns the last line of the output that is not empty, at most 400 letters.
  std::string last_line() const;
  /// Ends the command, and all processes that it started, immediately.
  void end();

 private:
  void read();
  pid_t pid_ = 0;
  int output_ = -1, status_ = 0;
  std::string tail_;
};

}  // namespace vernier::registry
