// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vernier {

/// Type of the value of a device's setting. kUnknown: no kind of device has the setting.
enum class SettingType { kUnknown, kText, kNumber, kWholeNumber };
/// Returns the type of the setting `name` of a device of this kind. Not real-time safe.
SettingType type_of_setting(const std::string& kind, const std::string& name);

/// Connection of a signal of the board to a device: a kind that open_devices.cpp knows, and the settings as
/// written in the board file.
struct SignalSource {
  std::string kind;                                // "can", "iio", "pwm", "sim" ...; empty: not wired
  std::map<std::string, std::string> texts;        // every setting that is a text
  std::map<std::string, double> numbers;           // every setting that is a number
  std::string where;                               // "board.toml:12: axis.X.output"
  std::map<std::string, std::string> places = {};  // the same for each setting, with the line of the setting

  [[noreturn]] void fail(const std::string& what) const;  // throws BoardError
  /// As fail(), with the line of the setting `name`.
  [[noreturn]] void fail_at(const std::string& name, const std::string& what) const;
  /// Throws BoardError if the file has a setting that is not among `names`, apart from kind.
  void only(const std::vector<const char*>& names) const;
  const std::string& text(const std::string& name) const;  // throws BoardError where absent
  double number(const std::string& name) const;            // the same
  double number(const std::string& name, double otherwise) const;
  /// Returns the setting `name` as a whole number from low to high; throws BoardError if the setting is
  /// absent or not valid.
  std::int64_t whole(const std::string& name, std::int64_t low, std::int64_t high) const;
  std::int64_t whole(const std::string& name, std::int64_t otherwise, std::int64_t low,
                     std::int64_t high) const;
  std::string text(const std::string& name, const std::string& otherwise) const;
};

}  // namespace vernier
