// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/image_diff.h"

#include "tests/unit/workbench/rig.h"
#include "tools/compile/compile.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::image_diff_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::workbench;
namespace {

std::vector<std::uint8_t> image(const std::string& value, const std::string& axis = "Y") {
  const std::string text =
      "<machine name=\"m\"><variables><static><k value=\"" + value +
      "\" nominal=\"0\"/></static><machineaxes><X min=\"0\" max=\"100\"/><" + axis +
      " min=\"0\" max=\"100\"/></machineaxes></variables><transforms><sixdof n=\"1\" X=\"X+k*" + axis +
      "\" Y=\"" + axis + "\"/></transforms></machine>";
  return compile_machine(parse_machine(text, "m.xml"), text, {}).image;
}

TEST(ImageDiff, TheSameImageDiffersInNothing) {
  const auto diff = image_diff(image("1e-4"), image("1e-4"));
  EXPECT_EQ(diff["same"], true);
  for (const auto& one : diff["corrections"]) EXPECT_EQ(one["max"], 0.0);
  EXPECT_TRUE(diff["only_a"].empty());
}

TEST(ImageDiff, SquarenessTellsBySoMuchAtTheFarEnd) {
  const auto diff = image_diff(image("3e-4"), image("1e-4"));
  EXPECT_EQ(diff["same"], false);
  const auto& x = diff["corrections"][0];
  EXPECT_EQ(x["axis"], "X");
  // 2e-4 of 100 mm at the end of Y; the 4096 poses come within 0.1 % of it, and an LSB is 1 nm.
  EXPECT_NEAR(x["max"].get<double>(), 20, 0.025);
  EXPECT_NEAR(x["rms"].get<double>(), 20 / std::sqrt(3.0), 0.05);
  EXPECT_GT(x["at"]["Y"].get<double>(), 99.8);
  EXPECT_EQ(diff["corrections"][1]["max"], 0.0);
}

TEST(ImageDiff, OtherAxesAreNotCompared) {
  const auto diff = image_diff(image("1e-4"), image("1e-4", "Z"));
  EXPECT_FALSE(diff.contains("corrections"));
  EXPECT_TRUE(diff.contains("why_not"));
}

TEST(ImageDiff, WhatIsNoImageIsRefused) {
  EXPECT_THROW(image_diff({1, 2, 3}, image("1e-4")), InputError);
  auto broken = image("1e-4");
  broken[broken.size() / 2] ^= 1;
  EXPECT_THROW(image_diff(image("1e-4"), broken), InputError);
}

}  // namespace
}  // namespace vernier::image_diff_test
