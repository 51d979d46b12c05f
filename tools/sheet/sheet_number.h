// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace vernier::sheet {

/// Converts a cell to number text with a decimal point only ("-1234.5"). Thousands ("1.234,5", "1'234.5", "1
/// 234,5") and the long minus sign are accepted. `nullopt` if the cell is not a number with this decimal
/// sign.
std::optional<std::string> plain_number(std::string_view cell, bool decimal_comma);

/// Decimal sign that a cell shows: a comma, a point, neither, or either. The cell "1,234" may have either
/// decimal sign.
enum class DecimalSign { kNeither, kPoint, kComma, kEither };
DecimalSign decimal_sign_in(std::string_view cell);

}  // namespace vernier::sheet
