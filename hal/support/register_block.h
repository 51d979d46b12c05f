// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vernier {

/// Layout of the block of registers that a controller reads: sequence number, valid bits, and then two
/// registers for each value. Bit p of the valid bits states whether value p of the block is valid.
struct RegisterBlock {
  static constexpr int kSequence = 0, kValid = 1, kValues = 2, kPlaces = 16;
};

}  // namespace vernier
