// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/signal_source.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "firmware/daemon/settings/key_file.h"

namespace vernier {
namespace {

using Names = std::set<std::string_view>;
const Names kTexts = {"access",    "address", "attribute", "calibration", "chip",           "device",
                      "devices",   "feature", "kind",      "interface",   "minus",          "object",
                      "of",        "parity",  "path",      "pdo_test",    "plain_commands", "polarity",
                      "registers", "root",    "trigger",   "type"};
const Names kNumbers = {"amplitude", "corner_Hz",  "delay_ms", "frequency_Hz", "offset",
                        "range",     "resolution", "scale",    "span"};
const Names kWholeNumbers = {"baud",        "bits",      "channel",      "codes",      "count",
                             "echo",        "every",     "heartbeat_ms", "high",       "high_ns",
                             "id",          "line",      "low",          "low_ns",     "missing_samples",
                             "node",        "period_ms", "period_ns",    "place",      "port",
                             "rate_Hz",     "receive",   "register",     "rpdo",       "sequence",
                             "stale_ticks", "sync",      "sync_us",      "timeout_ms", "toggle_ms",
                             "tpdo",        "transmit",  "unit",         "valid",      "window",
                             "zero",        "zero_ns"};

}  // namespace

SettingType type_of_setting(const std::string& kind, const std::string& name) {
  // The channel of a buffer has a name, that of a converter has a number.
  if (kTexts.contains(name) || (name == "channel" && kind == "iio-buffer")) return SettingType::kText;
  if (kNumbers.contains(name)) return SettingType::kNumber;
  return kWholeNumbers.contains(name) ? SettingType::kWholeNumber : SettingType::kUnknown;
}

void SignalSource::fail(const std::string& what) const { throw BoardError{where + ": " + what}; }
void SignalSource::fail_at(const std::string& name, const std::string& what) const {
  const auto place = places.find(name);
  throw BoardError{(place == places.end() ? where : place->second) + ": " + what};
}
void SignalSource::only(const std::vector<const char*>& names) const {
  const auto check = [&](const std::string& name) {
    if (name != "kind" && std::find(names.begin(), names.end(), name) == names.end())
      fail_at(name, "unknown setting " + name + " of kind " + kind);
  };
  for (const auto& entry : texts) check(entry.first);
  for (const auto& entry : numbers) check(entry.first);
}
const std::string& SignalSource::text(const std::string& name) const {
  const auto found = texts.find(name);
  if (found == texts.end())
    fail_at(name, name + (numbers.contains(name) ? " must be a text" : " is missing"));
  return found->second;
}
double SignalSource::number(const std::string& name) const {
  const auto found = numbers.find(name);
  if (found == numbers.end())
    fail_at(name, name + (texts.contains(name) ? " must be a number" : " is missing"));
  return found->second;
}
std::int64_t SignalSource::whole(const std::string& name, std::int64_t low, std::int64_t high) const {
  const double value = number(name);
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)) ||
      value != std::floor(value))
    fail_at(name,
            name + " must be a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  return static_cast<std::int64_t>(value);
}
std::int64_t SignalSource::whole(const std::string& name, std::int64_t otherwise, std::int64_t low,
                                 std::int64_t high) const {
  return texts.contains(name) || numbers.contains(name) ? whole(name, low, high) : otherwise;
}
double SignalSource::number(const std::string& name, double otherwise) const {
  return texts.contains(name) || numbers.contains(name) ? number(name) : otherwise;
}
std::string SignalSource::text(const std::string& name, const std::string& otherwise) const {
  return texts.contains(name) || numbers.contains(name) ? text(name) : otherwise;
}

}  // namespace vernier
