// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/error.h"

#include "tools/text/words.h"

namespace vernier::text {
namespace {

std::string message(const Place& place, const std::string& word, const std::string& what) {
  std::string text = place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (!text.empty()) text += ": ";
  if (!word.empty()) text += "\"" + quotable(word) + "\": ";
  return utf8_only(text + what);
}

}  // namespace

InputError::InputError(const std::string& what) : std::runtime_error(utf8_only(what)) {}

InputError::InputError(const Place& place, const std::string& word, const std::string& what)
    : std::runtime_error(message(place, word, what)) {}

}  // namespace vernier::text
