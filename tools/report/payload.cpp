// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/payload.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace vernier::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShortRow = 24;  // numbers; packing shorter rows has no advantage

bool is_numeric_row(const Json& value) {
  return value.is_array() && value.size() > kShortRow &&
         std::all_of(value.begin(), value.end(),
                     [](const Json& item) { return item.is_number() || item.is_null(); });
}

bool is_byte_row(const Json& value) {
  return std::all_of(value.begin(), value.end(), [](const Json& item) {
    return item.is_number_integer() && item.get<double>() >= 0 && item.get<double>() <= 255;
  });
}

Json packed_row(const Json& row) {
  std::string bytes;
  if (is_byte_row(row)) {
    for (const Json& item : row) bytes.push_back(static_cast<char>(item.get<unsigned>()));
    return {{"u8", base64(bytes)}};
  }
  for (const Json& item : row) {
    const double value = item.is_null() ? std::numeric_limits<double>::quiet_NaN() : item.get<double>();
    const bool fits = std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
    auto bits = std::bit_cast<std::uint32_t>(fits ? static_cast<float>(value)
                                                  : std::numeric_limits<float>::quiet_NaN());
    for (int byte = 0; byte < 4; ++byte, bits >>= 8) bytes.push_back(static_cast<char>(bits & 0xffu));
  }
  return {{"f32", base64(bytes)}};
}

}  // namespace

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k)
      text.push_back(k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=');
  }
  return text;
}

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

Json packed(const Json& value) {
  if (is_numeric_row(value)) return packed_row(value);
  if (!value.is_structured()) return value;
  Json result = value.is_array() ? Json::array() : Json::object();
  if (value.is_array()) {
    for (const Json& item : value) result.push_back(packed(item));
  } else {
    for (const auto& [key, item] : value.items()) result[key] = packed(item);
  }
  return result;
}

std::string script_json(const Json& value) {
  // Numbers that are not finite are dumped as null.
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else if (c == '>')
      safe += "\\u003e";
    else
      safe += c;
  }
  return safe;
}

}  // namespace vernier::report
