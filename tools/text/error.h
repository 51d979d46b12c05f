// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>

namespace vernier::text {

/// Position in an input file: the file and the line. `line` is counted from 1; 0 means the whole file.
struct Place {
  std::string file;
  std::size_t line = 0;
};

/// Exception for invalid input of the user. The message contains the file, the line and the wrong word. A
/// command that throws InputError ends with exit status 1. The message is valid UTF-8. Other bytes of the
/// input are replaced by "?". The message has the form `machine.xml:12: "alhpa": unknown name`.
class InputError : public std::runtime_error {
 public:
  InputError(const Place& place, const std::string& word, const std::string& what);
  explicit InputError(const std::string& what);
};

/// Exception: the command was executed, but its result does not meet a limit of the user. A command that
/// throws LimitNotMet ends with exit status 2.
class LimitNotMet : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace vernier::text
