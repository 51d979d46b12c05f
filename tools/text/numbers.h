// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vernier::text {

/// A finite decimal number that fills the whole of `text` ("1", "-2.5e-3", "+4"). `nullopt` for any other
/// text (empty, blanks, hex, inf, nan) and for numbers whose square overflows (beyond 1e150). Independent of
/// the locale.
std::optional<double> parse_number(std::string_view text);

/// Reads a count ("0", "12") that fills the whole of `text`; `nullopt` for any other text and for counts that
/// are too large.
std::optional<std::size_t> parse_count(std::string_view text);

/// True for a name of the formats: letters, digits and _, beginning with a letter or _ (ASCII).
bool is_name(std::string_view text);

/// Returns the fingerprint of a correction image as text: sixteen hexadecimal digits.
std::string fingerprint_text(std::uint64_t fingerprint);

/// Returns the shortest decimal text that reads back to the same double.
std::string number_text(double value);

/// Returns a finite number without exponent, with at most `decimals` decimals, no zeros at its end and no
/// negative zero: "0.0006", "0".
std::string fixed_text(double value, int decimals);

}  // namespace vernier::text
