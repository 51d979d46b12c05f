// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/dates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>

#include "tools/text/numbers.h"

namespace vernier::sheet {
namespace {

bool is_digit_sign(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// True if the text follows a pattern in which 0 is a placeholder for any digit.
bool follows(std::string_view text, std::string_view pattern) {
  if (text.size() != pattern.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (pattern[i] == '0' ? !is_digit_sign(text[i]) : text[i] != pattern[i]) return false;
  return true;
}

}  // namespace

bool is_date_format(std::string_view code) {
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    if (c == '\\' || c == '_' || c == '*') {
      ++i;  // the next letter is shown, or its width is left
    } else if (c == '"') {
      i = std::min(code.find('"', i + 1), code.size());
    } else if (c == '[') {
      const std::size_t close = std::min(code.find(']', i), code.size());
      const std::string_view inside = code.substr(i + 1, close - i - 1);
      const bool elapsed = !inside.empty() && inside.find_first_not_of("hHmMsS") == std::string_view::npos;
      if (elapsed) return true;
      i = close;
    } else if (std::string_view("dDmMyYhHsS").find(c) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

bool is_date_format(unsigned id) {
  return (id >= 14 && id <= 22) || (id >= 27 && id <= 36) || (id >= 45 && id <= 47) || (id >= 50 && id <= 58);
}

std::string date_text(double serial, bool from_1904) {
  constexpr double kMostDays = 2958465, kSecondsPerDay = 86400;  // 9999-12-31
  if (!(serial >= 0 && serial <= kMostDays)) return text::number_text(serial);
  const double all = std::round(serial * kSecondsPerDay);
  const auto days = static_cast<int>(std::floor(all / kSecondsPerDay));
  const auto rest = static_cast<int>(all - days * kSecondsPerDay);
  const std::string time = fmt::format("{:02}:{:02}:{:02}", rest / 3600, rest / 60 % 60, rest % 60);
  if (days == 0) return time;
  using namespace std::chrono;
  const sys_days zero = from_1904 ? sys_days{year{1904} / 1 / 1} : sys_days{year{1899} / 12 / 30};
  const year_month_day date{zero + std::chrono::days{days}};
  const std::string day = fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                                      static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
  return rest == 0 ? day : day + "T" + time;
}

bool is_date(std::string_view cell) {
  return follows(cell, "0000-00-00") || follows(cell, "00:00:00") || follows(cell, "0000-00-00T00:00:00");
}

}  // namespace vernier::sheet
