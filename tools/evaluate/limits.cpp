// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/limits.h"

#include <algorithm>
#include <cctype>

#include "tools/format/units.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::evaluate {

std::pair<std::string, double> limit_of(const std::string& words, const std::string& option,
                                        const std::vector<std::string>& names,
                                        const std::string& unit_wanted) {
  const auto at = words.find('=');
  const std::string name = words.substr(0, at);
  const std::string rest = at == std::string::npos ? "" : words.substr(at + 1);
  std::size_t end = 0;
  while (end < rest.size() && (std::isdigit(static_cast<unsigned char>(rest[end])) != 0 || rest[end] == '.'))
    ++end;
  const auto number = text::parse_number(rest.substr(0, end));
  const auto unit = format::find_unit(rest.substr(end));
  const bool angle = unit_wanted == "deg";
  const bool fits =
      unit && unit->dimension == (angle ? format::Dimension::kAngle : format::Dimension::kLength);
  if (!number || !fits || std::find(names.begin(), names.end(), name) == names.end())
    throw text::InputError(option + " " + words + ": of the form " + names.front() +
                           (angle ? "=0.01deg" : "=10um") + ", for one of " + text::joined(names, " "));
  return {name, *number * unit->factor};
}

}  // namespace vernier::evaluate
