// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/insertion.h"
#include "tools/text/numbers.h"

#include <algorithm>

namespace vernier::effects {
namespace {

/// Returns the offset where `tag` ("</static") ends an element, from `at` on. Comments and longer
/// names are skipped.
std::size_t closing_tag(const std::string& text, std::size_t at, const std::string& tag) {
  for (at = text.find('<', at); at != std::string::npos; at = text.find('<', at + 1)) {
    if (text.compare(at, 4, "<!--") == 0)
      at = text.find("-->", at);
    else if (text.compare(at, tag.size(), tag) == 0 && !text::is_name(text.substr(at + tag.size(), 1)))
      break;
  }
  return at;
}

}  // namespace

std::size_t offset_of(const pugi::xml_node& node) { return static_cast<std::size_t>(node.offset_debug()); }

pugi::xml_node element_named(const pugi::xml_node& parent, const char* name) {
  return parent.find_node(
      [name](const pugi::xml_node& node) { return text::equal_no_case(node.name(), name); });
}

text::TextEdit at_end_of(const std::string& text, const pugi::xml_node& node, const std::string& lines) {
  const std::size_t end_of_start = text.find('>', text::end_of_attributes(text, offset_of(node)));
  if (text[end_of_start - 1] == '/')
    return {end_of_start - 1, 2, ">\n" + lines + "</" + std::string(node.name()) + ">"};
  std::size_t from = end_of_start;
  for (const pugi::xml_node child : node.children())
    if (child.offset_debug() >= 0) from = std::max(from, offset_of(child));
  std::size_t close = closing_tag(text, from, "</" + std::string(node.name()));
  const std::size_t line = text.rfind('\n', close);
  if (line != std::string::npos && text.find_first_not_of(" \t\r", line + 1) == close) close = line + 1;
  return {close, 0, lines};
}

}  // namespace vernier::effects
