// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace vernier::workbench {

/// Texts as one message between two processes.
using Message = std::vector<std::string>;

/// The next message of a stream. False at its end, after `patience_s` without a byte (0: waits for ever), and
/// if more bytes come than a message can have. tool.
bool read_message(int stream, double patience_s, Message& message);
/// False if the other end does not take it. tool.
bool write_message(int stream, double patience_s, const Message& message);

/// A program that answers messages one by one on its standard input and output, which are one stream. It has
/// its own process group and ends together with this object. tool.
class Conversation {
 public:
  /// Throws InputError if it cannot be started.
  Conversation(const std::string& program, const std::vector<std::string>& arguments,
               const std::string& directory);
  /// Ends it immediately.
  ~Conversation();
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;

  /// False if it ended, or gave no answer for patience_s: it cannot be used any more.
  bool ask(const Message& question, double patience_s, Message& answer);
  /// Ends it and reports how it had ended: "exit status 70", "signal 11", or "no answer" if it was still
  /// running.
  std::string end();

 private:
  pid_t child_ = -1;
  int stream_ = -1;
};

}  // namespace vernier::workbench
