// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace vernier::sheet {

/// Character encoding of a text file.
enum class Encoding { kUtf8, kUtf8Bom, kUtf16Le, kUtf16Be, kWindows1252 };

/// Returns the name of an encoding: "UTF-8", "UTF-16 (little endian)" and so on.
const char* encoding_name(Encoding encoding);

/// Detects the encoding of a text from its byte order mark. Without a byte order mark, the encoding is UTF-16
/// if there are zero bytes next to ASCII, UTF-8 if all bytes are valid UTF-8, and otherwise the code page of
/// Western spreadsheets.
Encoding encoding_of(std::string_view bytes);

/// Returns the text as UTF-8 without a byte order mark. Bytes that are not valid become the character U+FFFD.
/// In a text of the code page Windows-1252, a line that is UTF-8 with letters beyond ASCII is not changed.
std::string utf8_of(std::string_view bytes, Encoding encoding);

/// True if a text has lines in UTF-8 and lines in Windows-1252, each with letters beyond ASCII.
bool mixes_encodings(std::string_view bytes);

/// Returns the text as UTF-8 without a byte order mark. The encoding is the one that encoding_of detects.
std::string utf8_text(std::string_view bytes);

}  // namespace vernier::sheet
