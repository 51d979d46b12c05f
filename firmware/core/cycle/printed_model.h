// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"

namespace vernier {

/// The machine that this firmware was built with (CMake: -DVERNIER_MODEL=DIR of `vernier compile -o DIR`). An
/// image of the same equation runs its compiled form, any other image is interpreted. equation: null if the
/// firmware was built without a machine.
struct PrintedModel {
  std::uint64_t fingerprint = 0;
  PrintedEquation equation = nullptr;
};
PrintedModel printed_model() noexcept;

}  // namespace vernier
