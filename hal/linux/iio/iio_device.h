// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Returns the directory of an IIO device. device: a path (with a '/'), used unchanged, or the name or label
/// from the driver ("mcp4922"). A name is searched in the directories of `root`, because the numbers of
/// "iio:device0" change with the order of loading. Returns an empty text with `error` set if no device or
/// several devices have the name. Not real-time safe.
std::string find_iio_device(const std::string& root, const std::string& device, std::string& error);

/// Directory in which the kernel lists IIO devices.
inline constexpr const char* kIioRoot = "/sys/bus/iio/devices";

}  // namespace vernier
