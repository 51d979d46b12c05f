// SPDX-License-Identifier: GPL-3.0-or-later
#include "tables/slots.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tables/checksum.h"

namespace vernier::slots_test {
namespace {

/// The two places of a store.
struct Places {
  SlotPlace place[2]{};
  void put(const SlotChange& change) { place[change.place] = {true, change.record}; }
  Slots load() const { return Slots::load(place[0], place[1]); }
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
    SlotChange change = slots.start_trial(100 * round, 0);
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
    const SlotChange change = confirm ? slots.confirm() : slots.start_trial(7, 0);
    for (std::size_t cut = 0; cut < sizeof(SlotRecord); ++cut) {
      Places torn = places;
      if (cut > 0) torn.place[change.place].written = true;
      std::memcpy(&torn.place[change.place].record, &change.record, cut);
      const Slots found = torn.load();
      // The bytes may happen to be the same from the cut on: then the write was whole.
      if (std::memcmp(&torn.place[change.place].record, &change.record, sizeof(SlotRecord)) == 0) continue;
      EXPECT_EQ(found.confirmed(), slots.confirmed()) << cut;
      const bool begun = std::memcmp(&torn.place[change.place].record, &places.place[change.place].record,
                                     sizeof(SlotRecord)) != 0;
      if (!begun) continue;
      // Also a flipped bit looks like this: the newest record may be lost.
      EXPECT_EQ(found.places(), StoredPair::kDamaged) << cut;
      EXPECT_EQ(found.trial(), kNoSlot) << "a reset ends it";
    }
    places.put(change), slots.stored(change);
  }
}

TEST(Slots, SenselessRecordIsNotFollowed) {
  Places places;
  Slots slots;
  const SlotChange change = slots.start_trial(5, 0);
  places.put(change);
  ASSERT_TRUE(is_valid(places.place[change.place].record));
  for (std::size_t bit = 0; bit < 8 * sizeof(SlotRecord); ++bit) {
    SlotRecord record = change.record;
    auto* const bytes = reinterpret_cast<std::uint8_t*>(&record);
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << bit % 8));
    EXPECT_FALSE(is_valid(record)) << bit;
  }
}

// Each condition of a record alone, with a checksum that is right.
TEST(Slots, RecordIsValidOnlyWithSlotsThatExist) {
  const auto with = [](auto change) {
    SlotRecord record = Slots{}.start_trial(5, 0).record;
    change(record);
    record.checksum = crc32c(reinterpret_cast<const std::uint8_t*>(&record), offsetof(SlotRecord, checksum));
    return is_valid(record);
  };
  EXPECT_TRUE(with([](SlotRecord&) {}));
  EXPECT_FALSE(with([](SlotRecord& r) { r.magic ^= 1; }));
  EXPECT_FALSE(with([](SlotRecord& r) { r.reserved = 1; }));
  EXPECT_FALSE(with([](SlotRecord& r) { r.reserved2 = 1; }));
  EXPECT_FALSE(with([](SlotRecord& r) { r.confirmed = kSlotCount; }));
  EXPECT_FALSE(with([](SlotRecord& r) { r.trial = kSlotCount; }));
  EXPECT_TRUE(with([](SlotRecord& r) { r.confirmed = 1, r.trial = 0; }));
  EXPECT_TRUE(with([](SlotRecord& r) { r.confirmed = 1, r.trial = kNoSlot; }));
  EXPECT_FALSE(with([](SlotRecord& r) { r.confirmed = r.trial = 1; })) << "a trial of what is confirmed";
  EXPECT_TRUE(with([](SlotRecord& r) { r.confirmed = r.trial = kNoSlot; }));
}

// A trial that a damage ended leaves no issue number.
TEST(Slots, TrialThatADamageEndedIsNoLongerInTheRecord) {
  Places places;
  Slots slots = places.load();
  for (int i = 0; i < 3; ++i) {
    const SlotChange change = i % 2 == 0 ? slots.start_trial(5, 0) : slots.confirm();
    places.put(change), slots.stored(change);
  }
  ASSERT_EQ(places.load().trial_issued(), 5U);
  places.place[places.load().revert().place].written = false;
  const Slots found = places.load();
  EXPECT_EQ(found.trial(), kNoSlot);
  EXPECT_EQ(found.trial_issued(), 0U);
}

TEST(Slots, NextChangeOverwritesTheOlderRecord) {
  Places places;
  Slots slots = places.load();
  for (int i = 0; i < 5; ++i) {
    const SlotChange change = i % 2 == 0 ? slots.start_trial(5, 0) : slots.revert();
    places.put(change), slots.stored(change);
    EXPECT_EQ(places.load().revert().place, 1 - change.place) << i;
  }
}

// The record of a confirmation that is lost would bring back the image that was replaced.
TEST(Slots, LostNewestRecordIsADamage) {
  Places places;
  Slots slots = places.load();
  EXPECT_EQ(slots.places(), StoredPair::kNothing);
  std::vector<SlotPlace> olds[2];
  for (int i = 0; i < 6; ++i) {
    const SlotChange change = i % 2 == 0 ? slots.start_trial(5, 0) : slots.confirm();
    const Places before = places;
    places.put(change), slots.stored(change);
    ASSERT_EQ(places.load().places(), StoredPair::kIntact) << i;
    ASSERT_EQ(slots.places(), StoredPair::kIntact) << i;
    for (const SlotPlace& old : olds[change.place]) {
      Places copied = places;
      copied.place[change.place] = old;
      EXPECT_EQ(copied.load().places(), StoredPair::kDamaged) << "an older copy, " << i;
    }
    if (before.place[change.place].written) olds[change.place].push_back(before.place[change.place]);
    if (i == 0) continue;
    Places lost = places;
    lost.place[change.place] = {};
    // The first trial alone is what a power failure before the second record leaves: nothing is confirmed.
    EXPECT_EQ(lost.load().places(), i == 1 ? StoredPair::kIntact : StoredPair::kDamaged) << "deleted, " << i;
    lost.place[change.place].written = true;
    Slots found = lost.load();
    EXPECT_EQ(found.places(), StoredPair::kDamaged) << "unreadable, " << i;
    const SlotChange repair = found.revert();
    EXPECT_EQ(repair.place, change.place);
    lost.put(repair), found.stored(repair);
    EXPECT_EQ(lost.load().places(), StoredPair::kIntact);
    EXPECT_EQ(found.places(), StoredPair::kIntact);
  }
}

