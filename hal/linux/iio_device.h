// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Directory of an IIO device. device: a path (with a '/'), taken as it is, or the name or label that the
/// driver gives it ("mcp4922"), looked up in the directories of `root`, since the numbers of "iio:device0"
/// change with the order of loading. Empty with `error` set: none of that name, or several. setup.
std::string find_iio_device(const std::string& root, const std::string& device, std::string& error);

/// Where the kernel lists IIO devices.
inline constexpr const char* kIioRoot = "/sys/bus/iio/devices";

}  // namespace vernier
