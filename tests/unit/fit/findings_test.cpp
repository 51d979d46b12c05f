// SPDX-License-Identifier: GPL-3.0-or-later
// What a fit found: model discrepancy beyond the noise, dependences that nobody measured, and what Reach
// makes of them.
#include "tools/fit/findings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "tests/support/machines.h"
#include "tools/fit/coverage/far_rows.h"
#include "tools/fit/coverage/reach.h"
#include "tools/fit/coverage/unmeasured.h"
#include "tools/fit/fit.h"
#include "tools/fit/set_up.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"

namespace vernier::findings_test {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

constexpr double kU_mm = 1e-3;

/// A machine of three axes and one thermometer with terms of its own along x and along z.
std::string text_of(const std::string& statics, const std::string& x, const std::string& z) {
  return "<machine name=\"m\"><variables><static>" + statics +
         "<BaseShift X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/></static>"
         "<machineaxes><X min=\"0\" max=\"600\"/><Y min=\"0\" max=\"400\"/><Z min=\"-300\" max=\"0\"/>"
         "</machineaxes><inputs><T unit=\"degC\" reference=\"20\"/></inputs></variables>"
         "<transforms branch=\"tool\"><sixdof X=\"X" +
         x + "\" Y=\"Y\" Z=\"Z" + z + "\"/></transforms></machine>";
}

Machine machine_of(const std::string& statics, const std::string& x, const std::string& z) {
  return parse_machine(text_of(statics, x, z), "m.xml");
}

const char* const kSquareness = "<a value=\"0\" nominal=\"0\" unit=\"rad\"/>";
const char* const kHeat =
    "<a value=\"0\" nominal=\"0\" unit=\"rad\"/><k value=\"0\" nominal=\"0\" unit=\"rad/K\"/>";

struct Row {
  double x, y, z, t;
  bool check = false;
};

std::vector<Row> anywhere(int count, std::mt19937_64& random, double t = 20) {
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Row> rows;
  for (int i = 0; i < count; ++i)
    rows.push_back({600 * share(random), 400 * share(random), -300 * share(random), t});
  return rows;
}

/// Readings of x, y and z: the nominal point, what `error` adds to it (mm), and noise.
Measurement readings(const Machine& machine, const std::vector<Row>& rows,
                     const std::function<Eigen::Vector3d(const Row&)>& error, std::mt19937_64& random,
                     bool with_u = true) {
  std::normal_distribution<double> normal(0, kU_mm);
  std::string csv = "X[mm],Y[mm],Z[mm],T[degC],x[mm],y[mm],z[mm],role";
  csv += with_u ? ",u[mm]\n" : "\n";
  for (const Row& row : rows) {
    const Eigen::Vector3d e = error(row);
    csv += fmt::format("{:.6f},{:.6f},{:.6f},{},{:.7f},{:.7f},{:.7f},{}{}\n", row.x, row.y, row.z, row.t,
                       row.x + e.x() + normal(random), row.y + e.y() + normal(random),
                       row.z + e.z() + normal(random), row.check ? "check" : "fit",
                       with_u ? fmt::format(",{}", kU_mm) : "");
  }
  return parse_measurement(csv, "s.csv", machine);
}

bool has(const Machine& machine, const std::string& code) {
  return std::any_of(machine.fitted->findings.begin(), machine.fitted->findings.end(),
                     [&](const FitRecord::Finding& one) { return one.code == code; });
}

/// Returns the text of a finding of the last fit; no text if the fit has no finding with this code.
std::string said(const Machine& machine, const std::string& code) {
  for (const FitRecord::Finding& one : machine.fitted->findings)
    if (one.code == code) return one.text;
  return {};
}

/// The machine file as it is written and read again.
Machine through_file(const Machine& fitted, const std::string& statics, const std::string& x,
                     const std::string& z) {
  return parse_machine(update_machine_text(text_of(statics, x, z), fitted, true), "m.xml");
}

TEST(FitFindings, ADiscrepancyIsMeasuredAlongItsDirection) {
  std::mt19937_64 random(1);
  const Machine machine = machine_of(kSquareness, "+a*Y", "");
  // GIVEN a wave of 2 um that the model lacks, along x
  const Measurement m = readings(
      machine, anywhere(150, random),
      [](const Row& row) { return Eigen::Vector3d(0.002 * std::sin(row.x / 3), 0, 0); }, random);
  const Machine fitted = through_file(fit::fit(machine, m).machine, kSquareness, "+a*Y", "");
  // THEN its root mean square of 1.41 um is found along x, and nothing along y and z
  EXPECT_NEAR(fitted.fitted->discrepancy_mm[0], 0.002 / std::sqrt(2), 0.0003);
  EXPECT_EQ(fitted.fitted->discrepancy_mm[1], 0);
  EXPECT_EQ(fitted.fitted->discrepancy_mm[2], 0);
  EXPECT_TRUE(has(fitted, "something-missing"));
  const States states = work_poses(fitted).states;
  const Reach reach(fitted);
  EXPECT_NEAR(1e-3 * reach.std_of_machine_um(states).minCoeff(), fitted.fitted->discrepancy_mm[0], 2e-4);
  EXPECT_LT(1e-3 * reach.std_um(states).maxCoeff(), 5e-4);
}

TEST(FitFindings, ARightModelHasNone) {
  const Machine machine = machine_of(kSquareness, "+a*Y", "");
  int something = 0;
  constexpr int kSurveys = 60;
  for (int k = 0; k < kSurveys; ++k) {
    std::mt19937_64 random(100 + static_cast<unsigned>(k));
    const Measurement m = readings(
        machine, anywhere(60, random), [](const Row& row) { return Eigen::Vector3d(5e-5 * row.y, 0, 0); },
        random);
    const FitResult result = fit::fit(machine, m);
    something += has(result.machine, "something-missing") ? 1 : 0;
    EXPECT_TRUE(result.machine.fitted->unvaried.empty());
  }
  EXPECT_LE(something, 2);  // one in a thousand of each survey: 0.06 expected
}

// A joint that turns by 118 deg has varied, whatever travel its file declares.
TEST(FitFindings, ATrueRobotHasNoJointThatStoodStill) {
  const Machine nominal = read_machine(VERNIER_SOURCE_DIR "/tables/machines/ur10e.xml");
  int unvaried = 0;
  constexpr unsigned kRobots = 12;
  for (unsigned seed = 1; seed <= kRobots; ++seed) {
    // GIVEN a robot with small errors of its joints and links, J2 over 118 deg of 720
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> share(-1, 1);
    Machine truth = nominal;
    for (Static& item : truth.statics)
      if (!item.hidden) item.value += (item.unit == "deg" ? 0.01 : 0.1) * normal(random);
    std::string csv = "J1[deg],J2[deg],J3[deg],J4[deg],J5[deg],J6[deg],x[mm],y[mm],z[mm],u[mm]\n";
    for (int i = 0; i < 60; ++i)
      csv += fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},0,0,0,0.05\n", 170 * share(random),
                         59 * share(random) - 2, 90 * share(random), 90 * share(random), 90 * share(random),
                         170 * share(random));
    Measurement m = parse_measurement(csv, "r.csv", nominal);
    const Eigen::VectorXd exact = predict(truth, m);
    for (std::size_t i = 0; i < m.observations.size(); ++i)
      m.observations[i].value = exact[static_cast<Eigen::Index>(i)] + 0.05 * normal(random);
    // THEN the fit names no coefficient as measured at one value of a joint only
    const Machine fitted = fit::fit(nominal, m).machine;
    for (const FitRecord::Unvaried& one : fitted.fitted->unvaried)
      std::printf("%u: %s at %s = %g\n", seed, one.coefficient.c_str(), one.variable.c_str(), one.at);
    unvaried += fitted.fitted->unvaried.empty() ? 0 : 1;
  }
  EXPECT_EQ(unvaried, 0);
}

