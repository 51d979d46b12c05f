// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::report {

/// Returns bytes in Base64 code (RFC 4648, padded).
std::string base64(std::string_view bytes);

/// Returns a text for an HTML document, in which & < > " ' are written as entities.
std::string escape_html(std::string_view text);

/// Returns `value` with long arrays of numbers in packed form: {"u8": base64} for small whole numbers,
/// otherwise {"f32": base64} of little-endian floats. Null and numbers that are not finite become NaN. Short
/// arrays are not changed.
nlohmann::ordered_json packed(const nlohmann::ordered_json& value);

/// Returns JSON that is valid inside a <script> element: it contains no '<' and '>' and only ASCII
/// characters. Bytes that are not UTF-8 are replaced.
std::string script_json(const nlohmann::ordered_json& value);

}  // namespace vernier::report
