// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Why a device could not do what it was asked. A read that fails leaves its result untouched.
enum class HalFault : std::uint8_t {
  kNone,
  kNoReading,  // the device answered nothing in time, or has nothing yet
  kNoDevice,   // no such axis, input or output on this board
  kRefused,    // the device or the operating system said no
};

}  // namespace vernier
