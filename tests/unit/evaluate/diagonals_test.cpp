// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/diagonals.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "tools/text/error.h"

namespace vernier::diagonals_test {

using namespace vernier::evaluate;
using namespace vernier::text;
namespace {

/// A machine of 400 x 300 x 200 mm with a squareness and a reversal of X, measured along a diagonal by an
/// instrument that sees the distance between its two points and counts in its own sense.
struct Survey {
  double squareness = 50e-6, reversal = 0.006;  // rad of Y to X; mm
  std::string csv = "X[mm],Y[mm],Z[mm],displacement[mm]\n";

  void along(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double counts) {
    const Eigen::Vector3d direction = (to - from).normalized();
    for (int run = 0; run < 2; ++run)
      for (const double sense : {1.0, -1.0})
        for (int i = 0; i <= 4; ++i) {
          const double share = 0.25 * (sense > 0 ? i : 4 - i);
          const Eigen::Vector3d at = from + share * (to - from);
          const double x_sense = sense * (direction.x() > 0 ? 1 : -1);
          Eigen::Vector3d error = Eigen::Vector3d::Zero();
          error.x() = -squareness * at.y() + 0.5 * reversal * x_sense;
          csv += fmt::format("{},{},{},{:.6f}\n", at.x(), at.y(), at.z(),
                             812.5 + counts * ((at - from).dot(direction) + error.dot(direction)));
        }
  }
};

TEST(Diagonals, SquarenessAndReversalAreWhatGeometrySays) {
  Survey test;
  test.along({0, 0, 0}, {400, 300, 200}, 1);
  test.along({0, 300, 0}, {400, 0, 200}, -1);  // the instrument at its other end
  test.along({0, 0, 100}, {400, 300, 100}, 1);
  const auto list = read_diagonals(test.csv, "d.csv", "displacement");
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0].name, "+X+Y+Z");
  EXPECT_EQ(list[1].name, "+X-Y+Z");
  EXPECT_EQ(list[2].name, "+X+Y");
  const double length = std::sqrt(400.0 * 400 + 300 * 300 + 200 * 200);
  EXPECT_NEAR(list[0].length, length, 1e-9);
  std::map<std::string, PositioningResult> body;
  for (std::size_t i = 0; i < 2; ++i) body[list[i].name] = evaluate_positioning(list[i].positions.readings);
  // Means of both senses run from 0 to -squareness x y / length along one, and the other way along the other.
  const double range = test.squareness * 400 * 300 / length;
  EXPECT_NEAR(*body["+X+Y+Z"].range, range, 1e-6);
  EXPECT_NEAR(*body["+X-Y+Z"].range, range, 1e-6);
  // A reversal of X shows with its share of the diagonal's direction.
  EXPECT_NEAR(*body["+X+Y+Z"].reversal, test.reversal * 400 / length, 1e-6);
  const auto machine = machine_values(body);
  EXPECT_NEAR(machine.at("E"), range + test.reversal * 400 / length, 2e-6);
  EXPECT_NEAR(machine.at("B"), test.reversal * 400 / length, 1e-6);
  const PositioningResult face = evaluate_positioning(list[2].positions.readings);
  EXPECT_NEAR(*face.range, test.squareness * 400 * 300 / 500, 1e-6);
}

TEST(Diagonals, WhatIsNoneIsRefused) {
  const auto refused = [](const std::string& text) {
    try {
      read_diagonals(text, "d.csv", "displacement");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refused("X[mm],Y[mm],displacement[mm]\n0,0,0\n10,0,10\n").find("along one axis"),
            std::string::npos);
  EXPECT_NE(refused("X[mm],Y[mm]\n0,0\n").find("this column is missing"), std::string::npos);
  EXPECT_NE(refused("X[mm],displacement[mm]\n0,0\n").find("two linear axes"), std::string::npos);
  EXPECT_NE(
      refused("X[mm],Y[mm],displacement[mm]\n0,0,0\n10,10,14.1\n20,0,3\n").find("not on a straight line"),
      std::string::npos);
  EXPECT_NE(refused("X[mm],Y[mm],displacement[deg]\n0,0,0\n").find("unit of length"), std::string::npos);
}

}  // namespace
}  // namespace vernier::diagonals_test