/// A survey of 100 rows of a bridge with tables, every fifth row a check row; `error` adds to each reading.
Measurement survey_of(const Machine& bridge, unsigned seed,
                      const std::function<Eigen::Vector3d(int row)>& error) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, kU_mm);
  std::uniform_real_distribution<double> place(0, 1);
  std::string csv = "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm],u[mm],role\n";
  for (int i = 0; i < 100; ++i)
    csv += fmt::format("{:.3f},{:.3f},{:.3f},0,0,0,{},{}\n", 600 * place(random), 400 * place(random),
                       -300 * place(random), kU_mm, i % 5 == 4 ? "check" : "fit");
  Measurement m = parse_measurement(csv, "s.csv", bridge);
  const Eigen::VectorXd exact = predict(bridge, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    Observation& o = m.observations[i];
    o.value = exact[static_cast<Eigen::Index>(i)] + normal(random) +
              error(static_cast<int>(
                  o.row))[static_cast<Eigen::Index>(o.kind) - static_cast<Eigen::Index>(ObservationKind::kX)];
  }
  return m;
}

TEST(FitFindings, AStepOfTheInstrumentHasItsSizeAndTheRowOfTheFile) {
  const Machine bridge = parse_machine(support::bridge_text(7), "bridge.xml");
  for (unsigned seed = 1; seed <= 4; ++seed) {
    // GIVEN a step of 60 um in y from the 61st row on
    const FitResult result = fit::fit(
        bridge, survey_of(bridge, seed, [](int row) { return Eigen::Vector3d(0, row >= 60 ? 0.06 : 0, 0); }));
    // THEN the finding names the row and line of the file, and no step is far from that size
    ASSERT_TRUE(has(result.machine, "disturbed")) << seed;
    // as a possibility: an effect that the model does not contain may look the same
    EXPECT_EQ(said(result.machine, "disturbed").find("Possibly the survey was disturbed: "), 0U);
    const std::string& words = result.machine.fitted->disturbance;
    EXPECT_TRUE(words.find("row 61 (s.csv:62)") != std::string::npos ||
                words.find("before s.csv:62") != std::string::npos)
        << seed << ": " << words;
    for (const NoiseStep& step : result.noise.steps) {
      EXPECT_EQ(step.row, 60U) << seed;
      EXPECT_NEAR(step.height * kU_mm, 0.06, 5 * step.std * kU_mm + 0.002) << seed;
    }
  }
}

