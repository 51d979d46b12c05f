// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace vernier::importer {

/// Parses a JSON text. If the text is not JSON, throws InputError with the line and the word of the first
/// error.
nlohmann::json parse_json(const std::string& path, std::string_view text);

/// Returns the line (from 1) with the value at the JSON pointer `pointer` ("/Runs/0/Readings/3"); 0 if the
/// text has no such value.
std::size_t json_line(std::string_view text, const std::string& pointer);

}  // namespace vernier::importer
