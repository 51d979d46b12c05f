// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vernier {

/// Layout of the block of registers that a controller reads: sequence number, valid bits (bit p for place p),
/// and then two registers for each place.
struct RegisterBlock {
  static constexpr int kSequence = 0, kValid = 1, kValues = 2, kPlaces = 16;
};

}  // namespace vernier
