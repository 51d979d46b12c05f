// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/calibration.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::calibration_test {

using namespace vernier::probe;
using namespace vernier::text;
namespace {

constexpr double kPi = std::numbers::pi;

ProbeCalibration published(const std::vector<std::string>& columns, const std::vector<std::string>& where) {
  const std::string file = VERNIER_SOURCE_DIR "/tests/data/probing/table1.csv";
  TouchTable table(read_file(file), file, columns, where);
  return calibrate_probe(
      table, {.artefact = CalibrationArtefact::kBlock, .size_mm = 50.8, .ball_radius_mm = 2.5019});
}

TEST(ProbeCal, GivesThePublishedLineFromTheRowsAtZeroDegrees) {
  const ProbeCalibration result = published({}, {"group=A"});
  EXPECT_NEAR(*result.line_intercept_um, 10.07, 0.005);
  EXPECT_NEAR(*result.line_slope_um_per_mm_min, -0.2054, 0.00005);
  EXPECT_NEAR(result.find("delay")->value, 6.16, 0.005);
  EXPECT_TRUE(result.fit.outliers.empty());
}

TEST(ProbeCal, FindsTheMisprintedRowByItself) {
  const ProbeCalibration result = published({}, {});
  ASSERT_EQ(result.fit.outliers.size(), 1u);
  EXPECT_EQ(result.fit.outliers[0].touch, 30u);  // row 31
  EXPECT_NEAR(result.find("delay")->value, 6.159, 0.0005);
  EXPECT_NEAR(*result.line_slope_um_per_mm_min, -0.2053, 0.00005);
  const ProbeCalibration repaired = published({"mean_lp_um=lower[um]"}, {});
  EXPECT_TRUE(repaired.fit.outliers.empty());
  EXPECT_NEAR(repaired.find("delay")->value, 6.1593, 0.0001);
}

TEST(ProbeCal, ARenamedColumnKeepsTheUnitInItsNameAndNonsenseIsRefused) {
  EXPECT_NEAR(published({"mean_lp_um=lower"}, {}).find("delay")->value, 6.1593, 0.0001);
  try {
    published({"mean_lp_um=lower[mm]"}, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("which is impossible for a probe"), std::string::npos)
        << error.what();
  }
}

TEST(ProbeCal, ComparesGroupsByTheProbesAngle) {
  const std::string file = VERNIER_SOURCE_DIR "/tests/data/probing/table1.csv";
  TouchTable table(read_file(file), file, {"mean_lp_um=lower"}, {});
  const CalibrationSetup setup{
      .artefact = CalibrationArtefact::kBlock, .size_mm = 50.8, .ball_radius_mm = 2.5019};
  const GroupComparison groups = compare_groups(table, setup, "group", calibrate_probe(table, setup));
  ASSERT_EQ(groups.groups.size(), 7u);
  EXPECT_EQ(groups.groups[0].touches, 7u);
  EXPECT_NEAR(find_calibrated(groups.groups[0].parameters, "delay")->value, 6.163, 0.0005);
  EXPECT_LT(groups.chance, 0.01);  // the report's figure 10: up to 4.5 um between angles
  EXPECT_THROW(compare_groups(table, setup, "colour", calibrate_probe(table, setup)), InputError);
}

TEST(ProbeCal, SaysWhichTouchesCameBeforeConstantSpeed) {
  const std::string file = VERNIER_SOURCE_DIR "/tests/data/probing/table1.csv";
  const auto not_valid = [&](double clearance) {
    TouchTable table(read_file(file), file, {}, {"group=A"});
    const ProbeCalibration result = calibrate_probe(table, {.artefact = CalibrationArtefact::kBlock,
                                                            .size_mm = 50.8,
                                                            .ball_radius_mm = 2.5019,
                                                            .clearance_mm = clearance});
    return std::count_if(result.findings.begin(), result.findings.end(),
                         [](const std::string& finding) { return finding.starts_with("Not valid touches"); });
  };
  EXPECT_EQ(not_valid(5.1), 0);
  EXPECT_EQ(not_valid(3), 1);  // at 2540 mm/min alone
}

TEST(ProbeCal, SaysThatOneFeedCannotTellDelayFromPretravel) {
  const ProbeCalibration result = published({}, {"feed_mm_min=254"});
  EXPECT_FALSE(result.delay_found);
  EXPECT_NE(result.findings.front().find("cannot be distinguished from pretravel"), std::string::npos);
}

struct Truth {
  double delay = 6e-3, tip = 2.49, lobe = 1.5e-3, lobe_deg = 20;
  bool sphere = true;
  double half = 12.5, noise = 0.2e-3, most_deg = 360, acceleration = 0;
};

// Touches of a ring or sphere by a probe that is late; half of them in acceleration where that is not 0.
std::string touches_of(const Truth& t, std::uint64_t seed, const std::vector<double>& feeds) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, t.noise);
  std::ostringstream out;
  out.precision(12);
  out << "x[mm],y[mm],z[mm],feed[mm/min],a[mm/s^2]\n";
  int k = 0;
  for (const double feed : feeds)
    for (const double e : t.sphere ? std::vector<double>{0, 0.7} : std::vector<double>{0})
      for (double deg = 0; deg < t.most_deg; deg += 15, ++k) {
        const double phi = deg * kPi / 180, a = k % 2 == 0 ? t.acceleration : 0, v = feed / 60;
        const double late = v * t.delay - a * t.delay * t.delay / 2 +
                            t.lobe * std::cos(e) * std::cos(3 * (phi - t.lobe_deg * kPi / 180));
        const double r = (t.sphere ? t.half + t.tip - late : t.half - t.tip + late) + noise(random);
        out << 100 + r * std::cos(e) * std::cos(phi) << ',' << -50 + r * std::cos(e) * std::sin(phi) << ','
            << 7 + r * std::sin(e) << ',' << feed << ',' << a << '\n';
      }
  return out.str();
}

