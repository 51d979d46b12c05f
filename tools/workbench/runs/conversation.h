// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace vernier::workbench {

/// One message between two processes: a list of texts.
using Message = std::vector<std::string>;

/// Reads the next message of a stream. Returns false in three cases: the stream ended; `patience_s` passed
/// without a byte (0: waits for ever); more bytes came than a message can have.
bool read_message(int stream, double patience_s, Message& message);
/// Writes a message; false if the other process does not read the message.
bool write_message(int stream, double patience_s, const Message& message);

/// A program that answers messages one by one; its standard input and output are one stream. The program has
/// a separate process group and ends together with this object.
class Conversation {
 public:
  /// Throws InputError if the program cannot be started.
  Conversation(const std::string& program, const std::vector<std::string>& arguments,
               const std::string& directory);
  /// Ends the program immediately.
  ~Conversation();
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;

  /// Sends a question and reads the answer. False if the program ended, or gave no answer for patience_s: the
  /// Conversation cannot be used any more.
  bool ask(const Message& question, double patience_s, Message& answer);
  /// Ends the program and reports how it had ended: "exit status 70", "signal 11", or "no answer" if it was
  /// still running.
  std::string end();

 private:
  pid_t child_ = -1;
  int stream_ = -1;
};

}  // namespace vernier::workbench
