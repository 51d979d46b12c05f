// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Reason why a device could not execute a call. If a read fails, its result argument is not changed.
enum class HalFault : std::uint8_t {
  kNone,
  kNoReading,  // the device did not answer in time, or there is no reading yet
  kNoDevice,   // the board has no axis, input or output with this index
  kRefused,    // the device or the operating system refused the call
};

}  // namespace vernier
