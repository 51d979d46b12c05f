// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::report {

/// Base64 (RFC 4648, padded) of some bytes.
std::string base64(std::string_view bytes);

/// Returns the text for an HTML document: & < > " ' written as entities.
std::string escape_html(std::string_view text);

/// Returns `value` with long rows of numbers packed: {"u8": base64} for small whole numbers, else {"f32":
/// base64} of little-endian floats. null and values that are not finite become NaN. Short rows are not
/// changed.
nlohmann::ordered_json packed(const nlohmann::ordered_json& value);

/// Returns JSON that is valid inside a <script> element: no '<' and '>', ASCII only; bytes that are no UTF-8
/// are replaced.
std::string script_json(const nlohmann::ordered_json& value);

}  // namespace vernier::report
