// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Position of an attribute of a start tag in the text of an XML file.
struct AttributeSpan {
  std::string name;          // as written
  std::size_t name_at = 0;   // offset of its name
  std::size_t value_at = 0;  // offset of the first character between the quotes
  std::size_t value_size = 0;
};

/// Returns the attributes of the start tag whose element name begins at `offset`. The text must be
/// well-formed at `offset` (a parser has accepted it).
std::vector<AttributeSpan> attribute_spans(std::string_view text, std::size_t offset);

/// Offset immediately after the last attribute (or the name) of that start tag, where another attribute can
/// be inserted.
std::size_t end_of_attributes(std::string_view text, std::size_t offset);

/// 1-based line of an offset.
std::size_t line_of(std::string_view text, std::size_t offset);

/// True if both texts have the same letters, ignoring case (ASCII).
bool equal_no_case(std::string_view a, std::string_view b);

/// One replacement in a text: `size` characters at `at` become `text`.
struct TextEdit {
  std::size_t at = 0, size = 0;
  std::string text;
};
/// Applies edits that do not overlap; the edits may be in any order (edits at the same offset are applied in
/// the given order).
std::string apply_edits(const std::string& text, std::vector<TextEdit> edits);

/// A number or text, escaped for use between double quotes in an attribute.
std::string escape_attribute(std::string_view value);

}  // namespace vernier::text
