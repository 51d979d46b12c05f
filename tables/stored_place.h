// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Content of one numbered place of a slot store. A place has room for one record. Each record is stored in
/// two places, and a change overwrites the older of the two records.
template <class Record>
struct StoredPlace {
  bool written = false;  // true: the place contains data, valid or not; erased flash memory (ones) is not
                         // written
  Record record{};
};

/// State of the two places of a record.
enum class StoredPair : std::uint8_t {
  kNothing = 0,  // neither place was ever written
  kIntact = 1,   // this board can have written both contents, and the newest record is valid
  kDamaged = 2,  // any other content: the newest record may be lost
};

/// The valid records of two places, ordered by age. The function is_valid(record) decides whether a record is
/// valid.
template <class Record>
struct ByAge {
  const StoredPlace<Record>* newest = nullptr;  // place with the newest valid record; null if there is no
                                                // valid record
  const StoredPlace<Record>* other = nullptr;   // the other place, with any content
  bool second_counts = false;                   // true: the newest record is in the second place
  bool both = false;                            // true: both places contain a valid record
};
template <class Record>
ByAge<Record> by_age(const StoredPlace<Record>& first, const StoredPlace<Record>& second) noexcept {
  const bool one = first.written && is_valid(first.record), two = second.written && is_valid(second.record);
  if (!one && !two) return {};
  // The sequence numbers of the two records in one store differ by one. The unsigned difference of
  // two sequence numbers is also correct when the numbers wrap around.
  const bool second_counts = two && (!one || second.record.sequence - first.record.sequence < UINT32_MAX / 2);
  return {second_counts ? &second : &first, second_counts ? &first : &second, second_counts, one && two};
}

}  // namespace vernier
