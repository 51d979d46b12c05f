// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vernier::text {

/// Returns the value of `text` if the whole text is one finite decimal number ("1", "-2.5e-3", "+4"). The
/// function parse_number() returns nullopt for any other text (empty, blanks, hex, inf, nan), and for numbers
/// whose square overflows (beyond 1e150). The result of parse_number() does not depend on the locale of the
/// operating system.
std::optional<double> parse_number(std::string_view text);

/// Returns the value of `text` if the whole text is one count ("0", "12"); nullopt for any other text and for
/// counts that are too large.
std::optional<std::size_t> parse_count(std::string_view text);

/// True if a text is a permitted name in the file formats: letters, digits and _, beginning with a letter or
/// _ (ASCII).
bool is_name(std::string_view text);

/// Returns the fingerprint of a correction image as text: sixteen hexadecimal digits.
std::string fingerprint_text(std::uint64_t fingerprint);

/// Returns the shortest decimal text from which the same double number is read.
std::string number_text(double value);

/// Returns a finite number as text without exponent, with at most `decimals` decimals, without zeros at its
/// end and without negative zero: "0.0006", "0".
std::string fixed_text(double value, int decimals);

}  // namespace vernier::text
