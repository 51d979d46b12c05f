// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vernier::golden {

/// A field of a record or message: its name and how many bytes it takes.
struct Field {
  const char* name;
  std::size_t bytes;
};

/// Bytes as hexadecimal, a line a field: "01 02  # name"; more than 16 bytes go on in further lines. What the
/// fields do not cover is listed as "?".
std::string listed(const std::vector<std::uint8_t>& bytes, const std::vector<Field>& fields);

/// The bytes of a listing; "#" begins a comment, "=" a line that is not bytes.
std::vector<std::uint8_t> bytes_in(const std::string& listing);

/// Compares with tests/golden/FILE. VERNIER_UPDATE_GOLDEN=1 in the environment writes the file where there is
/// none, and never over one: what has been stored or sent in a version stays as it is, and another layout is
/// another version.
void expect_golden(const std::string& file, const std::string& text);

/// The text of tests/golden/FILE; empty where there is none.
std::string golden_text(const std::string& file);

}  // namespace vernier::golden
