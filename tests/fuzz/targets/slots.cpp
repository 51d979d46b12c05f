// SPDX-License-Identifier: GPL-3.0-or-later
#include "tables/slots.h"

#include <cstring>

#include "tables/checksum.h"
#include "tests/fuzz/target.h"

namespace vernier::fuzz {
namespace {

/// Both records of a store, with their sums put right where the byte before them is odd.
void take(Bytes bytes) {
  SlotPlace places[kSlotRecordCount] = {};
  Pieces pieces(bytes);
  for (SlotPlace& place : places) {
    const int kind = pieces.byte();
    const bool mend = kind % 2 == 1;
    place.written = kind % 4 != 2;
    SlotRecord& record = place.record;
    auto* const raw = reinterpret_cast<std::uint8_t*>(&record);
    for (std::size_t i = 0; i < sizeof record; ++i) raw[i] = pieces.byte();
    if (!mend) continue;
    record.magic = kSlotMagic;
    record.checksum = crc32c(raw, offsetof(SlotRecord, checksum));
  }
  Slots slots = Slots::load(places[0], places[1]);
  const std::uint64_t floor = slots.newest_issued();
  const std::uint32_t security = slots.security();
  if (floor == UINT64_MAX) return;  // no upload can be above it: the uploader refuses them all
  for (int step = 0; step < 4; ++step) {
    const std::uint8_t free = slots.free_slot();
    expect(free == kNoSlot || (free < kSlotCount && free != slots.confirmed()),
           "an image would be written over the one that counts");
    const SlotChange change = free == kNoSlot ? slots.confirm() : slots.start_trial(floor + 1, security);
    expect(change.place < kSlotRecordCount, "a record without a place");
    slots.stored(change);
    expect(slots.newest_issued() >= floor && slots.security() >= security, "a floor that falls");
  }
}

const Registered kTarget("slots", take);

}  // namespace
}  // namespace vernier::fuzz
