// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vernier::text {

/// Parses a finite decimal number that is the whole of `text` ("1", "-2.5e-3", "+4"). Returns
/// nullopt for anything else (empty, blanks, hex, inf, nan) and for a number so large that its
/// square is infinite (beyond 1e150). Independent of the locale.
std::optional<double> parse_number(std::string_view text);

/// Parses a count ("0", "12") that is the whole of `text`. Returns nullopt for anything else and
/// for a number that is too large.
std::optional<std::size_t> parse_count(std::string_view text);

/// Is this a name of the formats: letters, digits and _, starting with a letter or _ (ASCII)?
bool is_name(std::string_view text);

/// Returns sixteen hexadecimal digits, the text of an image's fingerprint.
std::string fingerprint_text(std::uint64_t fingerprint);

/// Returns the shortest decimal that reads back to the same double.
std::string number_text(double value);

}  // namespace vernier::text
