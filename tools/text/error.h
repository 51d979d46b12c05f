// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>

namespace vernier::text {

/// Position in an input file. `line` is 1-based; 0 means the file as a whole.
struct Place {
  std::string file;
  std::size_t line = 0;
};

/// Invalid input of the user: file, line and the offending word, in one message. Commands convert an
/// InputError into exit status 1. The message is valid UTF-8: other bytes of the input become "?". Message
/// form: `machine.xml:12: "alhpa": unknown name`.
class InputError : public std::runtime_error {
 public:
  InputError(const Place& place, const std::string& word, const std::string& what);
  explicit InputError(const std::string& what);
};

/// The job was executed and its result is negative: a limit of the user is not met. Exit status 2.
class LimitNotMet : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace vernier::text
