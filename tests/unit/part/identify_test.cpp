// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/identify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "tests/unit/part/part_data.h"
#include "tools/part/measured_part.h"

namespace vernier::identify_test {

using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::part;
using namespace vernier::text;
namespace {

using Pairs = std::set<std::set<std::string>>;

Pairs named(const Observability& seen, const Machine& machine) {
  const auto free = free_statics(machine);
  Pairs pairs;
  for (const auto& group : seen.unidentifiable) {
    std::set<std::string> names;
    for (const std::size_t k : group) names.insert(machine.statics[free[k]].name);
    pairs.insert(names);
  }
  return pairs;
}

const Pairs kInseparable = {{"EA0Z", "EA0C"}, {"EB0Z", "EB0C"}};

MeasuredPart measure(const BHeadMachine& truth, DefectReading reading, double noise_mm, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0, 1);
  const std::vector<PartPoint> points = standard_points();
  const PartDefect defect = part_defect(truth, points, {{}, reading});
  MeasuredPart part{"simulated", {}};
  for (std::size_t i = 0; i < points.size(); ++i)
    part.points.push_back({points[i],
                           defect.defect_mm[static_cast<Eigen::Index>(i)] + noise_mm * noise(generator),
                           noise_mm, i + 1});
  return part;
}

double value(const Identification& found, const std::string& name) {
  for (const IdentifiedError& error : found.errors)
    if (error.name == name) return error.value;
  throw std::out_of_range(name);
}

TEST(Identify, TwoPairsCannotBeToldApartInThePlane) {
  const BHeadMachine machine = part_data::machine();
  const Observability seen = part_observability(machine, standard_points(), {{}, DefectReading::kInPlane});
  EXPECT_EQ(seen.rank, 6);  // the size of the paper's minimum set
  EXPECT_EQ(named(seen, machine.machine), kInseparable);
  EXPECT_LT(seen.condition, 20);  // the six others are well apart
}

TEST(Identify, PairsAreNamedAtErrorsTooAndNotFeignedApartBySecondOrder) {
  const BHeadMachine machine = part_data::machine("EA0Z=0.1,EB0C=-0.2,EA0B=0.05");
  const Observability seen = part_observability(machine, standard_points(), {{}, DefectReading::kInPlane});
  EXPECT_EQ(named(seen, machine.machine), kInseparable);
}

TEST(Identify, OnlyTheLeanOfTheFlanksTellsThePairsApart) {
  const BHeadMachine machine = part_data::machine();
  const Observability seen = part_observability(machine, standard_points(), {{}, DefectReading::kContact});
  EXPECT_EQ(seen.rank, 8);
  // Without the vertical displacement each pair is one; with it a tilt of the pair costs at least ten times
  // the uncertainty of EA0B, which the part shows best.
  const auto free = free_statics(machine.machine);
  const auto std_of = [&](const char* name) {
    for (std::size_t k = 0; k < free.size(); ++k)
      if (machine.machine.statics[free[k]].name == name)
        return std::sqrt(seen.covariance(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)));
    return -1.0;
  };
  for (const char* name : {"EA0Z", "EA0C", "EB0Z", "EB0C"})
    EXPECT_GT(std_of(name), 10 * std_of("EA0B")) << name;
}

TEST(Identify, FindsWhatWasPutInWithinItsUncertainty) {
  const BHeadMachine truth = part_data::machine(
      "EC0Y=0.004,EA0Z=0.01,EB0Z=-0.008,EA0C=0.006,EB0C=0.012,EX0B=0.03,EA0B=0.0186,EC0B=-0.005");
  std::size_t beyond_two = 0, count = 0;
  for (unsigned seed = 100; seed < 140; ++seed) {
    const Identification found =
        identify(part_data::machine(), measure(truth, DefectReading::kContact, 0.003, seed));
    EXPECT_TRUE(found.converged);
    EXPECT_EQ(found.freedom, 92);
    EXPECT_TRUE(found.observability.unidentifiable.empty());
    for (const IdentifiedError& error : found.errors) {
      const double true_value = truth.machine.statics[truth.machine.find_static(error.name).value()].value;
      ASSERT_TRUE(error.std);
      const double ratio = std::abs(error.value - true_value) / *error.std;
      EXPECT_LT(ratio, 4.5) << error.name << " seed " << seed;  // 7e-6 a number
      beyond_two += ratio > 2 ? 1 : 0;
      ++count;
    }
  }
  // 4.6 % of 320 are expected beyond two sigma: 14.7 +- 3.7 if they were independent; four sigma either way.
  EXPECT_EQ(count, 320u);
  EXPECT_GT(beyond_two, 1u);
  EXPECT_LT(beyond_two, 32u);
}

