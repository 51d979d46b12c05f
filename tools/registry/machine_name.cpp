// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/machine_name.h"

#include <algorithm>

#include "tools/text/error.h"

namespace vernier::registry {
namespace {

constexpr std::size_t kLongestName = 200;  // with an ending it fits a file name of 255 bytes

bool is_plain(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); }

}  // namespace

bool is_machine_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && is_plain(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return is_plain(c) || c == '.' || c == '_' || c == '-'; });
}

void require_machine_name(const std::string& name) {
  if (!is_machine_name(name))
    throw text::InputError({}, name,
                           "a machine's name has letters, digits, . _ and - only, begins with a letter or a "
                           "digit, and has 1 to 200 bytes");
}

std::string for_machine(std::string text, const std::string& machine) {
  constexpr std::string_view kMark = "{machine}";
  for (std::size_t at = text.find(kMark); at != std::string::npos; at = text.find(kMark, at + machine.size()))
    text.replace(at, kMark.size(), machine);
  return text;
}

}  // namespace vernier::registry
