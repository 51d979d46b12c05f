// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Directory of an IIO device. device: a path (with a '/'), used as it is, or the name or label from the
/// driver ("mcp4922"). A name is searched in the directories of `root`, because the numbers of "iio:device0"
/// change with the order of loading. Empty with `error` set: no device or several devices of that name.
/// setup.
std::string find_iio_device(const std::string& root, const std::string& device, std::string& error);

/// Where the kernel lists IIO devices.
inline constexpr const char* kIioRoot = "/sys/bus/iio/devices";

}  // namespace vernier
