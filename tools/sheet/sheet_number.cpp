// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/sheet_number.h"

#include <algorithm>
#include <cctype>

#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::sheet {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Signs in numbers of spreadsheets, as ASCII: minus signs, non-breaking blanks.
std::string ascii_signs(std::string_view cell) {
  std::string text = text::trimmed(cell);
  const auto replace = [&](std::string_view sign, const char* with) {
    for (std::size_t at = 0; (at = text.find(sign, at)) != std::string::npos;)
      text.replace(at, sign.size(), with);
  };
  replace("\u2212", "-");
  replace("\u2013", "-");
  for (const char* blank : {"\u00a0", "\u2009", "\u202f"}) replace(blank, " ");
  replace("\u2019", "'");
  return text;
}

/// Removes `sign` before groups of three digits, and only there. False: it occurs elsewhere.
bool take_thousands(std::string& text, char sign) {
  const std::size_t first = text.find(sign);
  if (first == std::string::npos) return true;
  std::size_t start = 0;
  while (start < text.size() && !is_digit(text[start])) ++start;
  if (first <= start || first - start > 3 || text[start] == '0') return false;
  std::size_t at = first;
  for (; at < text.size() && text[at] == sign; at += 4)
    for (std::size_t k = 1; k <= 3; ++k)
      if (at + k >= text.size() || !is_digit(text[at + k])) return false;
  if (at < text.size() && is_digit(text[at])) return false;  // a group of four: 100,5045
  text.erase(std::remove(text.begin(), text.end(), sign), text.end());
  return true;
}

}  // namespace

std::optional<std::string> plain_number(std::string_view cell, bool decimal_comma) {
  std::string text = ascii_signs(cell);
  // "4.5-" is -4.5 in business software. A whole number with a minus is a run and its direction: "1-".
  if (text.size() > 2 && text.ends_with('-') && is_digit(text[text.size() - 2]) && is_digit(text.front()) &&
      text.find_first_of(".,") != std::string::npos) {
    text.pop_back();
    text.insert(0, "-");
  }
  // "- 4,0", often with a blank that does not break.
  if (text.size() > 2 && (text.front() == '-' || text.front() == '+') && text[1] == ' ') {
    const std::size_t digit = text.find_first_not_of(' ', 1);
    if (digit != std::string::npos && is_digit(text[digit])) text.erase(1, digit - 1);
  }
  for (const char sign : {' ', '\''})
    if (!take_thousands(text, sign)) return std::nullopt;
  const char point = decimal_comma ? ',' : '.', thousands = decimal_comma ? '.' : ',';
  if (std::count(text.begin(), text.end(), point) > 1) return std::nullopt;
  std::string whole = text.substr(0, text.find(point)), rest = text.substr(whole.size());
  if (!take_thousands(whole, thousands) || rest.find(thousands) != std::string::npos) return std::nullopt;
  std::replace(rest.begin(), rest.end(), ',', '.');
  text = whole + rest;
  if (text.starts_with("+")) text.erase(0, 1);
  if (!text::parse_number(text)) return std::nullopt;
  return text;
}

DecimalSign decimal_sign_in(std::string_view cell) {
  const std::string text = ascii_signs(cell);
  const bool point = text.find('.') != std::string::npos, comma = text.find(',') != std::string::npos;
  if (!point && !comma) return DecimalSign::kNeither;
  const bool by_point = plain_number(cell, false).has_value(),
             by_comma = plain_number(cell, true).has_value();
  if (by_point && by_comma) return DecimalSign::kEither;
  if (by_point) return DecimalSign::kPoint;
  return by_comma ? DecimalSign::kComma : DecimalSign::kNeither;
}

std::size_t decimals_of(std::string_view cell, bool decimal_comma) {
  const auto sign = cell.rfind(decimal_comma ? ',' : '.');
  if (sign == std::string_view::npos) return 0;
  const auto end = cell.find_first_not_of("0123456789", sign + 1);
  return (end == std::string_view::npos ? cell.size() : end) - sign - 1;
}

}  // namespace vernier::sheet
