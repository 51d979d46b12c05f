// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Reason why a device could not execute a call. A failed read does not change its result argument.
enum class HalFault : std::uint8_t {
  kNone,
  kNoReading,  // no answer of the device in time, or no reading yet
  kNoDevice,   // no such axis, input or output on this board
  kRefused,    // the device or the operating system refused
};

}  // namespace vernier