TEST(OtherSetUp, AFileOfAnotherSetUpIsNamedWithBothResiduals) {
  const Machine bridge = parse_machine(support::bridge_text(7), "bridge.xml");
  const auto none = [](int) { return Eigen::Vector3d::Zero(); };
  Measurement m = survey_of(bridge, 9, none);
  EXPECT_TRUE(files_set_up_elsewhere(bridge, m).empty());
  // GIVEN a file of check rows, read by an instrument that stood a metre away
  for (Observation& o : m.observations) o.value += o.kind == ObservationKind::kX ? 1000 : 0;
  m.check.assign(m.check.size(), 1);
  const std::vector<OtherSetUp> found = files_set_up_elsewhere(bridge, m);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].before_um, 1e6 / std::sqrt(3), 1e3);
  EXPECT_LT(found[0].own_um, 3);
  EXPECT_NE(found[0].sentence().find("s.csv: the model does not contain the set-up of this file"),
            std::string::npos);
}

TEST(OtherSetUp, CheckRowsOfAFileFromAnotherSetUpAreNamed) {
  const Machine bridge = parse_machine(support::bridge_text(7), "bridge.xml");
  Measurement m = survey_of(bridge, 9, [](int) { return Eigen::Vector3d::Zero(); });
  // GIVEN every third row as a check row, read after the instrument moved by 12.5 mm
  for (std::size_t row = 0; row < m.rows(); ++row) m.check[row] = row % 3 == 0 ? 1 : 0;
  EXPECT_TRUE(files_set_up_elsewhere(bridge, m).empty());
  for (Observation& o : m.observations)
    o.value += o.kind == ObservationKind::kX && m.check[o.row] != 0 ? 12.5 : 0;
  // THEN these rows are named, and not the file
  const std::vector<OtherSetUp> found = files_set_up_elsewhere(bridge, m);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].rows, "the check rows");
  EXPECT_NE(found[0].sentence().find("does not contain the set-up of the check rows"), std::string::npos)
      << found[0].sentence();
}

