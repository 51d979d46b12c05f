// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/safety_json.h"

#include <fmt/format.h>

namespace vernier::results {
namespace {

nlohmann::ordered_json rule_json(const safety::SafetyFinding& f) {
  return {{"rule", safety::rule_name(f.rule)},
          {"value", f.value ? nlohmann::ordered_json(*f.value) : nlohmann::ordered_json(nullptr)},
          {"limit", f.limit},
          {"unit", f.unit},
          {"ok", f.ok},
          {"accepted", f.accepted},
          {"culprit", f.culprit},
          {"reason", f.reason}};
}

}  // namespace

nlohmann::ordered_json safety_json(const safety::SafetySheet& sheet) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const safety::SafetyFinding& f : sheet.findings) list.push_back(rule_json(f));
  return list;
}

nlohmann::ordered_json safe_to_run_json(const safety::SafetySheet& sheet) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const safety::SafetyFinding& f : sheet.findings)
    if (f.value) list.push_back(rule_json(f));
  return list;
}

void print_safety(std::FILE* out, const safety::SafetySheet& sheet) {
  fmt::print(out, "safe to run?\n");
  for (const safety::SafetyFinding& f : sheet.findings)
    fmt::print(out, "  {:<15} {:>9}  limit {:<6g} {:<28} {}{}\n", safety::rule_name(f.rule),
               f.value ? fmt::format("{:.3g}", *f.value) : "-", f.limit, f.unit,
               !f.value     ? "not known"
               : f.ok       ? "ok"
               : f.accepted ? "ACCEPTED"
                            : "NO",
               f.ok || f.culprit.empty() ? "" : ": " + f.culprit);
  for (const std::string& name : sheet.stale)
    fmt::print(out,
               "  note: {} was added or set by hand since the fit: its uncertainty is increased by the size "
               "of the change\n",
               name);
}

}  // namespace vernier::results
