// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Returns the directory of an IIO device. `device`: a path (with a '/'), which is used without change, or
/// the name or label that the driver gives ("mcp4922"). A name is searched in the directories of `root`,
/// because the number in "iio:device0" depends on the order in which the drivers are loaded. Returns an empty
/// text, and the reason in `error`, if no device or several devices have the name. Not real-time safe.
std::string find_iio_device(const std::string& root, const std::string& device, std::string& error);

/// Directory in which the Linux kernel lists IIO devices.
inline constexpr const char* kIioRoot = "/sys/bus/iio/devices";

}  // namespace vernier
