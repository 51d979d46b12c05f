// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/conformity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/tolerance/plate.h"
#include "tools/text/error.h"

namespace vernier::tolerance_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::tolerance;
namespace {

constexpr double kDiameter = 40, kScale = 2e-4, kStd = 5e-5;

PartConformity judged(const Machine& machine, const ConformityOptions& options = {},
                      const std::string& list = kBores) {
  const PlacedPart part = place_part(machine, parse_part(list, "p.csv"), at_rest(machine));
  return part_conformity(machine, part, "p.csv", built_in_effects(), options);
}

const CharacteristicResult& size_of(const PartConformity& all, std::size_t feature) {
  for (const CharacteristicResult& one : all.characteristics)
    if (one.feature == feature && one.what == PartCharacteristic::kSize) return one;
  throw std::runtime_error("no size");
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2)); }

/// Relative: twenty thousand trials leave 2 % of an end of the interval, the rule of their number 5 % of u.
constexpr double kTrials = 0.04;

TEST(PartConformity, OfOneScaleErrorIsTheClosedForm) {
  Machine machine = plate_machine(kScale, 0);
  set_known(machine, kStd, 0);
  const PartConformity all = judged(machine);
  const CharacteristicResult& size = size_of(all, 2);
  const double mean = kScale * kDiameter / 2, std = kStd * kDiameter / 2;
  EXPECT_FALSE(all.exact);
  EXPECT_TRUE(all.settled);
  EXPECT_GE(all.trials, 20000u);
  EXPECT_NEAR(size.off.value, mean, 1e-6);
  EXPECT_NEAR(size.off.std, std, kTrials * std);
  EXPECT_NEAR(size.off.u95, 1.96 * std, kTrials * 1.96 * std);
  // The limits are -10 and +10 um, the mean 4 um, its standard uncertainty 1 um.
  EXPECT_NEAR(*size.off.probability, normal_cdf((0.01 - mean) / std), 0.01);
  EXPECT_EQ(*size.off.verdict, PartVerdict::kConforms);
  EXPECT_NEAR(size.on.value, 0, 1e-7);  // the correction takes the mean away and leaves what is not known
  EXPECT_NEAR(size.on.std, std, kTrials * std);
  EXPECT_THAT(size.dominant, testing::ElementsAre("scale-error of X in X"));
}

TEST(PartConformity, ADiscrepancyWidensEveryInterval) {
  Machine machine = plate_machine(0, 0);
  set_known(machine, 1e-9, 1e-9);
  const PartConformity before = judged(machine);
  EXPECT_EQ(*size_of(before, 2).on.verdict, PartVerdict::kConforms);
  // GIVEN a fit that saw 20 um that the model lacks along x and y
  auto record = std::make_shared<FitRecord>(*machine.fitted);
  record->discrepancy_mm = {0.02, 0.02, 0};
  machine.fitted = record;
  const PartConformity after = judged(machine);
  // THEN every interval is at least as wide as that, and no size or form conforms to 10 um any more
  for (const CharacteristicResult& one : after.characteristics) {
    if (!one.limits_mm) continue;
    EXPECT_GT(one.on.high - one.on.low, 0.02) << characteristic_name(one.what);
    if (one.what != PartCharacteristic::kPosition) {
      EXPECT_NE(*one.on.verdict, PartVerdict::kConforms) << characteristic_name(one.what);
    }
    EXPECT_GT(one.discrepancy, 0.99);
  }
}

TEST(PartConformity, AFeatureOutsideTheMeasuredRangeGetsNoVerdict) {
  Machine machine = plate_machine(0, 0);
  set_known(machine, 1e-9, 1e-9);
  auto record = std::make_shared<FitRecord>(*machine.fitted);
  record->measured[0].max = 200;
  machine.fitted = record;
  const PartConformity all = judged(machine);
  ASSERT_FALSE(all.outside.empty());
  bool inside = false, outside = false;
  for (const CharacteristicResult& one : all.characteristics) {
    if (!one.on.verdict) continue;
    (one.outside ? outside : inside) = true;
    EXPECT_EQ(*one.on.verdict, one.outside ? PartVerdict::kCannotBeSaid : PartVerdict::kConforms);
  }
  EXPECT_TRUE(inside && outside);
}

