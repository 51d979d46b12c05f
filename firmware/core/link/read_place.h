// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstring>
#include <iterator>

#include "hal/slot_store.h"
#include "tables/stored_place.h"

namespace vernier {

/// Reads the record at a numbered place of a slot store. Erased flash memory reads as ones. A record place
/// in the store whose bits are all one counts as not written. A store of an earlier version may not have
/// this place. If the data at the place `number` are longer than one record, this board did not write these
/// data. The place then counts as written, without a record. Not real-time safe.
template <class Record>
StoredPlace<Record> read_place(SlotStore& store, std::uint32_t number) noexcept {
  constexpr std::uint8_t kErased = 0xff;
  constexpr std::uint32_t kSize = sizeof(Record);
  StoredPlace<Record> place;
  std::uint8_t bytes[kSize + 1];
  const HalFault first = store.read_record(number, bytes, 1);
  if (first == HalFault::kNoReading || first == HalFault::kNoDevice) return place;
  place.written = true;
  if (store.read_record(number, bytes, kSize + 1) == HalFault::kNone &&
      (bytes[kSize] != kErased || !store.reads_ones_where_erased()))
    return place;
  if (store.read_record(number, bytes, kSize) != HalFault::kNone) return place;
  place.written = std::any_of(bytes, bytes + kSize, [](std::uint8_t byte) { return byte != kErased; });
  std::memcpy(&place.record, bytes, kSize);
  return place;
}

}  // namespace vernier