ProbeCalibration calibrated(const Truth& t, std::uint64_t seed, const std::vector<double>& feeds) {
  TouchTable table(touches_of(t, seed, feeds), "touches.csv", {}, {});
  return calibrate_probe(table,
                         {.artefact = t.sphere ? CalibrationArtefact::kSphere : CalibrationArtefact::kRing,
                          .size_mm = 2 * t.half,
                          .ball_radius_mm = 2.5});
}

void expect_near(const ProbeCalibration& result, const std::string& name, double truth) {
  const Calibrated* const found = result.find(name);
  ASSERT_NE(found, nullptr) << name;
  EXPECT_NEAR(found->value, truth, 4 * found->std) << name;
  EXPECT_GT(found->std, 0) << name;
}

TEST(ProbeCal, FindsDelayPretravelLobesAndCentreOnASphereAndInARing) {
  for (const bool sphere : {true, false}) {
    Truth truth;
    truth.sphere = sphere;
    const ProbeCalibration result = calibrated(truth, 3, {60, 300, 1200});
    expect_near(result, "delay", 6);
    expect_near(result, "effective_tip_radius", 2.49);
    expect_near(result, "pretravel", 10);
    expect_near(result, "lobe", 1.5);
    expect_near(result, "lobe_azimuth", 20);
    expect_near(result, "centre_x", 100);
    expect_near(result, "centre_y", -50);
    EXPECT_LT(result.find("delay")->std, 0.02);
  }
}

TEST(ProbeCal, HoldsWhereTheProbeTouchedWhileAccelerating) {
  Truth truth;
  truth.acceleration = 500;  // 9 um of 120 at 1200 mm/min
  expect_near(calibrated(truth, 4, {60, 300, 1200}), "delay", 6);
}

// Touches all round in one plane; the delay differs from touch to touch by `spread`.
std::string plane_touches(const std::string& header, const char* row, double spread_s, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::string text = header + "\n";
  for (const double feed : {100.0, 500.0, 1500.0})
    for (int i = 0; i < 24; ++i) {
      const double phi = kPi * i / 12,
                   r = 15 - feed / 60 * (6e-3 + spread_s * normal(random)) + 2e-4 * normal(random);
      text += fmt::format(fmt::runtime(row), feed, r * std::cos(phi), r * std::sin(phi));
    }
  return text;
}

ProbeCalibration of_a_ball(const std::string& text) {
  TouchTable table(text, "plane.csv", {}, {});
  return calibrate_probe(table, {.artefact = CalibrationArtefact::kSphere, .size_mm = 25});
}

TEST(ProbeCal, ASphereTouchedInOnePlaneIsOneThroughItsCentre) {
  for (const auto& [header, row] : {std::pair{"feed[mm/min],x[mm],y[mm]", "{},{},{}\n"},
                                    {"feed[mm/min],x[mm],z[mm]", "{},{},{}\n"},
                                    {"feed[mm/min],x[mm],y[mm],z[mm]", "{},{},{},7\n"}}) {
    const ProbeCalibration result = of_a_ball(plane_touches(header, row, 0, 1));
    EXPECT_NEAR(result.find("effective_tip_radius")->value, 2.5, 0.001) << header;
    EXPECT_NEAR(result.find("delay")->value, 6, 0.02) << header;
    EXPECT_EQ(result.find("centre_z"), nullptr);
    EXPECT_TRUE(std::any_of(result.findings.begin(), result.findings.end(), [](const std::string& f) {
      return f.find("in one plane") != std::string::npos;
    }));
  }
}

TEST(ProbeCal, TellsTheSpreadOfTheDelayFromTouchToTouch) {
  constexpr double kSpread_s = 60e-6;
  int near = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const ProbeCalibration result =
        of_a_ball(plane_touches("feed[mm/min],x[mm],y[mm]", "{},{},{}\n", kSpread_s, seed));
    const Calibrated* const spread = result.find("delay_spread");
    ASSERT_NE(spread, nullptr) << seed;
    near += std::abs(spread->value - kSpread_s * 1e3) < 2.5 * spread->std ? 1 : 0;
  }
  EXPECT_GE(near, 17);
}

TEST(ProbeCal, SaysThatAnArcCannotShowLobes) {
  Truth truth;
  truth.most_deg = 200, truth.lobe = 0;
  const ProbeCalibration result = calibrated(truth, 5, {60, 1200});
  EXPECT_FALSE(result.lobes_found);
  EXPECT_NE(result.findings.front().find("Touch all round"), std::string::npos) << result.findings.front();
}

TEST(ProbeCal, NamesNoLobesWhereThereAreNone) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Truth truth;
    truth.lobe = 0;
    found += calibrated(truth, seed, {60, 1200}).lobes_found ? 1 : 0;
  }
  EXPECT_LE(found, 3) << "of 40 sets at 1 %";
}

TEST(ProbeCal, NamesFileLineAndWord) {
  const auto expect = [](const std::string& text, const std::string& message) {
    try {
      TouchTable table(text, "t.csv", {}, {});
      calibrate_probe(table, {.artefact = CalibrationArtefact::kBlock, .size_mm = 50, .ball_radius_mm = 1});
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  };
  expect("feed[mm/min],upper[um],lower[um]\n100,1,2\n200,x,3\n", "t.csv:3: \"x\"");
  expect("feed[mm/min],upper[um]\n100,1\n", "lower");
}

}  // namespace
}  // namespace vernier::calibration_test
