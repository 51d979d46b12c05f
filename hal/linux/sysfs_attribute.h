// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "hal/fault.h"

namespace vernier {

/// One attribute of a device in sysfs: a file that contains a number as text. The attribute is opened once,
/// before the first tick. Each read or write is at the beginning of the file. Each read or write of the
/// attribute is a single system call without allocation of memory.
class SysfsAttribute {
 public:
  enum class Use { kRead, kWrite, kBoth };

  /// Returns nullopt and the reason in `error` ("/sys/...: No such file or directory") if the attribute
  /// cannot be opened. Not real-time safe.
  static std::optional<SysfsAttribute> open(const std::string& path, Use use, std::string& error);
  SysfsAttribute(SysfsAttribute&& other) noexcept;
  SysfsAttribute& operator=(SysfsAttribute&& other) noexcept;
  ~SysfsAttribute();

  /// Reserves the attribute for exclusive use. Returns false if another process uses the attribute. Not
  /// real-time safe.
  bool lock() noexcept;

  /// Writes a number and a line feed to the attribute. The function write() returns kRefused if the driver or
  /// the device refused the number. The function is real-time safe if the bus of the device is fast enough.
  HalFault write(std::int64_t value) noexcept;
  /// Writes a word (for example "normal") to the attribute. Not real-time safe.
  HalFault write(const std::string& word) noexcept;
  /// Reads a decimal number, with or without a fraction, in millionths. Further digits are omitted. The
  /// function read_micro() returns kNoReading if the driver gave an error, an empty text, or text that is not
  /// a number. Without a reading, `micro` is not changed. The duration of the call depends on the driver.
  HalFault read_micro(std::int64_t& micro) noexcept;
  /// Reads a whole number. The errors are those of read_micro. Not real-time safe.
  HalFault read(std::int64_t& value) noexcept;

 private:
  explicit SysfsAttribute(int fd) noexcept : fd_(fd) {}
  HalFault write_text(const char* text, std::size_t size) noexcept;

  int fd_ = -1;
};

/// Converts text to millionths: "-12.345678\n" gives -12345678. Returns false if the text is not such a
/// number, or if the number is beyond ±10^12. The function parse_micro does not allocate memory.
bool parse_micro(const char* text, std::size_t size, std::int64_t& micro) noexcept;

}  // namespace vernier
