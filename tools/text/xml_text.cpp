// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/xml_text.h"

#include <algorithm>
#include <cctype>

namespace vernier::text {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool ends_tag(char c) { return c == '>' || c == '/'; }

std::size_t skip_space(std::string_view text, std::size_t at) {
  while (at < text.size() && is_space(text[at])) ++at;
  return at;
}

std::size_t skip_name(std::string_view text, std::size_t at) {
  while (at < text.size() && !is_space(text[at]) && !ends_tag(text[at]) && text[at] != '=') ++at;
  return at;
}

}  // namespace

std::vector<AttributeSpan> attribute_spans(std::string_view text, std::size_t offset) {
  std::vector<AttributeSpan> spans;
  std::size_t at = skip_space(text, skip_name(text, offset));
  while (at < text.size() && !ends_tag(text[at])) {
    AttributeSpan span;
    span.name_at = at;
    at = skip_name(text, at);
    span.name = std::string(text.substr(span.name_at, at - span.name_at));
    at = skip_space(text, at);
    if (at >= text.size() || text[at] != '=') break;
    at = skip_space(text, at + 1);
    if (at >= text.size()) break;
    const char quote = text[at];
    const std::size_t end = text.find(quote, at + 1);
    if (end == std::string_view::npos) break;
    span.value_at = at + 1;
    span.value_size = end - span.value_at;
    spans.push_back(span);
    at = skip_space(text, end + 1);
  }
  return spans;
}

std::size_t end_of_attributes(std::string_view text, std::size_t offset) {
  const std::vector<AttributeSpan> spans = attribute_spans(text, offset);
  if (spans.empty()) return skip_name(text, offset);
  return spans.back().value_at + spans.back().value_size + 1;
}

std::size_t line_of(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

bool equal_no_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [&](char x, char y) { return lower(x) == lower(y); });
}

std::string apply_edits(const std::string& text, std::vector<TextEdit> edits) {
  std::stable_sort(edits.begin(), edits.end(),
                   [](const TextEdit& a, const TextEdit& b) { return a.at < b.at; });
  std::string result;
  std::size_t at = 0;
  for (const TextEdit& edit : edits) {
    result.append(text, at, edit.at - at);
    result += edit.text;
    at = edit.at + edit.size;
  }
  return result.append(text, at);
}

std::string escape_attribute(std::string_view value) {
  std::string text;
  for (const char c : value) {
    if (c == '&')
      text += "&amp;";
    else if (c == '<')
      text += "&lt;";
    else if (c == '>')
      text += "&gt;";
    else if (c == '"')
      text += "&quot;";
    else
      text += c;
  }
  return text;
}

}  // namespace vernier::text
