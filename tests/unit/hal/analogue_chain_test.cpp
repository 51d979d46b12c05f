// SPDX-License-Identifier: GPL-3.0-or-later
#include "hal/sim/analogue_chain.h"

#include <gtest/gtest.h>

namespace vernier::analogue_chain_test {
namespace {

TEST(AnalogueChain, EightBitsAreThePublishedConverter) {
  const AnalogueChain chain(8);
  // Published: code 127 gives 5 V, no correction; a step is 0.0392157 V or 0.980392 um (six digits printed).
  EXPECT_EQ(chain.code_for(AxisTravel(0)), 127);
  EXPECT_NEAR(chain.step_nm(), 980.392, 0.0005);
  EXPECT_NEAR(chain.offset_nm(128), 980.392, 0.0005);
  EXPECT_DOUBLE_EQ(chain.offset_nm(127), 0);
}

TEST(AnalogueChain, PublishedCheckOfVoltsAndMicrometres) {
  // 3 V and 7 V are -50 and +50 um: 51 codes of 10/255 V on either side of zero.
  const AnalogueChain chain(8);
  EXPECT_EQ(chain.code_for(AxisTravel(50'000)), 127 + 51);
  EXPECT_NEAR(chain.offset_nm(127 + 51), 50'000, 1e-6);
  EXPECT_NEAR(chain.offset_nm(127 - 51), -50'000, 1e-6);
}

TEST(AnalogueChain, CodesReachEquallyFarAndNoFurtherThanTheVolts) {
  for (const unsigned bits : {8u, 16u}) {
    const AnalogueChain chain(bits);
    EXPECT_DOUBLE_EQ(chain.offset_nm(chain.last_code()), -chain.offset_nm(0));
    EXPECT_LE(chain.offset_nm(chain.last_code()), 125'000);
    EXPECT_GE(chain.offset_nm(chain.last_code()), 125'000 - chain.step_nm());
  }
}

TEST(AnalogueChain, RoundsToTheNearestCode) {
  for (const unsigned bits : {8u, 16u}) {
    const AnalogueChain chain(bits);
    for (std::int64_t nm = -124'000; nm <= 124'000; nm += 97) {
      ASSERT_FALSE(chain.saturates(AxisTravel(nm)));
      ASSERT_LE(std::abs(chain.offset_nm(chain.code_for(AxisTravel(nm))) - static_cast<double>(nm)),
                chain.step_nm() / 2 + 1e-9);
    }
  }
}

TEST(AnalogueChain, BeyondTheCodesIsHeldAndSaid) {
  const AnalogueChain chain(8);
  EXPECT_TRUE(chain.saturates(AxisTravel(125'000)));
  EXPECT_EQ(chain.code_for(AxisTravel(1'000'000'000'000)), chain.last_code());
  EXPECT_EQ(chain.code_for(AxisTravel(-1'000'000'000'000)), 0);
  EXPECT_TRUE(chain.saturates(AxisTravel(-125'000)));
}

}  // namespace
}  // namespace vernier::analogue_chain_test
