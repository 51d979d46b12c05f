// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/freedom.h"

#include <fmt/format.h>

#include "tools/fit/selection.h"
#include "tools/fit/solve.h"
#include "tools/model/parameters.h"

namespace vernier::fit {
namespace {

void set_freedom(model::Machine& machine, const std::string& pattern, bool free) {
  bool found = false;
  for (model::Freedom& one : model::freedoms_of(machine)) {
    if (!matches_pattern(pattern, one.name())) continue;
    one.set_free(free);
    found = true;
  }
  if (found) return;
  const bool tool = pattern.starts_with("ToolShift") && machine.tool_shifts.empty();
  const bool point = machine.find_static("TPX").has_value();
  throw text::InputError(fmt::format(
      "\"{}\": no static, table column (table.X.rY), BaseShift, ToolShift or scalefactor.X has this name{}",
      pattern,
      !tool   ? ""
      : point ? "; the machine file has no <ToolShift>, and its tool point is TPX,TPY,TPZ"
              : "; the machine file has no <ToolShift/> in <static>"));
}

}  // namespace

model::Machine with_freedom(const model::Machine& machine, const std::vector<std::string>& free,
                            const std::vector<std::string>& hold) {
  model::Machine result = machine;
  for (const std::string& pattern : free) set_freedom(result, pattern, true);
  for (const std::string& pattern : hold) set_freedom(result, pattern, false);
  return result;
}

}  // namespace vernier::fit
