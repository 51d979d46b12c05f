// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace vernier::sheet {

/// Encoding of the letters in the bytes of a file.
enum class Encoding { kUtf8, kUtf8Bom, kUtf16Le, kUtf16Be, kWindows1252 };

/// Returns the name of an encoding: "UTF-8", "UTF-16 (little endian)" and so on.
const char* encoding_name(Encoding encoding);

/// Detects the encoding by the byte order mark. Without a mark the encoding is UTF-16 if there are zero bytes
/// beside ASCII, UTF-8 if all bytes are valid UTF-8, else the code page of Western spreadsheets.
Encoding encoding_of(std::string_view bytes);

/// The text as UTF-8 without a mark. Invalid bytes become U+FFFD.
std::string utf8_of(std::string_view bytes, Encoding encoding);

/// The text as UTF-8 without a mark, from the encoding that encoding_of detects.
std::string utf8_text(std::string_view bytes);

}  // namespace vernier::sheet
