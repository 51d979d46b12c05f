// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/gauge_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/unit/part/part_data.h"
#include "tools/part/defect.h"

namespace vernier::gauge_block_test {

using namespace vernier::part;
namespace {

constexpr double kPivotMm = 533.889;

TEST(GaugeBlock, PublishedReadingsGiveThePublishedErrors) {
  std::array<double, 4> y_mm{};
  for (auto& row : part_data::rows("gauge_block.csv"))
    y_mm[static_cast<std::size_t>(part_data::number(row["C"]) / 90)] = part_data::number(row["y"]);
  const GaugeBlockEstimate found = estimate_gauge_block(y_mm, kPivotMm);
  // Printed with four digits. The paper prints it positive; with its own equation y180 - y0 = -2 L0 EA0B it
  // is negative.
  EXPECT_NEAR(std::abs(found.ea0b_rad), 3.549e-4, 5.1e-8);
  EXPECT_LT(found.ea0b_rad, 0);
  EXPECT_NEAR(found.ex0b_mm, 0.003, 1e-9);
  // 9.5 % of table 4's value, not "less than 8 %" as printed.
  EXPECT_NEAR(std::abs(found.ea0b_rad) / 3.2419e-4 - 1, 0.095, 5e-4);
}

TEST(GaugeBlock, FindsTheErrorsOfTheChain) {
  // Second derivation: readings of the machine's chain at the four table positions, every other error 0.
  constexpr double kEa0b = -3e-4, kEx0b = 0.02, kLiftMm = -327.8;
  const BHeadMachine machine = part_data::machine("EA0B=" + std::to_string(kEa0b * 180 / std::numbers::pi) +
                                                  ",EX0B=" + std::to_string(kEx0b));
  std::vector<JointPose> joints;
  for (int k = 0; k < 4; ++k) joints.push_back({0, 0, machine.pivot_mm, 0, 90.0 * k});
  const auto moved = displacements(machine, joints, {0, 0, 0, 0});
  std::array<double, 4> y_mm{};
  for (std::size_t k = 0; k < 4; ++k) y_mm[k] = kLiftMm + moved[k].shift.y();
  const GaugeBlockEstimate found = estimate_gauge_block(y_mm, machine.pivot_mm);
  EXPECT_NEAR(found.ea0b_rad, kEa0b, 1e-8);  // six decimals of the text: 1e-6 deg; second order 3e-4^3
  EXPECT_NEAR(found.ex0b_mm, kEx0b, 1e-8);
}

TEST(GaugeBlock, UncertaintyIsThatOfAHalfDifference) {
  const GaugeBlockEstimate found = estimate_gauge_block({0, 0, 0, 0}, 500);
  EXPECT_NEAR(found.ex0b_per_mm, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(found.ea0b_per_mm, std::sqrt(0.5) / 500, 1e-15);
}

TEST(GaugeBlock, PivotLengthMustBePositive) {
  EXPECT_THROW(estimate_gauge_block({0, 0, 0, 0}, 0), std::invalid_argument);
  EXPECT_THROW(estimate_gauge_block({0, 0, 0, 0}, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace vernier::gauge_block_test
