// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/link/read_place.h"

#include <gtest/gtest.h>

#include <vector>

#include "tables/operator_record.h"
#include "tables/slots.h"

namespace vernier::read_place_test {
namespace {

/// A store with one place.
class OnePlace : public SlotStore {
 public:
  std::vector<std::uint8_t> bytes;
  HalFault without = HalFault::kNoReading;  // where there are no bytes at all
  bool ones = true;

  std::uint32_t capacity() const noexcept override { return 0; }
  HalFault read_record(std::uint32_t, std::uint8_t* into, std::uint32_t size) noexcept override {
    if (bytes.empty()) return without;
    if (size > bytes.size()) return HalFault::kRefused;
    std::copy_n(bytes.begin(), size, into);
    return HalFault::kNone;
  }
  bool reads_ones_where_erased() const noexcept override { return ones; }
  HalFault write_record(std::uint32_t, const std::uint8_t*, std::uint32_t) noexcept override {
    return HalFault::kRefused;
  }
  HalFault read_image(std::uint32_t, std::uint32_t, std::uint8_t*, std::uint32_t) noexcept override {
    return HalFault::kNoReading;
  }
  HalFault write_image(std::uint32_t, std::uint32_t, const std::uint8_t*, std::uint32_t) noexcept override {
    return HalFault::kRefused;
  }
  HalFault finish_image(std::uint32_t, std::uint32_t) noexcept override { return HalFault::kRefused; }
};

/// Every kind of record that a store has.
template <class Record>
class ReadPlace : public testing::Test {};
using Records = testing::Types<SlotRecord, SlotRecordV1, OperatorRecord>;
TYPED_TEST_SUITE(ReadPlace, Records);

TYPED_TEST(ReadPlace, PlaceThatIsNotThereIsNotWritten) {
  OnePlace store;
  for (const HalFault nothing : {HalFault::kNoReading, HalFault::kNoDevice}) {
    store.without = nothing;
    EXPECT_FALSE(read_place<TypeParam>(store, 0).written);
  }
  store.without = HalFault::kRefused;
  EXPECT_TRUE(read_place<TypeParam>(store, 0).written) << "an empty file, or one that cannot be read";
}

TYPED_TEST(ReadPlace, ErasedFlashIsNotWrittenAndOneOtherByteIs) {
  OnePlace store;
  store.bytes.assign(sizeof(TypeParam), 0xff);
  EXPECT_FALSE(read_place<TypeParam>(store, 0).written);
  store.bytes.back() = 0xfe;
  EXPECT_TRUE(read_place<TypeParam>(store, 0).written);
}

TYPED_TEST(ReadPlace, FurtherBytesAreNoneOfARecord) {
  OnePlace store;
  store.bytes.assign(sizeof(TypeParam), 0);
  store.bytes[0] = 7;
  EXPECT_EQ(read_place<TypeParam>(store, 0).record.magic, 7u);
  store.bytes.push_back(0xff);
  EXPECT_EQ(read_place<TypeParam>(store, 0).record.magic, 7u) << "flash behind the record is erased";
  store.ones = false;
  EXPECT_EQ(read_place<TypeParam>(store, 0).record.magic, 0u) << "a file has no bytes behind it";
  EXPECT_TRUE(read_place<TypeParam>(store, 0).written);
  store.ones = true;
  store.bytes.back() = 0;
  EXPECT_EQ(read_place<TypeParam>(store, 0).record.magic, 0u);
  store.bytes.resize(sizeof(TypeParam) - 1);
  EXPECT_EQ(read_place<TypeParam>(store, 0).record.magic, 0u) << "cut";
  EXPECT_TRUE(read_place<TypeParam>(store, 0).written);
}

}  // namespace
}  // namespace vernier::read_place_test
