// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/words.h"

#include <algorithm>
#include <cstdint>

namespace vernier::text {
namespace {

struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 0;  // 0: not UTF-8
};

// The first code point of a text that is not empty (RFC 3629, section 4).
CodePoint first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<std::uint8_t>(text[i]));
  };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xc2 && lead < 0xe0 ? 2 : lead >= 0xe0 && lead < 0xf0 ? 3 : 4;
  if (lead < 0xc2 || lead > 0xf4 || bytes > text.size()) return {};
  std::uint32_t value = lead & (0x7fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    value = value << 6 | (byte(i) & 0x3f);
  }
  const bool shortest = value >= (bytes == 3 ? 0x800u : bytes == 4 ? 0x10000u : 0x80u);
  const bool surrogate = value >= 0xd800 && value < 0xe000;
  return shortest && !surrogate && value < 0x110000 ? CodePoint{value, bytes} : CodePoint{};
}

// Characters without a width and without a meaning in a table: soft hyphen, zero width space, non-joiner and
// joiner, marks of the writing direction, word joiner, byte order mark.
bool is_invisible(std::uint32_t point) {
  return point == 0xad || (point >= 0x200b && point <= 0x200f) || point == 0x2060 || point == 0xfeff;
}

/// Blanks of typesetting: no-break, figure, thin and narrow no-break.
bool is_typeset_blank(std::uint32_t point) {
  return point == 0xa0 || point == 0x2007 || point == 0x2009 || point == 0x202f;
}

// Control characters C0 and C1, line and paragraph separators, marks of the writing direction, and characters
// that cannot be seen.
bool is_control(std::uint32_t point) {
  return point < 0x20 || (point >= 0x7f && point < 0xa0) || point == 0x61c || point == 0x200e ||
         point == 0x200f || (point >= 0x2028 && point <= 0x202e) || (point >= 0x2066 && point <= 0x2069) ||
         is_invisible(point);
}

/// Returns the text with "?" in place of each byte that is not UTF-8; without_controls: and of each control
/// character.
std::string with_question_marks(std::string_view text, bool without_controls) {
  std::string shown;
  while (!text.empty()) {
    const CodePoint point = first_of(text);
    if (point.bytes == 0 || (without_controls && is_control(point.value)))
      shown += '?';
    else
      shown += text.substr(0, point.bytes);
    text.remove_prefix(std::max<std::size_t>(point.bytes, 1));
  }
  return shown;
}

}  // namespace

void replace_all(std::string& text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

std::string without_invisible(std::string_view text) {
  std::string seen;
  while (!text.empty()) {
    const CodePoint point = first_of(text);
    const std::size_t bytes = std::max<std::size_t>(point.bytes, 1);
    if (point.bytes == 0 || !is_invisible(point.value)) seen += text.substr(0, bytes);
    text.remove_prefix(bytes);
  }
  return seen;
}

std::string with_plain_blanks(std::string_view text) {
  std::string plain;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  while (!text.empty()) {
    const CodePoint point = first_of(text);
    const std::size_t bytes = std::max<std::size_t>(point.bytes, 1);
    const bool in_number =
        !plain.empty() && is_digit(plain.back()) && bytes < text.size() && is_digit(text[bytes]);
    if (point.bytes > 0 && is_typeset_blank(point.value) && !in_number)
      plain += ' ';
    else
      plain += text.substr(0, bytes);
    text.remove_prefix(bytes);
  }
  return plain;
}

std::string printable(std::string_view text) { return with_question_marks(text, true); }

std::string utf8_only(std::string_view text) { return with_question_marks(text, false); }

namespace {

/// At most `most` bytes of the text, whole characters, and the size of the rest.
std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return printable(text);
  std::size_t end = most;
  constexpr int kKind = 0xc0, kFollows = 0x80;  // bits of a byte in the middle of a character
  while (end > 0 && (static_cast<unsigned char>(text[end]) & kKind) == kFollows) --end;
  return printable(text.substr(0, end)) + "... (" + std::to_string(text.size() - end) + " more bytes)";
}

}  // namespace

std::string quotable(std::string_view word) { return shortened(word, kMostQuotedBytes); }

std::string shown_message(std::string_view message) {
  std::string shown;
  for (bool more = true; more;) {
    const std::size_t end = message.find('\n');
    shown += shortened(message.substr(0, end), kMostMessageBytes);
    more = end != std::string_view::npos;
    if (more) shown += '\n', message.remove_prefix(end + 1);
  }
  return shown;
}

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (std::size_t at = 0; at < small.size(); ++at) {
    if (small[at] >= 'A' && small[at] <= 'Z') small[at] = static_cast<char>(small[at] - 'A' + 'a');
    // UTF-8 has the letters À to Þ as C3 80 to C3 9E, and the small ones 20 above them; C3 97 is ×.
    const auto one = static_cast<unsigned char>(small[at]);
    const bool accented = at > 0 && static_cast<unsigned char>(small[at - 1]) == 0xC3;
    if (accented && one >= 0x80 && one <= 0x9E && one != 0x97) small[at] = static_cast<char>(one + 0x20);
  }
  return small;
}

std::vector<std::string> words_in(std::string_view text, std::string_view separators) {
  std::vector<std::string> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(separators, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) {
    if (&word != words.data()) text += separator;
    text += word;
  }
  return text;
}

bool nests_deeper_than(std::string_view json, std::size_t most) {
  std::size_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > most) return true;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return false;
}

}  // namespace vernier::text
