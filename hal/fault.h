// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Reason why a device could not execute a call. If reading a device fails, the function does not
/// change its result argument.
enum class HalFault : std::uint8_t {
  kNone,
  kNoReading,  // the device did not answer in time, or there is no reading yet
  kNoDevice,   // the board has no axis, input or output with this index
  kRefused,    // the device or the operating system refused the call
};

}  // namespace vernier
