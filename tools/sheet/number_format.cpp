// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/number_format.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tools/text/words.h"

namespace vernier::sheet {
namespace {

/// One of the sections for positive numbers, negative ones, zero and texts.
struct Section {
  std::string text;  // shown beside the digits
  bool digits = false, percent = false, thousands = false;
  bool coloured = false;  // "[Red]": a colour in place of the sign

  bool has(std::string_view sign) const { return text.find(sign) != std::string::npos; }
  bool minus() const { return has("-") || has("\u2212") || (has("(") && has(")")); }
};

/// Reads a section from `at` on, and moves `at` behind its end.
Section section_at(std::string_view code, std::size_t& at) {
  Section section;
  bool after_digit = false;  // a comma behind the last digit divides by 1000
  for (; at < code.size() && code[at] != ';'; ++at) {
    const char c = code[at];
    if (c == '"') {
      const std::size_t end = std::min(code.find('"', at + 1), code.size());
      section.text += code.substr(at + 1, end - at - 1);
      at = end;
    } else if (c == '\\') {
      if (++at < code.size()) section.text += code[at];
    } else if (c == '_' || c == '*') {
      ++at;  // the width of the next letter, or the letter that fills the cell
    } else if (c == '[') {
      const std::size_t end = std::min(code.find(']', at), code.size());
      const std::string_view inside = code.substr(at + 1, end - at - 1);
      if (inside.starts_with("$"))
        section.text += inside.substr(1, inside.find('-') - 1);  // "[$EUR-407]"
      else
        section.coloured = true;
      at = end;
    } else if (std::string_view("0#?").find(c) != std::string_view::npos) {
      section.digits = after_digit = true;
      section.thousands = false;
      continue;
    } else if (c == ',') {
      section.thousands = after_digit;  // until another digit follows
      continue;
    } else if (c == '%') {
      section.percent = true;
    } else if ((c == 'E' || c == 'e') && section.digits) {
      if (at + 1 < code.size() && (code[at + 1] == '+' || code[at + 1] == '-')) ++at;
    } else if (code.substr(at).starts_with("General") || code.substr(at).starts_with("Standard")) {
      at += (c == 'G' ? std::string_view("General") : std::string_view("Standard")).size() - 1;
    } else if (c != '.' && c != '@' && c != '/') {
      section.text += c;
    }
    after_digit = after_digit && c == '.';
  }
  return section;
}

std::string without_signs(std::string text) {
  for (const std::string_view sign : {"\u2212", "-", "+", "(", ")"}) text::replace_all(text, sign, "");
  return text::trimmed(text);
}

}  // namespace

NumberFormat number_format(std::string_view code) {
  std::vector<Section> sections;
  for (std::size_t at = 0; at <= code.size(); ++at) sections.push_back(section_at(code, at));
  NumberFormat format;
  const bool two = sections.size() > 1;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, sections.size()); ++i) {
    const Section& section = sections[i];
    format.percent |= section.percent;
    format.thousands |= section.thousands;
    if (format.text.empty()) format.text = without_signs(section.text);
  }
  format.other_sign = sections[0].minus();
  if (two)
    format.other_sign |= sections[1].has("+") || (!sections[1].minus() && !sections[1].coloured);
  else
    format.other_sign |= sections[0].has("+");  // a plus in front of negative numbers too
  return format;
}

std::string_view built_in_format(unsigned id) {
  constexpr unsigned kPercent = 9, kPercentWithDecimals = 10;
  return id == kPercent ? "0%" : id == kPercentWithDecimals ? "0.00%" : "";
}

}  // namespace vernier::sheet
