// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vernier {

/// Type of the value that a setting of a device has. kUnknown: there is no kind of device with this setting.
enum class SettingType { kUnknown, kText, kNumber, kWholeNumber };
/// Returns the type of the setting `name` for a kind of device. Not real-time safe.
SettingType type_of_setting(const std::string& kind, const std::string& name);

/// Connection of a signal of the board to a device: the kind of device (open_devices.cpp), and its settings
/// as they are in the board file.
struct SignalSource {
  std::string kind;                                // "can", "iio", "pwm", "sim" ...; empty: the signal is not
                                                   // connected
  std::map<std::string, std::string> texts;        // all settings that are texts
  std::map<std::string, double> numbers;           // all settings that are numbers
  std::string where;                               // place in the board file: "board.toml:12: axis.X.output"
  std::map<std::string, std::string> places = {};  // place of each setting in the board file, with its line

  [[noreturn]] void fail(const std::string& what) const;  // throws BoardError
  /// Throws BoardError as fail() does, with the line of the setting `name`.
  [[noreturn]] void fail_at(const std::string& name, const std::string& what) const;
  /// Throws BoardError if the board file has a setting for this signal that is not in `names`. The setting
  /// kind is always permitted.
  void only(const std::vector<const char*>& names) const;
  const std::string& text(const std::string& name) const;  // throws BoardError if the setting is absent
  double number(const std::string& name) const;            // throws BoardError if the setting is absent
  double number(const std::string& name, double otherwise) const;
  /// Returns the setting `name` as a whole number from low to high; throws BoardError if the setting is
  /// absent or not valid.
  std::int64_t whole(const std::string& name, std::int64_t low, std::int64_t high) const;
  std::int64_t whole(const std::string& name, std::int64_t otherwise, std::int64_t low,
                     std::int64_t high) const;
  std::string text(const std::string& name, const std::string& otherwise) const;
};

}  // namespace vernier