TEST(FarRows, TwoInterchangedPointsAreNamed) {
  const Machine bridge = parse_machine(support::bridge_text(7), "bridge.xml");
  Measurement m = survey_of(bridge, 9, [](int) { return Eigen::Vector3d::Zero(); });
  const auto posed = [&](const Measurement& rows) { return set_up(bridge, rows); };
  EXPECT_EQ(far_rows(m, posed), "");
  constexpr std::size_t kFirst = 40, kKinds = 3;
  for (std::size_t k = 0; k < kKinds; ++k)
    std::swap(m.observations[kKinds * kFirst + k].value, m.observations[kKinds * (kFirst + 1) + k].value);
  const std::string found = far_rows(m, posed);
  EXPECT_EQ(found.find("s.csv:42 ("), 0U) << found;
  EXPECT_NE(found.find(", s.csv:43 ("), std::string::npos) << found;
  EXPECT_NE(found.find("mm) are far from the rest"), std::string::npos) << found;
  // Readings that have no rule name no row.
  Measurement shifted = m;
  for (std::size_t i = 0; i + kKinds < m.observations.size(); ++i)
    shifted.observations[i].value = m.observations[i + kKinds].value;
  EXPECT_EQ(far_rows(shifted, posed), "");
}

TEST(FitFindings, AReversalErrorIsNoDisturbance) {
  const Machine bridge = parse_machine(support::bridge_text(7), "bridge.xml");
  const FitResult result = fit::fit(bridge, survey_of(bridge, 5, [](int row) {
                                      return Eigen::Vector3d(row % 2 == 0 ? 0.03 : -0.03, 0, 0);
                                    }));
  EXPECT_TRUE(has(result.machine, "something-missing"));
  EXPECT_FALSE(has(result.machine, "disturbed"));
  // The sheet of a safe run still counts the residual.
  EXPECT_GT(result.machine.fitted->disturbed, 0);
}

TEST(FitFindings, HeatMeasuredAtOnePlaceIsNoSquareness) {
  std::mt19937_64 random(2);
  const std::string z = "+a*X+k*(T-20)*Y";
  const Machine machine = machine_of(kHeat, "", z);
  // GIVEN a survey of the cold machine, and heat with X and Y standing still; the column really grows
  std::vector<Row> rows = anywhere(80, random);
  for (int i = 0; i <= 20; ++i) rows.push_back({300, 200, -150, 20 + 0.5 * i});
  const auto growth = [](const Row& row) { return Eigen::Vector3d(0, 0, 0.003 * (row.t - 20)); };
  const Machine fitted =
      through_file(fit::fit(machine, readings(machine, rows, growth, random)).machine, kHeat, "", z);
  // THEN the dependence on Y counts as unmeasured
  ASSERT_EQ(fitted.fitted->unvaried.size(), 1U);
  EXPECT_EQ(fitted.fitted->unvaried[0].coefficient, "k");
  EXPECT_EQ(fitted.fitted->unvaried[0].variable, "Y");
  EXPECT_NEAR(fitted.fitted->unvaried[0].at, 200, 1);
  EXPECT_TRUE(has(fitted, "not-varied"));
  // and the uncertainty at the end of Y holds the truth: 30 um of growth where the model says 0
  States far = make_states(1, fitted);
  far.axis[0][0] = 300, far.axis[1][0] = 0, far.axis[2][0] = -150;
  far.input[0][0] = 30;
  const double off = std::abs(0.03 - deviation(fitted, far)(2, 0));
  EXPECT_GT(off, 0.02);
  EXPECT_LT(off, 2 * std::sqrt(Reach(fitted).covariance(far)[0](2, 2)));
  // WHEN heat is measured all over, the same model is measured
  std::vector<Row> all = anywhere(80, random);
  for (const Row& hot : anywhere(40, random, 28)) all.push_back(hot);
  const auto tilt = [](const Row& row) { return Eigen::Vector3d(0, 0, 1e-5 * (row.t - 20) * row.y); };
  EXPECT_TRUE(fit::fit(machine, readings(machine, all, tilt, random)).machine.fitted->unvaried.empty());
}

