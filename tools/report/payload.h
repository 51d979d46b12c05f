// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::report {

/// Returns Base64 (RFC 4648, padded) of some bytes. tool.
std::string base64(std::string_view bytes);

/// Returns text for an HTML document: & < > " ' become entities. tool.
std::string escape_html(std::string_view text);

/// Returns `value` with long rows of numbers packed: {"u8": base64} for small whole numbers, else
/// {"f32": base64} of little-endian floats. null and values that are not finite become NaN. Short
/// rows do not change. tool.
nlohmann::ordered_json packed(const nlohmann::ordered_json& value);

/// Returns JSON that is valid inside a <script> element: without '<' and '>', ASCII only. Bytes
/// that are not UTF-8 are replaced. tool.
std::string script_json(const nlohmann::ordered_json& value);

}  // namespace vernier::report
