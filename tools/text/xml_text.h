// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Position of an attribute in the start tag of an XML element.
struct AttributeSpan {
  std::string name;          // name of the attribute as it is written
  std::size_t name_at = 0;   // offset of the name in the text
  std::size_t value_at = 0;  // offset of the first character between the quotes
  std::size_t value_size = 0;
};

/// Returns the attributes of the start tag whose element name begins at `offset`. At `offset` the text must
/// be valid XML, which a parser has already accepted.
std::vector<AttributeSpan> attribute_spans(std::string_view text, std::size_t offset);

/// Returns the offset directly after the last attribute (or the name) of a start tag, where another attribute
/// can be inserted.
std::size_t end_of_attributes(std::string_view text, std::size_t offset);

/// Returns the line number (from 1) of an offset in a text.
std::size_t line_of(std::string_view text, std::size_t offset);

/// True if both texts are equal except for capital and small letters (ASCII).
bool equal_no_case(std::string_view a, std::string_view b);

/// One replacement in a text: `text` replaces `size` characters at the offset `at`.
struct TextEdit {
  std::size_t at = 0, size = 0;
  std::string text;
};
/// Applies replacements that do not overlap, in any order. Replacements at the same offset are applied in the
/// given order.
std::string apply_edits(const std::string& text, std::vector<TextEdit> edits);

/// Returns a number or text in the form for an attribute value between double quotes.
std::string escape_attribute(std::string_view value);

}  // namespace vernier::text
