// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/plan/hypothesis.h"
#include "tools/text/error.h"

namespace vernier::split_test {

using namespace vernier::effects;
using namespace vernier::plan;
using namespace vernier::text;
namespace {

using testing::ElementsAre;

TEST(SplitHypotheses, CutsOnlyWhereAnEffectBegins) {
  const std::vector<Effect>& all = built_in_effects();
  EXPECT_THAT(split_hypotheses({"backlash,servo-lag"}, all), ElementsAre("backlash", "servo-lag"));
  EXPECT_THAT(split_hypotheses({"backlash:axis=X,dof=X,servo-lag:axis=X,form=plain"}, all),
              ElementsAre("backlash:axis=X,dof=X", "servo-lag:axis=X,form=plain"));
  EXPECT_THAT(split_hypotheses({"backlash:axis=X,dof=X", "servo-lag"}, all),
              ElementsAre("backlash:axis=X,dof=X", "servo-lag"));
}

TEST(SplitHypotheses, WantsTwo) {
  const std::vector<Effect>& all = built_in_effects();
  EXPECT_THROW(split_hypotheses({"backlash"}, all), InputError);
  EXPECT_THROW(split_hypotheses({"backlash,servo-lag,creep"}, all), InputError);
  EXPECT_THROW(split_hypotheses({"backlash,no-such-effect"}, all), InputError);
}

}  // namespace
}  // namespace vernier::split_test
