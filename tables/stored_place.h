// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Contents of one place of the store. A record is stored in two places; a change overwrites the older one.
template <class Record>
struct StoredPlace {
  bool written = false;  // something is there, valid or not; erased flash (ones) is not written
  Record record{};
};

/// State of the two places of a record.
enum class StoredPair : std::uint8_t {
  kNothing = 0,  // no place was ever written
  kIntact = 1,   // all that this board can have written, and the newest record is valid
  kDamaged = 2,  // all other contents: the newest record may be lost
};

}  // namespace vernier
