// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"

namespace vernier {

/// The machine model that is compiled into this firmware (CMake: -DVERNIER_MODEL=DIR of `vernier compile -o
/// DIR`). If a correction image has the same equation as this machine, the board executes the compiled form.
/// Any other image is interpreted. `equation`: null if no machine is compiled into the firmware.
struct PrintedModel {
  std::uint64_t fingerprint = 0;
  PrintedEquation equation = nullptr;
};
PrintedModel printed_model() noexcept;

}  // namespace vernier
