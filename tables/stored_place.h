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

/// The valid records of two places, by age. is_valid(record) decides.
template <class Record>
struct ByAge {
  const StoredPlace<Record>* newest = nullptr;  // null: no valid record
  const StoredPlace<Record>* other = nullptr;   // the other place, whatever it has
  bool second_counts = false;                   // the newest is in the second place
  bool both = false;                            // both places have a valid record
};
template <class Record>
ByAge<Record> by_age(const StoredPlace<Record>& first, const StoredPlace<Record>& second) noexcept {
  const bool one = first.written && is_valid(first.record), two = second.written && is_valid(second.record);
  if (!one && !two) return {};
  // The sequences of one store differ by one; the unsigned distance stays correct when they wrap.
  const bool second_counts = two && (!one || second.record.sequence - first.record.sequence < UINT32_MAX / 2);
  return {second_counts ? &second : &first, second_counts ? &first : &second, second_counts, one && two};
}

}  // namespace vernier
