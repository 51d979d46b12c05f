// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/selection.h"

namespace vernier::fit {

std::vector<std::string> setups_of_fit_rows(const model::Measurement& measurement) {
  const std::vector<std::string>& names = measurement.states.names(measurement.states.setup);
  std::vector<char> seen(names.size(), 0);
  for (const model::Observation& o : measurement.observations)
    if (measurement.check[o.row] == 0 &&
        !(model::is_of_thing(o.kind) && model::is_free_of_set_up(measurement, o)))
      seen[measurement.states.of(measurement.states.setup, o.row)] = 1;
  std::vector<std::string> setups;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] != 0) setups.push_back(names[i]);
  return setups;
}

bool matches_pattern(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() == '*')
    return matches_pattern(pattern.substr(1), name) ||
           (!name.empty() && matches_pattern(pattern, name.substr(1)));
  return !name.empty() && (pattern.front() == '?' || pattern.front() == name.front()) &&
         matches_pattern(pattern.substr(1), name.substr(1));
}

}  // namespace vernier::fit