TEST(FitFindings, HeatMeasuredOnADiagonalOfTwoAxesDoesNotShowWhichOneItDependsOn) {
  std::mt19937_64 random(3);
  const std::string z = "+a*X+k*(T-20)*X";
  const Machine machine = machine_of(kHeat, "", z);
  // GIVEN heat with X and Y on a diagonal of the table; the beam really tilts along Y, the model says along X
  std::vector<Row> rows = anywhere(80, random);
  for (int i = 0; i <= 30; ++i) rows.push_back({20.0 * i, 400 - 40.0 / 3 * i, -150, 28});
  const auto tilt = [](const Row& row) { return Eigen::Vector3d(0, 0, 1e-5 * (row.t - 20) * (400 - row.y)); };
  const Machine fitted =
      through_file(fit::fit(machine, readings(machine, rows, tilt, random)).machine, kHeat, "", z);
  // THEN the dependence on X counts as unmeasured beside that on Y
  ASSERT_EQ(fitted.fitted->unvaried.size(), 1U);
  const FitRecord::Unvaried& one = fitted.fitted->unvaried[0];
  EXPECT_EQ(one.coefficient, "k");
  EXPECT_EQ(one.variable, "X");
  EXPECT_EQ(one.follows, "Y");
  EXPECT_NEAR(one.slope, -1.5, 0.01);
  EXPECT_NEAR(one.at + one.slope * (400 - one.about), 0, 1);
  // and the uncertainty holds the truth at the corner that the diagonal does not visit
  States corner = make_states(1, fitted);
  corner.axis[0][0] = 600, corner.axis[1][0] = 400, corner.axis[2][0] = -150;
  corner.input[0][0] = 28;
  const double off = std::abs(deviation(fitted, corner)(2, 0));
  EXPECT_GT(off, 0.03);
  EXPECT_LT(off, 2 * std::sqrt(Reach(fitted).covariance(corner)[0](2, 2)));
}

TEST(FitFindings, AWaveBetweenTargetsIsUncertainAndOneThatTargetsFollowIsNot) {
  const std::string statics =
      "<k1 value=\"0\" nominal=\"0\" unit=\"mm\"/><k2 value=\"0\" nominal=\"0\" unit=\"mm\"/>";
  const std::string x = "+k1*sin(360*X/18)+k2*cos(360*X/18)";
  const Machine machine = machine_of(statics, x, "");
  const auto wave = [](const Row& row) {
    return Eigen::Vector3d(0.005 * std::sin(2 * 3.14159265358979 * row.x / 18), 0, 0);
  };
  for (const double step : {20.0, 3.0}) {
    std::mt19937_64 random(3);
    std::vector<Row> rows;
    for (int pass = 0; pass < 3; ++pass)
      for (double at = 0; at <= 600; at += step) rows.push_back({at, 133.0 * pass, -100.0 * pass, 20});
    const Machine fitted =
        through_file(fit::fit(machine, readings(machine, rows, wave, random)).machine, statics, x, "");
    ASSERT_EQ(fitted.fitted->alternatives.size(), step > 10 ? 1U : 0U);
    const States states = work_poses(fitted).states;
    const double std_um = Reach(fitted).std_um(states).norm() / std::sqrt(states.count);
    if (step > 10) {
      EXPECT_NEAR(fitted.fitted->alternatives[0].period, 180, 5);  // 1 / (1 / 18 - 1 / 20)
      EXPECT_TRUE(has(fitted, "not-distinguished"));
      EXPECT_GT(std_um, 2.5) << "targets every 20 mm do not show a wave of 18 mm between them";
    } else {
      EXPECT_LT(std_um, 0.6);
    }
  }
  // Positions of no common step: what is between them is measured by the others.
  std::mt19937_64 random(4);
  const Machine fitted = through_file(
      fit::fit(machine, readings(machine, anywhere(150, random), wave, random)).machine, statics, x, "");
  EXPECT_TRUE(fitted.fitted->alternatives.empty());
  EXPECT_LT(Reach(fitted).std_um(work_poses(fitted).states).maxCoeff(), 1);
}

TEST(FitFindings, CheckRowsAtPosesOfFitRowsAreNotIndependent) {
  std::mt19937_64 random(5);
  const Machine machine = machine_of(kSquareness, "+a*Y", "");
  const auto none = [](const Row&) { return Eigen::Vector3d(0, 0, 0); };
  std::vector<Row> rows = anywhere(40, random), same = rows, other = anywhere(40, random);
  for (Row& row : same) row.check = true;
  for (Row& row : other) row.check = true;
  std::vector<Row> repeated = rows, fresh = rows;
  repeated.insert(repeated.end(), same.begin(), same.end());
  fresh.insert(fresh.end(), other.begin(), other.end());
  EXPECT_TRUE(
      has(fit::fit(machine, readings(machine, repeated, none, random)).machine, "check-not-independent"));
  EXPECT_FALSE(
      has(fit::fit(machine, readings(machine, fresh, none, random)).machine, "check-not-independent"));
}

