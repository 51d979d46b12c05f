// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/check_readings.h"

#include <cmath>

#include "tools/fleet/board_reader.h"
#include "tools/text/error.h"

namespace vernier::fleet {

registry::FleetCheck parse_check(const std::string& json, const std::string& file) {
  SparkplugPayload payload;
  payload.metrics = check_metrics(json, 0);
  const auto verdict = text_of(payload.find("Check/Verdict"));
  if (!verdict)
    throw text::InputError({file, 0}, "", "this file is not the output of `vernier check --json`");
  registry::FleetCheck check;
  check.verdict = *verdict;
  check.label = file;
  check.explanation = text_of(payload.find("Check/Explanation")).value_or("");
  check.evidence = std::get<double>(payload.find("Check/Evidence")->value);
  check.alarm = std::get<double>(payload.find("Check/Alarm")->value);
  return check;
}

std::vector<registry::FleetReading> readings_of(const check::CheckRecord& record, const std::string& machine,
                                                std::int64_t at_us) {
  std::vector<registry::FleetReading> readings;
  for (std::size_t i = 0; i < record.quantities.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double amount = record.gram(at, at);
    if (record.quantities[i].of_instrument || !(amount > 0)) continue;
    const double value = record.moment[at] / amount, std = 1 / std::sqrt(amount);
    if (!std::isfinite(value) || !std::isfinite(std)) continue;
    readings.push_back({machine, record.quantities[i].name, record.quantities[i].unit, at_us, value, std});
  }
  return readings;
}

}  // namespace vernier::fleet
