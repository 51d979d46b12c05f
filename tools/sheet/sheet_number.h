// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace vernier::sheet {

/// Returns a cell as number text with a decimal point and no other sign ("-1234.5"). Thousands
/// separators ("1.234,5", "1'234.5", "1 234,5") and the long minus sign are accepted. Returns
/// nullopt if it is not a number with this decimal sign. tool.
std::optional<std::string> plain_number(std::string_view cell, bool decimal_comma);

/// The decimal sign that a cell indicates: comma or point. "1,234" may be either.
enum class DecimalSign { kNeither, kPoint, kComma, kEither };
DecimalSign decimal_sign_in(std::string_view cell);

}  // namespace vernier::sheet
