// SPDX-License-Identifier: GPL-3.0-or-later
#include "tables/slots.h"

#include <gtest/gtest.h>

#include <cstring>

namespace vernier::slots_test {
namespace {

/// The two places of a store.
struct Places {
  SlotRecord record[2]{};
  void put(const SlotChange& change) { record[change.place] = change.record; }
  Slots load() const { return Slots::load(record[0], record[1]); }
};

TEST(Slots, BlankStoreHasNothingAndOffersASlot) {
  const Slots slots = Places{}.load();
  EXPECT_EQ(slots.confirmed(), kNoSlot);
  EXPECT_EQ(slots.trial(), kNoSlot);
  EXPECT_EQ(slots.free_slot(), 0);
  EXPECT_EQ(slots.issued(), 0u);
}

TEST(Slots, TriesConfirmsAndNeverOffersTheConfirmedSlot) {
  Places places;
  Slots slots = places.load();
  for (std::uint64_t round = 1; round <= 20; ++round) {
    const std::uint8_t slot = slots.free_slot();
    ASSERT_NE(slot, slots.confirmed());
    SlotChange change = slots.start_trial(100 * round);
    places.put(change), slots.stored(change);
    EXPECT_EQ(places.load().trial(), slot);
    EXPECT_EQ(slots.free_slot(), kNoSlot) << "both slots are taken during a trial";
    const bool keep = round % 3 != 0;
    const std::uint8_t before = slots.confirmed();
    change = keep ? slots.confirm() : slots.revert();
    places.put(change), slots.stored(change);
    EXPECT_EQ(places.load().confirmed(), keep ? slot : before);
    EXPECT_EQ(places.load().trial(), kNoSlot);
    if (keep) {
      EXPECT_EQ(places.load().issued(), 100 * round);
    }
  }
}

TEST(Slots, RecordCutAtAnyByteLeavesTheStateBefore) {
  Places places;
  Slots slots = places.load();
  for (const bool confirm : {false, true, false, true}) {
    const SlotChange change = confirm ? slots.confirm() : slots.start_trial(7);
    for (std::size_t cut = 0; cut < sizeof(SlotRecord); ++cut) {
      Places torn = places;
      std::memcpy(&torn.record[change.place], &change.record, cut);
      const Slots found = torn.load();
      // The bytes may happen to be the same from the cut on: then the write was whole.
      if (std::memcmp(&torn.record[change.place], &change.record, sizeof(SlotRecord)) == 0) continue;
      EXPECT_EQ(found.confirmed(), slots.confirmed()) << cut;
      EXPECT_EQ(found.trial(), slots.trial()) << cut;
    }
    places.put(change), slots.stored(change);
  }
}

TEST(Slots, SenselessRecordIsNotFollowed) {
  Places places;
  Slots slots;
  const SlotChange change = slots.start_trial(5);
  places.put(change);
  ASSERT_TRUE(is_valid(places.record[change.place]));
  for (std::size_t bit = 0; bit < 8 * sizeof(SlotRecord); ++bit) {
    SlotRecord record = change.record;
    auto* const bytes = reinterpret_cast<std::uint8_t*>(&record);
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << bit % 8));
    EXPECT_FALSE(is_valid(record)) << bit;
  }
}

}  // namespace
}  // namespace vernier::slots_test