TEST(PartConformity, SaysYesNoAndNeither) {
  const auto verdict = [](double scale) {
    Machine machine = plate_machine(scale, 0);
    set_known(machine, kStd, 0);
    return *size_of(judged(machine), 0).off.verdict;
  };
  // 10 um of diameter are a scale of 5e-4: two and more standard deviations on either side are sure, one is
  // not.
  EXPECT_EQ(verdict(5e-4 - 2.2 * kStd), PartVerdict::kConforms);
  EXPECT_EQ(verdict(5e-4 - kStd), PartVerdict::kCannotBeSaid);
  EXPECT_EQ(verdict(5e-4 + kStd), PartVerdict::kCannotBeSaid);
  EXPECT_EQ(verdict(5e-4 + 2.2 * kStd), PartVerdict::kDoesNotConform);
}

TEST(PartConformity, SharesAddUpAndNameWhatNobodyMeasured) {
  Machine machine = plate_machine(kScale, 1e-4);
  set_known(machine, kStd, 2 * kStd, 0.25);
  for (const CharacteristicResult& one : judged(machine).characteristics) {
    double sum = one.process;
    for (const SourceShare& source : one.sources) sum += source.variance;
    EXPECT_NEAR(sum, 1, 1e-9);
    if (one.what == PartCharacteristic::kSize) {
      EXPECT_NEAR(one.open, 0.25, 1e-6);  // size knows the scale alone
    } else {
      EXPECT_LT(one.open, 0.25);
    }
  }
}

TEST(PartConformity, LeavesTheDominantSourceOpenWhereItIs) {
  // The squareness and the scale make about the same of a circle's form.
  Machine machine = plate_machine(1e-4, 1e-4 * 2 / std::sqrt(3));
  set_known(machine, kStd, kStd);
  for (const CharacteristicResult& one : judged(machine).characteristics) {
    if (one.what != PartCharacteristic::kForm) continue;
    EXPECT_THAT(one.dominant, testing::UnorderedElementsAre("scale-error of X in X", "squareness of Y in X"));
  }
}

TEST(PartConformity, IsTheSameForASeedAndNotForAnother) {
  Machine machine = plate_machine(kScale, 1e-4);
  set_known(machine, kStd, kStd);
  ConformityOptions other;
  other.seed = 2;
  const double first = size_of(judged(machine), 0).off.low;
  EXPECT_EQ(first, size_of(judged(machine), 0).off.low);
  EXPECT_NE(first, size_of(judged(machine, other), 0).off.low);
}

TEST(PartConformity, CountsTheProcess) {
  Machine machine = plate_machine(0, 0);
  set_known(machine, 1e-9, 0);
  ConformityOptions options;
  options.process_mm = 0.002;
  const CharacteristicResult size = size_of(judged(machine, options), 0);
  // Twice the mean of twelve radial errors.
  const double std = 2 * options.process_mm / std::sqrt(12);
  EXPECT_NEAR(size.off.std, std, kTrials * std);
  EXPECT_GT(size.process, 0.999);
}

TEST(PartConformity, TellsWhereNobodyMeasuredAndWhatWasSetByHand) {
  Machine machine = plate_machine(kScale, 0);
  set_known(machine, kStd, 0);
  auto record = std::make_shared<FitRecord>(*machine.fitted);
  record->measured[0].max = 250;
  machine.fitted = record;
  machine.statics[1].value = 1e-4;  // by hand
  const PartConformity all = judged(machine);
  EXPECT_THAT(all.outside, testing::ElementsAre("X 250 to 320"));
  EXPECT_THAT(all.stale, testing::ElementsAre("sxy"));
}

TEST(PartConformity, OfAMachineThatWasNeverFittedIsRefused) {
  EXPECT_THROW(judged(plate_machine(kScale, 0)), InputError);
}

TEST(PartConformity, GoesThroughTheChainWhereThatIsNotLinear) {
  // A turn by degrees of a long tool is not linear in the angle.
  Machine machine = plate_machine(0, 0);
  set_known(machine, 0, 0);
  auto record = std::make_shared<FitRecord>(*machine.fitted);
  for (std::size_t i = 0; i < record->parameters.size(); ++i)
    if (record->parameters[i] == "tilt")
      record->factor(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = 10;
  machine.fitted = record;
  ConformityOptions options;
  options.most_trials = 10000;
  options.frame = PartFrame::kMachine;
  const PartConformity all = judged(
      machine, options, "feature,kind,x,y,z,position\na,point,100,100,-10,0.1\nb,point,300,100,-250,0.1\n");
  EXPECT_TRUE(all.exact);
  EXPECT_GT(all.linear_mm, 0.1);
}

}  // namespace
}  // namespace vernier::tolerance_test
