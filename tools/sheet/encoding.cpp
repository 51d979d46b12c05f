// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/encoding.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace vernier::sheet {
namespace {

constexpr char32_t kNoLetter = 0xFFFD;

/// Windows-1252 from 0x80 to 0x9F (Unicode's table CP1252.TXT); above it equals Latin-1.
constexpr std::array<char32_t, 32> kWindows = {
    0x20AC, kNoLetter, 0x201A,    0x0192, 0x201E,    0x2026,    0x2020, 0x2021,    0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152,    kNoLetter, 0x017D, kNoLetter, kNoLetter, 0x2018, 0x2019,    0x201C, 0x201D, 0x2022,
    0x2013, 0x2014,    0x02DC,    0x2122, 0x0161,    0x203A,    0x0153, kNoLetter, 0x017E, 0x0178};

std::uint8_t byte(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

void append(std::string& text, char32_t letter) {
  const auto put = [&](char32_t value) { text += static_cast<char>(static_cast<unsigned char>(value)); };
  if (letter < 0x80) return put(letter);
  if (letter < 0x800) {
    put(0xC0 | (letter >> 6));
  } else if (letter < 0x10000) {
    put(0xE0 | (letter >> 12));
    put(0x80 | ((letter >> 6) & 0x3F));
  } else {
    put(0xF0 | (letter >> 18));
    put(0x80 | ((letter >> 12) & 0x3F));
    put(0x80 | ((letter >> 6) & 0x3F));
  }
  put(0x80 | (letter & 0x3F));
}

/// Length of the UTF-8 letter that begins at `at`; 0: no letter.
std::size_t utf8_length(std::string_view bytes, std::size_t at) {
  const std::uint8_t first = byte(bytes, at);
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xC2 ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  if (size == 0 || at + size > bytes.size()) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(bytes, at + i) & 0xC0) != 0x80) return 0;
  return size;
}

bool is_utf8(std::string_view bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t size = utf8_length(bytes, at);
    if (size == 0) return false;
    at += size;
  }
  return true;
}

std::string from_utf16(std::string_view bytes, bool big) {
  const auto unit = [&](std::size_t at) {
    const char32_t one = byte(bytes, at), two = byte(bytes, at + 1);
    return big ? one << 8 | two : two << 8 | one;
  };
  std::string text;
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
    char32_t letter = unit(at);
    if (letter == 0xFEFF) continue;
    const bool high = letter >= 0xD800 && letter < 0xDC00;
    if (high && at + 3 < bytes.size() && unit(at + 2) >= 0xDC00 && unit(at + 2) < 0xE000) {
      letter = 0x10000 + ((letter - 0xD800) << 10) + (unit(at + 2) - 0xDC00);
      at += 2;
    } else if (letter >= 0xD800 && letter < 0xE000) {
      letter = kNoLetter;
    }
    append(text, letter);
  }
  return text;
}

/// True for a line in UTF-8 with a letter that is not ASCII: two such bytes are no usual letters of
/// Windows-1252.
bool is_utf8_line(std::string_view line) {
  return is_utf8(line) && std::any_of(line.begin(), line.end(), [](char c) { return (c & 0x80) != 0; });
}

/// Calls `each` for each line, with its line end.
template <typename Each>
void for_each_line(std::string_view bytes, const Each& each) {
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = bytes.find('\n', at);
    const std::size_t next = end == std::string_view::npos ? bytes.size() : end + 1;
    each(bytes.substr(at, next - at));
    at = next;
  }
}

std::string from_windows(std::string_view bytes) {
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const std::uint8_t one = byte(bytes, at);
    append(text, one >= 0x80 && one < 0xA0 ? kWindows[one - 0x80u] : one);
  }
  return text;
}

}  // namespace

const char* encoding_name(Encoding encoding) {
  switch (encoding) {
    case Encoding::kUtf8:
      return "UTF-8";
    case Encoding::kUtf8Bom:
      return "UTF-8 with byte order mark";
    case Encoding::kUtf16Le:
      return "UTF-16 (little endian)";
    case Encoding::kUtf16Be:
      return "UTF-16 (big endian)";
    case Encoding::kWindows1252:
      return "Windows-1252";
  }
  return "";
}

Encoding encoding_of(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) return Encoding::kUtf8Bom;
  if (bytes.starts_with("\xFF\xFE")) return Encoding::kUtf16Le;
  if (bytes.starts_with("\xFE\xFF")) return Encoding::kUtf16Be;
  // Digits and separators of a table are ASCII: every other byte of UTF-16 is then zero.
  std::array<std::size_t, 2> zeros{};
  const std::size_t looked = std::min<std::size_t>(bytes.size(), 4096);
  for (std::size_t i = 0; i < looked; ++i) zeros[i % 2] += bytes[i] == '\0' ? 1 : 0;
  if (zeros[1] * 4 > looked && zeros[0] * 20 < looked) return Encoding::kUtf16Le;
  if (zeros[0] * 4 > looked && zeros[1] * 20 < looked) return Encoding::kUtf16Be;
  return is_utf8(bytes) ? Encoding::kUtf8 : Encoding::kWindows1252;
}

std::string utf8_of(std::string_view bytes, Encoding encoding) {
  switch (encoding) {
    case Encoding::kUtf8:
      return std::string(bytes);
    case Encoding::kUtf8Bom:
      return std::string(bytes.substr(3));
    case Encoding::kUtf16Le:
      return from_utf16(bytes, false);
    case Encoding::kUtf16Be:
      return from_utf16(bytes, true);
    case Encoding::kWindows1252:
      break;
  }
  // Two files that were joined: a line that is UTF-8 stays as it is.
  std::string text;
  for_each_line(bytes, [&](std::string_view line) {
    text += is_utf8_line(line) ? std::string(line) : from_windows(line);
  });
  return text;
}

bool mixes_encodings(std::string_view bytes) {
  if (encoding_of(bytes) != Encoding::kWindows1252) return false;
  bool mixed = false;
  for_each_line(bytes, [&](std::string_view line) { mixed |= is_utf8_line(line); });
  return mixed;
}

std::string utf8_text(std::string_view bytes) { return utf8_of(bytes, encoding_of(bytes)); }

}  // namespace vernier::sheet
