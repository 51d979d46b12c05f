// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/toml_text.h"

#include <algorithm>
#include <cstddef>

#include "firmware/daemon/settings/key_file.h"

namespace vernier {
namespace {

constexpr std::size_t kLongestWord = 24;

bool beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }

/// The text around a position, up to blanks.
std::string word_at(const std::string& text, std::size_t at) {
  const std::size_t before = text.find_last_of(" \t\r\n", at), end = text.find_first_of(" \t\r\n", at);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(begin, (end == std::string::npos ? text.size() : end) - begin).substr(0, kLongestWord);
}

/// Position after the string whose quote is at `at`, or its first letter that is not allowed there.
std::size_t skip_string(const std::string& text, std::size_t at) {
  const char quote = text[at++];
  const std::string three(2, quote);
  if (text.compare(at, 2, three) == 0) {
    // Of several lines: ASCII only.
    at += 2;
    while (at < text.size() && !beyond_ascii(text[at])) {
      if (text[at] == '\\' && quote == '"')
        ++at;
      else if (text[at] == quote && text.compare(at + 1, 2, three) == 0)
        return at + 3;
      if (at < text.size() && !beyond_ascii(text[at])) ++at;
    }
    return at;
  }
  while (at < text.size() && text[at] != quote && text[at] != '\n') {
    if (text[at] == '\\' && quote == '"' && ++at < text.size() && beyond_ascii(text[at])) return at;
    if (at < text.size()) ++at;
  }
  return at < text.size() && text[at] == quote ? at + 1 : at;
}

}  // namespace

void refuse_letters_outside_strings(const std::string& text, const std::string& path) {
  std::size_t line = 1;
  for (std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; at < text.size();) {
    const std::size_t begun = at;
    if (text[at] == '#')
      at = std::min(text.find('\n', at), text.size());
    else if (text[at] == '"' || text[at] == '\'')
      at = skip_string(text, at);
    else if (!beyond_ascii(text[at]))
      ++at;
    for (std::size_t i = begun; i < at; ++i) line += text[i] == '\n' ? 1 : 0;
    if (at < text.size() && beyond_ascii(text[at]))
      throw BoardError{path + ":" + std::to_string(line) + ": \"" + word_at(text, at) +
                       "\": letters beyond ASCII must be in quotes, on one line"};
  }
}

}  // namespace vernier
