// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/csv.h"

#include "tools/text/words.h"

namespace vernier::text {
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"# \t\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> fields_of(const std::string& line, const FieldRules& rules, const Place& place) {
  const bool blanks = rules.separator == ' ';
  const auto is_separator = [&](char c) { return c == rules.separator || (blanks && c == '\t'); };
  const std::string text = blanks ? trimmed(line) : line;
  std::vector<std::string> fields(1);
  bool quoted = false, was_quoted = false, blank = true;
  const auto close = [&] {
    if (!was_quoted) fields.back() = trimmed(fields.back());
    was_quoted = false;
    blank = true;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool at_begin = !was_quoted && blank;
    if (quoted) {
      const bool doubled = c == '"' && i + 1 < text.size() && text[i + 1] == '"';
      quoted = c != '"' || doubled;
      if (quoted) fields.back() += c;
      if (doubled) ++i;
    } else if (is_separator(c)) {
      if (blanks && is_separator(text[i - 1])) continue;
      close();
      fields.emplace_back();
    } else if (c == '"' && at_begin) {
      fields.back().clear();
      quoted = was_quoted = true;
    } else if (c == '"' && (was_quoted || !rules.quotes_inside)) {
      throw InputError(place, text.substr(i, 20), "a stray quote");
    } else if (!was_quoted) {
      fields.back() += c;
      blank = blank && trimmed({&c, 1}).empty();
    } else if (c != ' ' && c != '\t') {
      throw InputError(place, text.substr(i, 20), "the field has text after its closing quote");
    }
  }
  if (quoted)
    throw InputError(place, fields.back(),
                     "a closing quote is missing: write it, or delete the quote that opens this field");
  close();
  return fields;
}

}  // namespace vernier::text
