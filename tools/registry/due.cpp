// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/due.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tools/text/wall_time.h"

namespace vernier::registry {
namespace {

DueMachine judged(const FleetMachine& machine, const FleetCheck* last, const RecordedCalibration* runs) {
  DueMachine one{machine.name, "", "", {}, {}};
  const std::int64_t begun = runs == nullptr ? machine.added_us : std::max(machine.added_us, runs->at_us);
  if (last != nullptr) one.last_us = last->at_us, one.verdict = last->verdict;
  if (machine.check_days <= 0) return one;
  const std::int64_t from = last == nullptr ? begun : last->at_us;
  one.due_us = from + static_cast<std::int64_t>(machine.check_days * text::kUsADay);
  if (last == nullptr) {
    one.due_us = begun, one.why = "never checked";
  } else if (runs != nullptr && runs->at_us > last->at_us) {
    one.due_us = runs->at_us, one.why = "not checked since its calibration";
  } else if (last->verdict != "valid") {
    one.due_us = last->at_us, one.why = fmt::format("the verdict of the last check: {}", last->verdict);
  }
  return one;
}

}  // namespace

std::vector<DueMachine> due_machines(Registry& registry, std::int64_t at_us) {
  std::map<std::string, FleetCheck> last;
  for (FleetCheck& check : registry.checks("")) last[check.machine] = std::move(check);
  std::map<std::string, RecordedCalibration> runs;
  for (RecordedCalibration& one : registry.calibrations("")) runs.try_emplace(one.machine, std::move(one));
  std::vector<DueMachine> all;
  for (const FleetMachine& machine : registry.machines()) {
    const auto check = last.find(machine.name);
    const auto calibration = runs.find(machine.name);
    DueMachine one = judged(machine, check == last.end() ? nullptr : &check->second,
                            calibration == runs.end() ? nullptr : &calibration->second);
    if (one.why.empty() && one.due_us && *one.due_us <= at_us)
      one.why = "the date of the next check has come";
    all.push_back(std::move(one));
  }
  const auto key = [](const DueMachine& one) { return one.due_us.value_or(INT64_MAX); };
  std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return all;
}

}  // namespace vernier::registry