TEST(FitFindings, NoiseThatNobodyStatedIsSaid) {
  std::mt19937_64 random(6);
  const Machine machine = machine_of(kSquareness, "+a*Y", "");
  const auto none = [](const Row&) { return Eigen::Vector3d(0, 0, 0); };
  EXPECT_TRUE(has(fit::fit(machine, readings(machine, anywhere(40, random), none, random, false)).machine,
                  "noise-unknown"));
}

TEST(FitFindings, RepeatsInOtherRunsHaveTheOptionThatMakesThemRepeats) {
  // GIVEN a positioning test of ISO 230-2: five runs in each direction, and no column setup
  const Machine machine = model::parse_machine(
      R"(<machine name="m"><variables><static><k value="0" nominal="0" unit=""/></static>
         <machineaxes><X min="0" max="500"/></machineaxes></variables>
         <transforms><sixdof X="X+k*X"/></transforms></machine>)",
      "m.xml");
  std::string with = "X[mm],x[mm],dirX,run,setup\n", without = "X[mm],x[mm],dirX,run\n";
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.0007);
  for (int run = 1; run <= 5; ++run)
    for (const int sense : {1, -1})
      for (int at = 0; at <= 500; at += 100) {
        const std::string row = fmt::format("{},{:.6f},{},{}", at, at * 1.00001 + noise(random), sense, run);
        without += row + "\n";
        with += row + ",1\n";
      }
  const auto text = [&](const std::string& file) {
    const Machine fitted = fit::fit(machine, model::parse_measurement(file, "m.csv", machine)).machine;
    for (const auto& one : fitted.fitted->findings)
      if (one.code == "noise-unknown") return one.text;
    return std::string();
  };
  // THEN the finding says what to do, and the column that it names makes the noise known
  EXPECT_NE(text(without).find("repeat targets in other runs"), std::string::npos) << text(without);
  EXPECT_NE(text(without).find("--set \"setup=1\""), std::string::npos);
  EXPECT_EQ(text(with), "");
}

TEST(FitFindings, ATurnThatOneToolShowsIsUncertainWithAnother) {
  // GIVEN a nose that shifts along X with its heat, a model in which it turns, and one tool
  const auto text = [](bool turn) {
    const std::string term = "k*(T-20)*X/300";
    return "<machine name=\"m\"><variables><static><k value=\"0\" nominal=\"0\" unit=\"mm/K\"/>"
           "<BaseShift X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/></static>"
           "<machineaxes><X min=\"0\" max=\"600\"/><Y min=\"0\" max=\"400\"/><Z min=\"-300\" max=\"0\"/>"
           "</machineaxes><inputs><T unit=\"degC\" reference=\"20\"/></inputs></variables>"
           "<transforms branch=\"tool\"><sixdof X=\"X\" Y=\"Y\" Z=\"Z\" rY=\"" +
           (turn ? term : "0") + "\"/><sixdof X=\"" + (turn ? "0" : term) +
           "\" Z=\"-50\"/></transforms></machine>";
  };
  std::mt19937_64 random(7);
  std::vector<Row> rows = anywhere(100, random);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].t = 20 + 0.1 * static_cast<double>(i);
  for (const bool turn : {true, false}) {
    const std::string file = text(turn);
    const Machine machine = parse_machine(file, "m.xml");
    const auto shift = [](const Row& row) {
      return Eigen::Vector3d(0.002 * (row.t - 20) * row.x / 300, 0, -50);
    };
    const Machine fitted = parse_machine(
        update_machine_text(file, fit::fit(machine, readings(machine, rows, shift, random)).machine, true),
        "m.xml");
    ASSERT_EQ(fitted.fitted->alternatives.size(), turn ? 1U : 0U);
    if (!turn) continue;
    // THEN the turn is as certain as before with the tool that was used, and wholly uncertain with a longer
    // one
    States hot = make_states(1, fitted);
    hot.axis[0][0] = 600, hot.axis[1][0] = 200, hot.axis[2][0] = -100;
    hot.input[0][0] = 30;
    EXPECT_LT(Reach(fitted).std_um(hot)[0], 3);
    const Machine longer = with_tool(fitted, {0, 0, -200});
    EXPECT_GT(Reach(longer).std_um(hot)[0], 100) << "the turn claims 160 um more than the shift";
  }
}

}  // namespace
}  // namespace vernier::findings_test
