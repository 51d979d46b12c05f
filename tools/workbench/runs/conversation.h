// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace vernier::workbench {

/// One message between two processes: a list of texts.
using Message = std::vector<std::string>;

/// Reads the next message of a stream; returns true if a message was read. Returns false in three cases: the
/// stream ended; no byte came for `patience_s` (0: no time limit); the message is longer than the maximum.
bool read_message(int stream, double patience_s, Message& message);
/// Writes a message to a stream. Returns false if the other process does not read the message within
/// `patience_s`.
bool write_message(int stream, double patience_s, const Message& message);

/// A running program that answers messages one by one. Standard input and output of the program are one
/// stream. The program has its own process group and ends when the Conversation object is destroyed.
class Conversation {
 public:
  /// Throws InputError if the program could not be started.
  Conversation(const std::string& program, const std::vector<std::string>& arguments,
               const std::string& directory);
  /// The destructor ends the program immediately.
  ~Conversation();
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;

  /// Sends a question to the program and reads the answer. Returns false if the program ended or gave no
  /// answer for `patience_s`. After a failed question, the Conversation cannot be used any more.
  bool ask(const Message& question, double patience_s, Message& answer);
  /// Ends the program and returns how it ended: "exit status 70", "signal 11", or "no answer" if it was still
  /// running.
  std::string end();

 private:
  pid_t child_ = -1;
  int stream_ = -1;
};

}  // namespace vernier::workbench
