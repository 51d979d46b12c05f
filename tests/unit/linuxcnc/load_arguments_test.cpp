// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/load_arguments.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vernier::load_arguments_test {
namespace {

/// Arguments as rtapi_app leaves them: what was given, then nulls.
struct Load {
  Load(std::vector<std::string> axes, std::vector<std::string> inputs = {},
       std::vector<std::string> rotary = {}, const char* units = nullptr)
      : names{std::move(axes), std::move(inputs), std::move(rotary)} {
    for (int list = 0; list < 3; ++list)
      for (std::size_t i = 0; i < names[list].size(); ++i) at[list][i] = names[list][i].data();
    good = read_load_arguments({at[0], at[1], at[2], units}, loaded, why);
  }
  std::vector<std::string> names[3];
  char* at[3][9] = {};
  LoadedWiring loaded;
  char why[120];
  bool good = false;
};

TEST(LoadArguments, NameAxesInputsAndWhatTurns) {
  const Load load({"X", "C"}, {"T_column"}, {}, "inch");
  EXPECT_TRUE(load.good) << load.why;
  EXPECT_STREQ(load.why, "");
  ASSERT_EQ(load.loaded.wiring.axes.size(), 2u);
  EXPECT_FALSE(load.loaded.wiring.axes[0].rotary);
  EXPECT_TRUE(load.loaded.wiring.axes[1].rotary);
  EXPECT_EQ(load.loaded.wiring.inputs[0], "T_column");
  EXPECT_EQ(load.loaded.mm_per_unit, 25.4);
  EXPECT_TRUE(Load({"X", "J4"}, {}, {"J4"}).loaded.wiring.axes[1].rotary);
  const Load straight({"X", "A"}, {}, {"none"}, "mm");
  EXPECT_TRUE(straight.good) << straight.why;
  EXPECT_FALSE(straight.loaded.wiring.axes[1].rotary);
  for (const char* const inch : {"in", "inch", "imperial"})
    EXPECT_EQ(Load({"X"}, {}, {}, inch).loaded.mm_per_unit, 25.4);
}

TEST(LoadArguments, RefuseByNameWhatCannotBe) {
  const std::string long_name(30, 't');
  const auto why = [](const Load& load) { return load.good ? std::string("taken") : std::string(load.why); };
  EXPECT_EQ(why(Load({})), "axes=: axes is missing: give the axis names of the joints, axes=X,Y,...");
  EXPECT_EQ(why(Load({"X", "Y"}, {}, {"Q"})), "rotary=Q: this name is not in axes");
  EXPECT_EQ(why(Load({"X", "A"}, {}, {"none", "A"})), "rotary=none: this name is not in axes");
  EXPECT_EQ(why(Load({"X"}, {"X"})), "inputs=X: the name of an axis");
  EXPECT_EQ(why(Load({"X"}, {"T", "T"})), "inputs=T: there twice");
  EXPECT_EQ(why(Load({"X"}, {long_name})), "inputs=" + long_name + ": longer than 23 characters");
  EXPECT_EQ(why(Load({"X"}, {""})), "inputs=: a name is empty");
  EXPECT_EQ(why(Load({"X/Y"})), "axes=X/Y: a name may contain only letters, digits, _ and -");
  EXPECT_EQ(why(Load({"%s%n"})), "axes=%s%n: a name may contain only letters, digits, _ and -");
  EXPECT_EQ(why(Load({"X", "X"})), "axes=X: there twice");
  EXPECT_EQ(why(Load({"X"}, {}, {}, "furlong")), "units=furlong: mm or inch");
  EXPECT_EQ(why(Load({std::string(500, 'X')})),
            "axes=" + std::string(40, 'X') + ": longer than 23 characters");
}

}  // namespace
}  // namespace vernier::load_arguments_test
