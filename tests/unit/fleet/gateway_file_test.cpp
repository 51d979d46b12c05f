// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/gateway_file.h"

#include <gtest/gtest.h>

#include "tools/text/error.h"

namespace vernier::gateway_file_test {

using namespace vernier::fleet;
namespace {

constexpr const char* kGood = R"([gateway]
name = "hall-2"
store = "hall2.db"
period_s = 0.5
[[board]]
machine = "VMC-3"
url = "tcp://10.0.0.3"
[[board]]
machine = "VMC-4"
url = "rtu:///dev/ttyS1?baud=9600"
check = "vmc4.json"
)";

TEST(GatewayFile, IsReadWithPathsBesideIt) {
  const GatewayFile file = parse_gateway_file(kGood, "/etc/vernier/gateway.toml");
  EXPECT_EQ(file.name, "hall-2");
  EXPECT_EQ(file.group, "vernier");
  EXPECT_EQ(file.store, "/etc/vernier/hall2.db");
  EXPECT_EQ(file.period_s, 0.5);
  ASSERT_EQ(file.boards.size(), 2u);
  EXPECT_EQ(file.boards[1].check, "/etc/vernier/vmc4.json");
}

TEST(GatewayFile, WrongWordsAreNamedWithTheirLine) {
  const auto said = [](std::string text, const std::string& from, const std::string& to) -> std::string {
    text.replace(text.find(from), from.size(), to);
    try {
      parse_gateway_file(text, "g.toml");
    } catch (const text::InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_NE(said(kGood, "\"hall-2\"", "\"hall/2\"").find("g.toml:2: \"name\""), std::string::npos);
  EXPECT_NE(said(kGood, "period_s = 0.5", "perod_s = 0.5").find("g.toml:4: \"perod_s\""), std::string::npos);
  EXPECT_NE(said(kGood, "0.5", "0").find("g.toml:4"), std::string::npos);
  EXPECT_NE(said(kGood, "VMC-4", "VMC-3").find("g.toml:8: \"VMC-3\""), std::string::npos);
  EXPECT_NE(said(kGood, "tcp://10", "tpc://10").find("g.toml:7"), std::string::npos);
  EXPECT_NE(said(kGood, "store = \"hall2.db\"", "").find("\"store\""), std::string::npos);
  EXPECT_NE(said(kGood, "[gateway]", "[gateway").find("g.toml:1"), std::string::npos);
  EXPECT_NE(said(kGood, "0.5", "0.5 \u00b5").find("g.toml:4"), std::string::npos);
}

}  // namespace
}  // namespace vernier::gateway_file_test
