// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/cycle/exchange.h"

#include <gtest/gtest.h>

#include <thread>

#include "firmware/core/cycle/cycle.h"

namespace vernier {
namespace {

TEST(SharedCount, CountsBeyond32Bits) {
  SharedCount count;
  EXPECT_EQ(count.load(), 0u);
  for (const std::uint64_t value :
       {1ull, 0xffffffffull, 0x100000000ull, 0x1ffffffffull, 0xffffffffffffffffull}) {
    count.store(value);
    EXPECT_EQ(count.load(), value);
  }
}

// Over the carry of the low half a reader sees the number before or after it, never a mixture, and no number
// goes back.
TEST(SharedCount, ReaderNeverSeesHalfACount) {
  SharedCount count;
  constexpr std::uint64_t kFirst = 0xffffff00ull, kLast = kFirst + 200'000;
  count.store(kFirst);
  std::thread writer([&] {
    for (std::uint64_t value = kFirst; value <= kLast; ++value) count.store(value);
  });
  std::uint64_t before = 0;
  while (before < kLast) {
    const std::uint64_t now = count.load();
    ASSERT_GE(now, before);
    ASSERT_GE(now, kFirst);
    ASSERT_LE(now, kLast);
    before = now;
  }
  writer.join();
}

TEST(History, KeepsAsManyAsItWasMadeFor) {
  History<TouchRecord> history(4);
  TouchRecord touch;
  for (std::int64_t i = 0; i < 10; ++i) touch.time_ns = i, history.add(touch);
  EXPECT_EQ(history.count(), 10u);
  EXPECT_EQ(history.oldest(), 6u);
  EXPECT_FALSE(history.read(5, touch));
  ASSERT_TRUE(history.read(6, touch));
  EXPECT_EQ(touch.time_ns, 6);
  EXPECT_FALSE(history.read(10, touch));
}

// What the tick needs of a small target's memory; Exchange was 1.4 MB and Cycle 75 KB.
TEST(Sizes, AreThoseOfASmallTarget) {
  EXPECT_LT(sizeof(Exchange), 4096u);
  EXPECT_LT(sizeof(BoundProgram), 8192u);
  EXPECT_LT(sizeof(Cycle), 8192u);
}

}  // namespace
}  // namespace vernier
