// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace vernier::importer {

/// Parses JSON. Throws InputError with the line and the word of the first error in the text.
nlohmann::json parse_json(const std::string& path, std::string_view text);

/// Returns the line (from 1) on which the value at `pointer` ("/Runs/0/Readings/3") begins or ends; 0 if the
/// text has no such value.
std::size_t json_line(std::string_view text, const std::string& pointer);

}  // namespace vernier::importer
