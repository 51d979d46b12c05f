// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/thresholds.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace vernier::diagnose_test {

using namespace vernier::diagnose;
namespace {

TEST(Thresholds, EachIsVisitedOnceByItsOwnName) {
  DiagnoseThresholds thresholds;
  std::set<std::string> names;
  std::size_t bytes = 0;
  thresholds.for_each([&](const std::string& name, auto& number) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_NE(number, 0) << name << ": half and twice of 0 tell nothing";
    bytes += sizeof(number);
  });
  // All members are as wide as a double: one that for_each forgot would be missing here.
  EXPECT_EQ(bytes, sizeof(DiagnoseThresholds));
}

}  // namespace
}  // namespace vernier::diagnose_test