TEST(Identify, WithoutNoiseReturnsTheTruth) {
  const BHeadMachine truth = part_data::machine(part_data::kTable4);
  for (const DefectReading reading : {DefectReading::kContact, DefectReading::kTip}) {
    MeasuredPart part = measure(truth, reading, 0, 1);
    const Identification found = identify(part_data::machine(), part, {{{}, reading}});
    for (const IdentifiedError& error : found.errors)
      // Chain rounding of 1e-13 mm against columns of at least 0.06 mm per deg, condition 10.
      EXPECT_NEAR(error.value, truth.machine.statics[truth.machine.find_static(error.name).value()].value,
                  1e-8)
          << error.name;
    EXPECT_LT(found.residual_mm.cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(Identify, InseparablePairIsSharedAsThePaperDoes) {
  // In the plane only EA0C - EA0Z shows; from a nominal start the pair takes it in halves, EA0C = -EA0Z, as
  // the first row of table 4 writes it.
  const BHeadMachine truth = part_data::machine("EA0Z=0.004,EB0C=0.006");
  const MeasuredPart part = measure(truth, DefectReading::kInPlane, 0.001, 3);
  const Identification found = identify(part_data::machine(), part, {{{}, DefectReading::kInPlane}});
  EXPECT_EQ(found.observability.rank, 6);
  EXPECT_EQ(named(found.observability, found.machine), kInseparable);
  EXPECT_NEAR(value(found, "EA0C"), -value(found, "EA0Z"), 1e-9);
  EXPECT_NEAR(value(found, "EB0C"), -value(found, "EB0Z"), 1e-9);
  for (const IdentifiedError& error : found.errors)
    EXPECT_EQ(error.std.has_value(),
              error.name != "EA0Z" && error.name != "EA0C" && error.name != "EB0Z" && error.name != "EB0C")
        << error.name;
  // What does show is right: five standard uncertainties of the half difference (0.47 um-level columns).
  EXPECT_NEAR((value(found, "EA0Z") - value(found, "EA0C")) / 2, 0.002, 0.002);
  EXPECT_NEAR(std::sqrt(found.residual_mm.squaredNorm() / 100), 0.001, 0.0003);
}

TEST(Identify, AlignedPartNeedsItsRigidMotionFitted) {
  const BHeadMachine truth = part_data::machine(part_data::kTable4);
  MeasuredPart part = measure(truth, DefectReading::kContact, 0.002, 21);
  const PartDefect there = part_defect(truth, standard_points());
  // The part lies 0.05 mm off and is turned by 1e-4 rad about Z in the measuring frame.
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d p = there.position.col(row), n = there.normal.col(row);
    part.points[i].defect_mm += 0.05 * n.x() + 1e-4 * (p.x() * n.y() - p.y() * n.x());
  }
  IdentifyOptions options;
  const Identification plain = identify(part_data::machine(), part, options);
  options.aligned = true;
  const Identification aligned = identify(part_data::machine(), part, options);
  ASSERT_EQ(aligned.errors.size(), 14u);
  EXPECT_GT(plain.variance_factor, 3);
  EXPECT_LT(aligned.variance_factor, 1.6);  // chi^2 of 86 degrees of freedom: 1 +- 0.15, four sigma
  for (const auto& expected :
       {std::pair{"part.X", 0.05}, std::pair{"part.rZ", 1e-4 * 180 / std::numbers::pi}}) {
    const auto& [name, wanted] = expected;
    const auto at = std::find_if(aligned.errors.begin(), aligned.errors.end(),
                                 [&](const IdentifiedError& e) { return e.name == expected.first; });
    ASSERT_NE(at, aligned.errors.end());
    EXPECT_NEAR(at->value, wanted, 4.5 * at->std.value()) << name;
  }
}

TEST(Identify, AToolOfAnotherRadiusIsToldAndFitted) {
  constexpr double kRadius = -0.02;  // the tool is smaller: material is left
  for (const DefectReading reading : {DefectReading::kContact, DefectReading::kInPlane}) {
    const BHeadMachine truth = part_data::machine("EX0B=0.03,EA0B=0.0186");
    MeasuredPart part = measure(truth, reading, 0.003, 31);
    for (MeasuredPoint& point : part.points) point.defect_mm -= kRadius;
    IdentifyOptions options{{{}, reading}};
    const Identification plain = identify(part_data::machine(), part, options);
    ASSERT_EQ(plain.warnings.size(), 2u);
    EXPECT_NE(plain.warnings[0].find("times the uncertainty of the points"), std::string::npos)
        << plain.warnings[0];
    EXPECT_NE(plain.warnings[1].find("--tool-radius"), std::string::npos) << plain.warnings[1];
    options.tool_radius = true;
    const Identification with = identify(part_data::machine(), part, options);
    EXPECT_TRUE(with.warnings.empty());
    EXPECT_LT(with.variance_factor, 1.6);
    EXPECT_EQ(with.errors.back().name, "tool.radius");
    // A wall that leans shows the radius 1 to 4 % wider in the plane.
    EXPECT_NEAR(with.errors.back().value, kRadius,
                4.5 * *with.errors.back().std + (reading == DefectReading::kInPlane ? 0.0008 : 0));
    for (const IdentifiedError& error : with.errors) {
      if (!error.std || error.name == "tool.radius") continue;
      EXPECT_NEAR(error.value, truth.machine.statics[*truth.machine.find_static(error.name)].value,
                  4.5 * *error.std)
          << error.name;
    }
  }
  EXPECT_TRUE(identify(part_data::machine(), measure(part_data::machine(), DefectReading::kContact, 0.003, 5))
                  .warnings.empty());
}

TEST(Identify, RefusesTooFewPointsAndNothingFree) {
  BHeadMachine machine = part_data::machine();
  MeasuredPart part = measure(machine, DefectReading::kContact, 0.001, 1);
  part.points.resize(7);
  EXPECT_THROW(identify(machine, part), InputError);
  for (Static& item : machine.machine.statics) item.hidden = true;
  EXPECT_THROW(identify(machine, measure(machine, DefectReading::kContact, 0.001, 1)), InputError);
}

}  // namespace
}  // namespace vernier::identify_test
