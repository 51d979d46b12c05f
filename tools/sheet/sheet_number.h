// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace vernier::sheet {

/// Converts the number in a cell to text with a decimal point ("-1234.5"). Separators of thousands
/// ("1.234,5", "1'234.5", "1 234,5") and the long minus sign are permitted. The function plain_number()
/// returns nullopt if the cell is not a number with this decimal sign.
std::optional<std::string> plain_number(std::string_view cell, bool decimal_comma);

/// Decimal sign that the number in a cell shows: a comma, a point, no decimal sign, or an ambiguous sign. In
/// the cell "1,234", the comma can be a decimal sign or a separator of thousands.
enum class DecimalSign { kNeither, kPoint, kComma, kEither };
DecimalSign decimal_sign_in(std::string_view cell);

/// Returns the number of digits behind the decimal sign of the number in a cell: 3 for "11.700" and "-0.005
/// mm".
std::size_t decimals_of(std::string_view cell, bool decimal_comma);

}  // namespace vernier::sheet
