// SPDX-License-Identifier: GPL-3.0-or-later
#include "tables/operator_record.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tables/checksum.h"

namespace vernier::operator_record_test {
namespace {

using State = StoredPair;

/// The two places of a store.
struct Store {
  OperatorPlace place[2];
  void put(const OperatorChange& change) { place[change.place - kOperatorPlace] = {true, change.record}; }
  OperatorRecords load() const { return OperatorRecords::load(place[0], place[1]); }
};

OperatorState out_of_use() {
  OperatorState state;
  state.out = 1;
  return state;
}

OperatorRecord record_of(std::uint32_t sequence) {
  OperatorRecord record{kOperatorMagic, sequence, out_of_use(), 0};
  record.checksum =
      crc32c(reinterpret_cast<const std::uint8_t*>(&record), offsetof(OperatorRecord, checksum));
  return record;
}

TEST(OperatorRecord, IsValidWithItsMagicSequenceAndChecksum) {
  EXPECT_TRUE(is_valid(record_of(1)));
  EXPECT_TRUE(is_valid(record_of(UINT32_MAX)));
  EXPECT_FALSE(is_valid(record_of(0))) << "0 is no record";
  OperatorRecord record = record_of(1);
  record.magic ^= 1;
  record.checksum =
      crc32c(reinterpret_cast<const std::uint8_t*>(&record), offsetof(OperatorRecord, checksum));
  EXPECT_FALSE(is_valid(record)) << "of another version";
  record = record_of(1);
  record.checksum ^= 1;
  EXPECT_FALSE(is_valid(record));
}

TEST(OperatorRecords, OfAStoreThatWasNeverWrittenAreNothing) {
  const OperatorRecords records = Store{}.load();
  EXPECT_EQ(records.places(), State::kNothing);
  EXPECT_FALSE(records.known());
  EXPECT_EQ(records.state(), OperatorState{});
}

TEST(OperatorRecords, FirstChangeIsWrittenToBothPlaces) {
  Store store;
  OperatorRecords records = store.load();
  OperatorChange change = records.change_to(out_of_use());
  EXPECT_EQ(change.place, kOperatorPlace);
  store.put(change), records.stored(change);
  EXPECT_EQ(records.places(), State::kDamaged) << "the other place is not written yet";
  EXPECT_EQ(store.load().places(), State::kDamaged);
  EXPECT_TRUE(store.load().known());
  change = records.change_to(out_of_use());
  EXPECT_EQ(change.place, kOperatorPlace + 1);
  store.put(change), records.stored(change);
  EXPECT_EQ(records.places(), State::kIntact);
  EXPECT_EQ(store.load().places(), State::kIntact);
  EXPECT_EQ(records.change_to(out_of_use()).place, kOperatorPlace);
}

TEST(OperatorRecords, NewerOfTwoCountsAlsoWhereTheSequenceBeginsAnew) {
  const auto load = [](std::uint32_t first, std::uint32_t second) {
    return OperatorRecords::load({true, record_of(first)}, {true, record_of(second)});
  };
  const auto next = [](const OperatorRecords& records) { return records.change_to({}).record.sequence; };
  EXPECT_EQ(next(load(4, 5)), 6u);
  EXPECT_EQ(next(load(5, 4)), 6u);
  EXPECT_EQ(load(5, 4).change_to({}).place, kOperatorPlace + 1);
  EXPECT_EQ(load(4, 5).change_to({}).place, kOperatorPlace);
  EXPECT_EQ(next(load(UINT32_MAX, 1)), 2u);
  EXPECT_EQ(next(load(1, UINT32_MAX)), 2u);
  EXPECT_EQ(next(load(UINT32_MAX - 1, UINT32_MAX)), 1u);
  EXPECT_EQ(load(4, 5).places(), State::kIntact);
  EXPECT_EQ(load(UINT32_MAX, 1).places(), State::kIntact);
  EXPECT_EQ(load(4, 6).places(), State::kDamaged) << "a change between the two is lost";
  EXPECT_EQ(load(4, 4).places(), State::kDamaged);
}

// A state that only one place has is lost with this place.
TEST(OperatorRecords, StateIsStoredOnceUntilBothPlacesHaveIt) {
  Store store;
  OperatorRecords records = store.load();
  for (int i = 0; i < 3; ++i) {
    const OperatorChange change = records.change_to(out_of_use());
    store.put(change), records.stored(change);
    EXPECT_EQ(store.load().once(), i == 0) << i;
  }
  const OperatorChange change = records.change_to({});
  store.put(change);
  ASSERT_EQ(store.load().places(), State::kIntact);
  EXPECT_TRUE(store.load().once()) << "the other place has the state before";
}

TEST(OperatorRecords, OneDamagedPlaceLeavesTheOther) {
  OperatorRecord damaged = record_of(5);
  damaged.checksum ^= 1;
  for (const OperatorPlace& bad : {OperatorPlace{true, damaged}, OperatorPlace{}}) {
    const OperatorRecords second = OperatorRecords::load(bad, {true, record_of(4)});
    EXPECT_TRUE(second.known());
    EXPECT_EQ(second.places(), State::kDamaged);
    EXPECT_EQ(second.change_to({}).place, kOperatorPlace) << "over the damaged one";
    const OperatorRecords first = OperatorRecords::load({true, record_of(4)}, bad);
    EXPECT_TRUE(first.known());
    EXPECT_EQ(first.change_to({}).place, kOperatorPlace + 1);
  }
  const OperatorRecords none = OperatorRecords::load({true, damaged}, {true, damaged});
  EXPECT_FALSE(none.known());
  EXPECT_EQ(none.places(), State::kDamaged);
}

TEST(OperatorRecords, PowerCutAtAnyByteLeavesTheStateBeforeOrDamage) {
  Store store;
  OperatorRecords records;
  for (int i = 0; i < 2; ++i) {
    const OperatorChange change = records.change_to({});
    store.put(change), records.stored(change);
  }
  const OperatorChange change = records.change_to(out_of_use());
  for (std::size_t cut = 0; cut < sizeof(OperatorRecord); ++cut) {
    Store torn = store;
    std::memcpy(&torn.place[change.place - kOperatorPlace].record, &change.record, cut);
    const OperatorRecords found = torn.load();
    if (found.places() == State::kIntact) {
      EXPECT_EQ(found.state(), OperatorState{}) << cut;
    }
    EXPECT_TRUE(found.known());
  }
}

TEST(OperatorAxis, IsMadeFromTheNameAndNeverZero) {
  EXPECT_NE(operator_axis("X", 1), operator_axis("Y", 1));
  EXPECT_EQ(operator_axis("XY", 1), operator_axis("X", 1));
  EXPECT_EQ(operator_axis("", 0), 1u) << "the checksum of nothing is 0, which says: no axis";
}

}  // namespace
}  // namespace vernier::operator_record_test
