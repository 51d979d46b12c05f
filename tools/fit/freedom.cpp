// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/freedom.h"

#include "tools/fit/solve.h"

namespace vernier {
namespace {

void set_freedom(Machine& machine, const std::string& pattern, bool free) {
  bool found = false;
  const auto named = [&](const std::string& name) {
    const bool match = matches_pattern(pattern, name);
    found = found || match;
    return match;
  };
  for (Static& item : machine.statics)
    if (named(item.name)) item.hidden = !free;
  for (Axis& axis : machine.axes)
    if (named("scalefactor." + axis.name)) axis.scale_free = free;
  for (Table& table : machine.tables)
    for (std::size_t c = 0; c < 6; ++c)
      if (named("table." + machine.axes[table.axis].name + "." + kSixDofNames[c])) table.free[c] = free;
  for (BaseShift& shift : machine.base_shifts)
    if (named(shift.run ? "BaseShift[" + *shift.run + "]" : "BaseShift")) shift.hidden = !free;
  if (!found)
    throw InputError("\"" + pattern +
                     "\": no static, table column (table.X.rY), BaseShift or scalefactor.X has this name");
}

}  // namespace

Machine with_freedom(const Machine& machine, const std::vector<std::string>& free,
                     const std::vector<std::string>& hold) {
  Machine result = machine;
  for (const std::string& pattern : free) set_freedom(result, pattern, true);
  for (const std::string& pattern : hold) set_freedom(result, pattern, false);
  return result;
}

}  // namespace vernier
