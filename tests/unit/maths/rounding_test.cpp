// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/rounding.h"

#include <gtest/gtest.h>

namespace vernier::rounding_test {

using vernier::maths::rounded_to;
namespace {

TEST(RoundedTo, GivesTheDoubleOfTheDecimal) {
  // 2421 * 0.1 is 242.10000000000002.
  ASSERT_NE(2421 * 0.1, 242.1);
  EXPECT_EQ(rounded_to(242.13, 0.1), 242.1);
  EXPECT_EQ(rounded_to(-102.8000004, 0.1), -102.8);
  EXPECT_EQ(rounded_to(0.0307, 0.001), 0.031);
}

TEST(RoundedTo, TakesWholePowersOfTenToo) {
  EXPECT_EQ(rounded_to(242.13, 1), 242.0);
  EXPECT_EQ(rounded_to(1849, 100), 1800.0);
}

}  // namespace
}  // namespace vernier::rounding_test
