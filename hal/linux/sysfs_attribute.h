// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "hal/fault.h"

namespace vernier {

/// One attribute of a device in sysfs: a number as text. The attribute is opened once in setup. Each read or
/// write at its beginning is a single system call without allocation.
class SysfsAttribute {
 public:
  enum class Use { kRead, kWrite, kBoth };

  /// Returns nullopt with `error` set ("/sys/...: No such file or directory") if the attribute cannot be
  /// opened. Not real-time safe.
  static std::optional<SysfsAttribute> open(const std::string& path, Use use, std::string& error);
  SysfsAttribute(SysfsAttribute&& other) noexcept;
  SysfsAttribute& operator=(SysfsAttribute&& other) noexcept;
  ~SysfsAttribute();

  /// Takes the attribute for exclusive use; false if another process uses it. Not real-time safe.
  bool lock() noexcept;

  /// Writes the number and a line feed. kRefused: the driver or the device refused. realtime, if the bus of
  /// the device is fast enough.
  HalFault write(std::int64_t value) noexcept;
  /// Writes a word ("normal"). Not real-time safe.
  HalFault write(const std::string& word) noexcept;
  /// Reads a decimal number, with or without a fraction, in millionths; further digits are cut off.
  /// kNoReading: the driver gave an error, an empty text, or no number; `micro` is then not changed. The call
  /// takes as long as the driver needs.
  HalFault read_micro(std::int64_t& micro) noexcept;
  /// Reads a whole number; errors as for read_micro. Not real-time safe.
  HalFault read(std::int64_t& value) noexcept;

 private:
  explicit SysfsAttribute(int fd) noexcept : fd_(fd) {}
  HalFault write_text(const char* text, std::size_t size) noexcept;

  int fd_ = -1;
};

/// Reads "-12.345678\n" as -12345678 millionths. Returns false: no such number, or beyond ±10^12. parse_micro
/// does not allocate memory.
bool parse_micro(const char* text, std::size_t size, std::int64_t& micro) noexcept;

}  // namespace vernier