// The first record after the loss of both has no record before it in the other place.
TEST(Slots, LostPairIsIntactAfterTwoChanges) {
  Places places;
  places.place[0].written = places.place[1].written = true;
  Slots slots = places.load();
  ASSERT_EQ(slots.places(), StoredPair::kDamaged);
  ASSERT_EQ(slots.confirmed(), kNoSlot);
  for (const StoredPair expected : {StoredPair::kDamaged, StoredPair::kIntact}) {
    const SlotChange change = slots.start_trial(5, 0);
    places.put(change), slots.stored(change);
    EXPECT_EQ(slots.places(), expected);
    EXPECT_EQ(places.load().places(), expected);
  }
}

// The sequence has 32 bits: its first number follows its last one.
TEST(Slots, RecordWithTheFirstSequenceIsNewerThanTheOneWithTheLast) {
  const auto record_of = [](std::uint32_t sequence, std::uint8_t confirmed) {
    SlotRecord record = Slots{}.revert().record;
    record.sequence = sequence, record.confirmed = confirmed;
    record.checksum = crc32c(reinterpret_cast<const std::uint8_t*>(&record), offsetof(SlotRecord, checksum));
    return record;
  };
  const SlotRecord last = record_of(UINT32_MAX, 0), first = record_of(0, 1);
  for (const bool first_place : {false, true}) {
    const Slots slots =
        first_place ? Slots::load({true, first}, {true, last}) : Slots::load({true, last}, {true, first});
    EXPECT_EQ(slots.confirmed(), 1);
    EXPECT_EQ(slots.revert().place, first_place ? 1 : 0) << "the older record is overwritten";
  }
}

TEST(Slots, ConfirmationWithoutATrialKeepsWhatIsConfirmed) {
  Slots slots;
  slots.stored(slots.start_trial(5, 0));
  slots.stored(slots.confirm());
  const std::uint8_t confirmed = slots.confirmed();
  slots.stored(slots.confirm());
  EXPECT_EQ(slots.confirmed(), confirmed);
  EXPECT_EQ(slots.issued(), 5u);
}

TEST(Slots, RecordOfAnotherVersionIsNotUpgraded) {
  SlotRecordV1 old{kSlotMagicV1 + 1, 7, 1000, 2000, 1, 0, 0, 0};
  old.checksum = crc32c(reinterpret_cast<const std::uint8_t*>(&old), offsetof(SlotRecordV1, checksum));
  EXPECT_FALSE(is_valid(upgraded(old)));
  old = {kSlotMagicV1, 7, 3000, 2000, 1, 0, 0, 0};
  old.checksum = crc32c(reinterpret_cast<const std::uint8_t*>(&old), offsetof(SlotRecordV1, checksum));
  EXPECT_EQ(Slots::load({true, upgraded(old)}, {}).newest_issued(), 3000u) << "the newer of the two";
}

TEST(Slots, FloorsRiseWithWhatIsTriedAndNeverFall) {
  Places places;
  Slots slots = places.load();
  const auto take = [&](const SlotChange& change) { places.put(change), slots.stored(change); };
  take(slots.start_trial(100, 3));
  take(slots.revert());
  EXPECT_EQ(places.load().newest_issued(), 100u) << "tried and given up: it does not come back";
  EXPECT_EQ(places.load().security(), 3u);
  take(slots.start_trial(50, 1));
  take(slots.confirm());
  EXPECT_EQ(places.load().newest_issued(), 100u);
  EXPECT_EQ(places.load().security(), 3u);
  EXPECT_EQ(places.load().issued(), 50u);
}

TEST(Slots, RecordOfTheVersionBeforeIsReadAndADamagedOneIsNot) {
  SlotRecordV1 old{kSlotMagicV1, 7, 1000, 2000, 1, 0, 0, 0};
  old.checksum = crc32c(reinterpret_cast<const std::uint8_t*>(&old), offsetof(SlotRecordV1, checksum));
  SlotRecordV1 before = old;
  before.sequence = 6, before.trial = kNoSlot;
  before.checksum = crc32c(reinterpret_cast<const std::uint8_t*>(&before), offsetof(SlotRecordV1, checksum));
  const Slots slots = Slots::load({true, upgraded(old)}, {true, upgraded(before)});
  EXPECT_EQ(slots.places(), StoredPair::kIntact);
  EXPECT_EQ(slots.confirmed(), 1);
  EXPECT_EQ(slots.trial(), 0);
  EXPECT_EQ(slots.issued(), 1000u);
  EXPECT_EQ(slots.newest_issued(), 2000u);
  old.issued = 1001;
  EXPECT_FALSE(is_valid(upgraded(old)));
}

}  // namespace
}  // namespace vernier::slots_test
