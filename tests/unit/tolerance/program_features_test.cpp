// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/program_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/unit/tolerance/plate.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"
#include "tools/tolerance/feature_values.h"

namespace vernier::tolerance_test {

using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::tolerance;
namespace {

PlacedPart read(const Machine& machine, const std::string& text) {
  ProgramOptions options;
  options.zero = {300, 200, -100};
  options.position_mm = 0.05;
  return program_part(machine, text, "p.ngc", at_rest(machine), std::vector<char>(3, 0), options);
}

TEST(ProgramFeatures, CirclesAreCirclesAndTheRestIsPaths) {
  const Machine machine = plate_machine(0, 0);
  const PlacedPart part = read(machine,
                               "G21 G90\nG0 X0 Y0 Z10\nG1 Z0 F300\nG1 X50\nG1 Y20\nG0 Z10\nG0 X10 Y0\nG1 Z0\n"
                               "G2 X10 Y0 I-10 J0\nG0 Z10\n");
  ASSERT_EQ(part.features.size(), 3u);
  EXPECT_EQ(part.features[0].feature.name, "path of lines 3 to 5");
  EXPECT_EQ(part.features[1].feature.name, "path of line 8");  // the way down to the circle
  const PartFeature& circle = part.features[2].feature;
  EXPECT_EQ(circle.name, "circle of line 9");
  EXPECT_EQ(circle.kind, PartFeatureKind::kCylinder);
  EXPECT_NEAR(circle.diameter_mm, 20, 1e-6);
  EXPECT_NEAR((circle.at - Eigen::Vector3d(300, 200, -100)).norm(), 0, 1e-6);
  EXPECT_NEAR(circle.direction.z(), -1, 1e-6);  // clockwise
  EXPECT_DOUBLE_EQ(*circle.position_mm, 0.05);
  // Both senses of X occur on the way round.
  const auto senses = part.states.direction[0].segment(static_cast<Eigen::Index>(part.features[2].first),
                                                       static_cast<Eigen::Index>(part.features[2].count));
  EXPECT_EQ(senses.minCoeff(), -1);
  EXPECT_EQ(senses.maxCoeff(), 1);
}

/// A cyclic error of X of 3 um with this period.
Machine cyclic(const std::string& period_mm) {
  return parse_machine(
      R"XML(<machine name="cyclic"><variables><static><a value="0.003" nominal="0" unit="mm"/></static>
      <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes></variables>
      <transforms branch="tool"><sixdof n="1" X="X+a*cos(360*X/)XML" +
          period_mm + R"XML()"/><sixdof n="2" Y="Y"/><sixdof n="3" Z="Z"/></transforms></machine>)XML",
      "cyclic.xml");
}

/// Size or form of the last feature, um.
double um_of(const Machine& machine, const PlacedPart& part, PartCharacteristic what) {
  const PartValues values = part_values(part, PartFrame::kMachine, "p");
  const Eigen::Matrix3Xd error =
      forward(machine, part.states).position - forward(nominal_machine(machine), part.states).position;
  const Eigen::VectorXd rows = values.map * Eigen::VectorXd(error.reshaped());
  double value = std::nan("");
  for (const CharacteristicValue& one : values.values)
    if (one.what == what) value = 1000 * one.of(rows);
  return value;
}

TEST(ProgramFeatures, OneBoreIsTheSameAsAFeatureAndAsAProgram) {
  for (const char* period : {"40", "10", "5", "2.5", "1.3"}) {
    const Machine machine = cyclic(period);
    const PlacedPart program = read(machine, "G21 G90\nG0 X10 Y0 Z0\nG3 X10 Y0 I-10 J0 F300\nG0 Z10\n");
    const PlacedPart feature = place_part(
        machine, parse_part("feature,kind,x,y,z,diameter\nbore,cylinder,300,200,-100,20\n", "p.csv"),
        at_rest(machine));
    // Many points, as the reference: mean and range of the radial error a cos(360 x / p) cos(angle).
    constexpr std::size_t kDense = 5000;
    double mean = 0, cosine = 0;
    std::vector<double> radial;
    for (std::size_t k = 0; k < kDense; ++k) {
      const double angle = 2 * M_PI * static_cast<double>(k) / kDense, x = 300 + 10 * std::cos(angle);
      radial.push_back(3 * std::cos(2 * M_PI * x / std::stod(period)) * std::cos(angle));
      mean += radial.back() / kDense;
      cosine += 2 * radial.back() * std::cos(angle) / kDense;
    }
    const double reference = 2 * mean;
    double low = 1e9, high = -1e9;
    for (std::size_t k = 0; k < kDense; ++k) {
      const double rest = radial[k] - mean - cosine * std::cos(2 * M_PI * static_cast<double>(k) / kDense);
      low = std::min(low, rest);
      high = std::max(high, rest);
    }
    for (const PlacedPart* part : {&program, &feature}) {
      // Two per cent of the form are permitted (points_on_circle), 0.05 um at least.
      EXPECT_NEAR(um_of(machine, *part, PartCharacteristic::kSize), reference, 0.15) << period;
      EXPECT_NEAR(um_of(machine, *part, PartCharacteristic::kForm), high - low, 0.05 * (high - low))
          << period;
    }
  }
}

TEST(ProgramFeatures, AProgramThatCutsNothingIsRefused) {
  EXPECT_THROW(read(plate_machine(0, 0), "G0 X0 Y0 Z0\nG0 X10\n"), InputError);
}

}  // namespace
}  // namespace vernier::tolerance_test
