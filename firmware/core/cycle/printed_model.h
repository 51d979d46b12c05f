// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"

namespace vernier {

/// The machine model that is built into this firmware (CMake: -DVERNIER_MODEL=DIR of `vernier compile -o
/// DIR`). A correction image with the same equation as the built-in machine runs in the compiled form; any
/// other image is interpreted. equation: null if the firmware was built without a machine.
struct PrintedModel {
  std::uint64_t fingerprint = 0;
  PrintedEquation equation = nullptr;
};
PrintedModel printed_model() noexcept;

}  // namespace vernier
