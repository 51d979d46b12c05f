// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

#include "tests/support/machines.h"
#include "tools/fit/fit.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/safety/safety_sheet.h"
#include "tools/safety/sources.h"

namespace vernier::safety_test {

using namespace vernier::model;
using namespace vernier::safety;
using namespace vernier::text;
namespace {

constexpr std::uint64_t kSeed = 11;

/// A column machine of three axes: squareness, a tool length, a roll of Z.
Machine small_machine(const std::string& statics, const std::string& variables = "",
                      const std::string& x = "X-alpha*Y", const std::string& z = "Z") {
  return parse_machine("<machine name=\"small\"><variables><static>" + statics +
                           "<BaseShift X=\"0\"/></static><machineaxes><X min=\"0\" max=\"600\" "
                           "maxcorrection=\"0.1\"/><Y min=\"0\" "
                           "max=\"400\"/><Z min=\"-300\" max=\"0\"/></machineaxes>" +
                           variables + "</variables><transforms><sixdof X=\"" + x + "\" Y=\"Y\" Z=\"" + z +
                           "\"/></transforms></machine>",
                       "small.xml");
}

const SafetyFinding& finding(const SafetySheet& sheet, SafetyRule rule) {
  return sheet.findings.at(static_cast<std::size_t>(rule));
}

Measurement survey(const Machine& truth, const Machine& model, double u_mm, const std::string& header = "") {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(0, 1);
  std::string csv = "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm],u[mm]" + header + "\n";
  for (int row = 0; row < 120; ++row)
    csv += std::to_string(600 * place(random)) + "," + std::to_string(400 * place(random)) + "," +
           std::to_string(-300 * place(random)) + ",0,0,0," + std::to_string(u_mm) + "\n";
  Measurement m = parse_measurement(csv, "survey.csv", model);
  const Eigen::VectorXd exact = predict(truth, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value = exact[static_cast<Eigen::Index>(i)] + u_mm * normal(random);
  return m;
}

TEST(SafetySheet, PassesAMachineOfSmallErrors) {
  const Machine machine = small_machine("<alpha value=\"1e-4\" nominal=\"0\" unit=\"rad\"/>");
  const SafetySheet sheet = safety_sheet(machine);
  EXPECT_TRUE(sheet.ok()) << sheet.refusal();
  ASSERT_EQ(sheet.findings.size(), kSafetyRuleCount - 1);                     // `bound` is the image's
  EXPECT_FALSE(finding(sheet, SafetyRule::kUncertainty).value.has_value());   // never fitted: not known
  EXPECT_NEAR(*finding(sheet, SafetyRule::kMaxCorrection).value, 0.4, 0.02);  // 400 mm * 1e-4 of 0.1 mm
  const std::vector<std::string> unknown = sheet.not_known();
  for (const char* rule : {"uncertainty", "measured-range", "check-rows"})
    EXPECT_NE(std::find(unknown.begin(), unknown.end(), rule), unknown.end()) << rule;
  EXPECT_EQ(std::find(unknown.begin(), unknown.end(), "max-correction"), unknown.end());
}

TEST(SafetySheet, RefusesAbsurdAnglesAndNamesThem) {
  const Machine machine = small_machine("<alpha value=\"-2.4\" nominal=\"0\" unit=\"rad\"/>");
  const SafetySheet sheet = safety_sheet(machine);
  EXPECT_FALSE(sheet.ok());
  EXPECT_NE(sheet.refusal().find("alpha"), std::string::npos) << sheet.refusal();
  // All rules that are not met are in the line, so that one answer is enough.
  for (const SafetyFinding& one : sheet.findings)
    EXPECT_EQ(sheet.refusal().find(std::string("--accept ") + rule_name(one.rule)) != std::string::npos,
              !one.ok && !one.accepted)
        << sheet.refusal();
  EXPECT_EQ(finding(sheet, SafetyRule::kCorrection).culprit, "alpha");
  // One rule overridden is one rule overridden.
  const SafetySheet part = safety_sheet(machine, {SafetyRule::kCorrection});
  EXPECT_FALSE(part.ok());
  const SafetySheet all = safety_sheet(machine, {SafetyRule::kCorrection, SafetyRule::kMaxCorrection});
  EXPECT_TRUE(all.ok()) << all.refusal();
  EXPECT_EQ(all.accepted_mask(), 3U);
}

TEST(SafetySheet, RefusesTermsThatCancel) {
  const Machine machine = small_machine(
      "<alpha value=\"5e-3\" nominal=\"0\" unit=\"rad\"/><beta value=\"-4.99e-3\" nominal=\"0\" "
      "unit=\"rad\"/>",
      "", "X-alpha*Y-beta*Y");
  const SafetySheet sheet = safety_sheet(machine);
  EXPECT_NEAR(*finding(sheet, SafetyRule::kCancellation).value, 999, 2);
  EXPECT_FALSE(finding(sheet, SafetyRule::kCancellation).ok);
}

TEST(SafetySheet, RefusesSetUpThatWouldReachAnAxis) {
  const Machine machine = small_machine("<x0 value=\"0.065\" nominal=\"0\" unit=\"mm\"/>", "", "X+x0");
  const SafetySheet sheet = safety_sheet(machine);
  EXPECT_NEAR(*finding(sheet, SafetyRule::kSetUp).value, 65, 1e-9);
  EXPECT_FALSE(finding(sheet, SafetyRule::kSetUp).ok);
  EXPECT_EQ(finding(sheet, SafetyRule::kSetUp).culprit, "x0");
}

TEST(SafetySheet, JudgesWhereItWorksAgainstWhereItWasMeasured) {
  const std::string statics = "<alpha value=\"0\" nominal=\"0\" unit=\"rad\"/>";
  Machine truth = small_machine(statics);
  truth.statics[0].value = 5e-5;
  const Machine model = small_machine(statics);
  Measurement m = survey(truth, model, 1e-3);
  m.states.axis[1] *= 0.5;  // Y measured up to 200 of 400 mm
  const Eigen::VectorXd exact = predict(truth, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value = exact[static_cast<Eigen::Index>(i)];
  Machine fitted = fit::fit(model, m).machine;
  EXPECT_NEAR(*finding(safety_sheet(fitted), SafetyRule::kMeasuredRange).value, 1, 0.05);
  EXPECT_EQ(finding(safety_sheet(fitted), SafetyRule::kMeasuredRange).culprit.substr(0, 22),
            "axis Y, measured from ");
  fitted.volume = {{1, 0, 200}};  // <volume>: it works where it was measured
  EXPECT_TRUE(safety_sheet(fitted).ok()) << safety_sheet(fitted).refusal();
}

TEST(SafetySheet, RowsOutsideTheTravelAreOfAnotherMachine) {
  const std::string statics = "<alpha value=\"0\" nominal=\"0\" unit=\"rad\"/>";
  Machine truth = small_machine(statics);
  truth.statics[0].value = 5e-5;
  Machine model = small_machine(statics);
  const Measurement m = survey(truth, model, 1e-3);
  const auto outside = [](const Machine& machine) {
    const auto& found = machine.fitted->findings;
    const auto at = std::find_if(found.begin(), found.end(),
                                 [](const FitRecord::Finding& one) { return one.code == "outside-travel"; });
    return at == found.end() ? std::string() : at->text;
  };
  EXPECT_EQ(outside(fit::fit(model, m).machine), "");
  // GIVEN the file of a smaller machine
  model.axes[0].max = 200;
  const Machine fitted = fit::fit(model, m).machine;
  EXPECT_NE(outside(fitted).find("Positions are outside the travel of the machine file: X (0 to 200) in "),
            std::string::npos)
      << outside(fitted);
  const SafetyFinding& refused = finding(safety_sheet(fitted), SafetyRule::kMeasuredRange);
  EXPECT_FALSE(refused.ok);
  EXPECT_NE(refused.culprit.find("outside its travel 0 to 200: the file describes another machine"),
            std::string::npos)
      << refused.culprit;
  // WHEN min and max are the range of work of a machine that was measured further
  model.axes[0].max = 400;
  EXPECT_TRUE(finding(safety_sheet(fit::fit(model, m).machine), SafetyRule::kMeasuredRange).ok);
}

TEST(SafetySheet, AnAxisThatStoodStillCountsOnlyIfACorrectionDependsOnIt) {
  // GIVEN a fitted scale error of X, and rows in which Z stood still
  const std::string statics =
      "<alpha value=\"0\" nominal=\"0\" unit=\"rad\"/><gamma value=\"0\" nominal=\"0\" unit=\"rad\" "
      "Hide=\"true\"/>";
  Machine truth = small_machine(statics, "", "X-alpha*Y+gamma*Z");
  const Machine model = truth;
  truth.statics[0].value = 5e-5;
  Measurement m = survey(truth, model, 1e-3);
  m.states.axis[2].setConstant(-100);
  const Eigen::VectorXd exact = predict(truth, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value = exact[static_cast<Eigen::Index>(i)];
  Machine fitted = fit::fit(model, m).machine;
  // WHEN no correction depends on Z, the rule is met, and the fit names the axis
  EXPECT_TRUE(finding(safety_sheet(fitted), SafetyRule::kMeasuredRange).ok)
      << finding(safety_sheet(fitted), SafetyRule::kMeasuredRange).culprit;
  const auto& found = fitted.fitted->findings;
  const auto stood = std::find_if(found.begin(), found.end(),
                                  [](const FitRecord::Finding& one) { return one.code == "stood-still"; });
  ASSERT_NE(stood, found.end());
  EXPECT_EQ(stood->text,
            "One axis stood still in all rows (Z at -100): the correction of the other axes is known at this "
            "position "
            "only.");
  // THEN a squareness of Z makes the correction depend on Z, and the rule refuses with a remedy
  fitted.statics[1].value = 1e-5;
  const SafetyFinding& refused = finding(safety_sheet(fitted), SafetyRule::kMeasuredRange);
  EXPECT_FALSE(refused.ok);
  EXPECT_NE(
      refused.culprit.find("the correction depends on Z, and Z stood still: measure at other positions of Z"),
      std::string::npos)
      << refused.culprit;
}

TEST(SafetySheet, NamesEveryAxisThatWorksOutsideItsMeasuredRange) {
  const std::string statics =
      "<alpha value=\"0\" nominal=\"0\" unit=\"rad\"/><beta value=\"0\" nominal=\"0\" unit=\"\"/>";
  Machine machine = small_machine(statics);
  machine.statics[0].value = 5e-5;
  Measurement m = survey(machine, small_machine(statics), 1e-3);
  Machine fitted = fit::fit(machine, m).machine;
  model::FitRecord record = *fitted.fitted;
  for (model::FitRecord::Range& one : record.measured) one.max = one.min + 0.4 * (one.max - one.min);
  fitted.fitted = std::make_shared<model::FitRecord>(record);
  const std::string culprit = finding(safety_sheet(fitted), SafetyRule::kMeasuredRange).culprit;
  std::size_t named = 0;
  for (std::size_t at = 0; (at = culprit.find("axis ", at)) != std::string::npos; ++at) ++named;
  EXPECT_GE(named, 2U) << culprit;
  EXPECT_NE(safety_sheet(fitted).refusal().find(culprit), std::string::npos);
}

/// The sheet of a machine whose X has a term in the time or in the visits, fitted to 120 rows. `seconds`:
/// from one row to the next; 0: the rows have no times.
SafetySheet of_clock(const std::string& term, double seconds) {
  const std::string statics =
      "<alpha value=\"0\" nominal=\"0\" unit=\"rad\"/><k value=\"0\" nominal=\"0\" unit=\"mm\"/>";
  const Machine model = small_machine(statics, "", "X-alpha*Y+k*" + term);
  Machine truth = model;
  truth.statics[0].value = 5e-5, truth.statics[1].value = 0.02;
  Measurement m = survey(model, model, 1e-3);
  for (Eigen::Index row = 0; row < m.states.time.size(); ++row)
    m.states.time[row] = seconds * static_cast<double>(row);
  const Eigen::VectorXd error = predict(truth, m) - predict(model, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value += error[static_cast<Eigen::Index>(i)];
  return safety_sheet(fit::fit(model, m).machine);
}

TEST(SafetySheet, RefusesACorrectionThatStillDriftsWithTheTime) {
  const SafetySheet sheet = of_clock("(t/3600)", 30);
  const SafetyFinding &drift = finding(sheet, SafetyRule::kInputRange),
                      warm_up = finding(of_clock("(1-exp(-t/600))", 30), SafetyRule::kInputRange);
  EXPECT_FALSE(drift.ok);
  EXPECT_NEAR(*drift.value, (86400 - 3570) / 3570.0, 1e-6);
  EXPECT_NE(drift.culprit.find("time t, measured from 0 to 3570 s: the correction changes by"),
            std::string::npos)
      << drift.culprit;
  // The remedy is that of the time, not of a temperature.
  EXPECT_NE(sheet.refusal().find("; a drift of the base or of the instrument is no error that a board"),
            std::string::npos)
      << sheet.refusal();
  EXPECT_EQ(sheet.refusal().find("measure at the temperatures"), std::string::npos) << sheet.refusal();
  EXPECT_TRUE(warm_up.ok) << "it ended within the hour: " << warm_up.culprit;
}

/// A survey without times: the drift of its instrument follows the order of its readings.
TEST(SafetySheet, RefusesACorrectionThatFollowsTheOrderOfTheReadings) {
  const SafetySheet sheet = of_clock("(visit/120)", 0);
  const SafetyFinding &drift = finding(sheet, SafetyRule::kInputRange),
                      ended = finding(of_clock("(1-exp(-visit/20))", 0), SafetyRule::kInputRange);
  EXPECT_FALSE(drift.ok);
  EXPECT_NEAR(*drift.value, (1e6 - 119) / 119, 1e-6);
  EXPECT_NE(drift.culprit.find("order of the readings visit, measured from 0 to 119: the correction"),
            std::string::npos)
      << drift.culprit;
  EXPECT_NE(sheet.refusal().find("; an error that follows the order of the readings"), std::string::npos)
      << sheet.refusal();
  EXPECT_TRUE(ended.ok) << "it ended within the rows: " << ended.culprit;
}

/// The set-up of the rows of one run stays with these rows: no image contains it.
TEST(SafetySheet, PassesASetUpOfEachRun) {
  const auto machine_of = [](const std::string& shifts) {
    return parse_machine(
        "<machine><variables><static><alpha value=\"0\" nominal=\"0\" unit=\"rad\"/>" + shifts +
            "</static><machineaxes><X min=\"0\" max=\"600\"/><Y min=\"0\" max=\"400\"/><Z min=\"-300\" "
            "max=\"0\"/></machineaxes></variables><transforms><sixdof X=\"X-alpha*Y\" Y=\"Y\" Z=\"Z\"/>"
            "</transforms></machine>",
        "runs.xml");
  };
  const Machine model = machine_of("<BaseShift run=\"a\" X=\"0\"/><BaseShift run=\"b\" X=\"0\"/>");
  Machine truth = model;
  truth.statics[0].value = 5e-5;
  Measurement m = survey(truth, model, 1e-3);
  m.states.run_names = {"a", "b"};
  for (std::size_t row = 0; row < m.rows(); ++row) m.states.run[row] = row < m.rows() / 2 ? 0 : 1;
  for (Observation& one : m.observations)
    if (one.kind == ObservationKind::kX && m.states.run[one.row] == 1) one.value += 0.5;
  const Machine fitted = fit::fit(model, m).machine;
  ASSERT_NEAR(fitted.base_shifts[1].value[0] - fitted.base_shifts[0].value[0], 0.5, 1e-3);
  EXPECT_TRUE(finding(safety_sheet(fitted), SafetyRule::kInputRange).ok);
  EXPECT_TRUE(finding(safety_sheet(fitted), SafetyRule::kSetUp).ok);
}

TEST(SafetySheet, JudgesEveryDeclaredTool) {
  const std::string statics = "<alpha value=\"0\" nominal=\"0\" unit=\"rad\"/>";
  const std::string tables =
      "<tools><long Z=\"-400\"/></tools><comptables><table axis=\"Z\" fit=\"rX\">"
      "<station loc=\"-300\"/><station loc=\"0\"/></table></comptables>";
  const auto machine_of = [&](const std::string& text) {
    return parse_machine(
        "<machine><variables><static>" + statics +
            "<BaseShift X=\"0\"/></static><machineaxes><X min=\"0\" max=\"600\"/><Y min=\"0\" "
            "max=\"400\"/><Z min=\"-300\" max=\"0\"/></machineaxes>" +
            text +
            "</variables><transforms><sixdof X=\"X-alpha*Y\" Y=\"Y\" Z=\"Z\" rX=\"rZx\"/>"
            "</transforms></machine>",
        "tools.xml");
  };
  Machine truth = machine_of(tables);
  truth.statics[0].value = 5e-5;
  const Machine fitted = fit::fit(machine_of(tables), survey(truth, machine_of(tables), 1e-3)).machine;
  const SafetySheet sheet = safety_sheet(fitted);
  const SafetyFinding& found = finding(sheet, SafetyRule::kUncertainty);
  EXPECT_EQ(found.culprit, "tool long");
  // The angle of Z was never seen: only the long tool asks for it.
  Machine without = fitted;
  without.tools.clear();
  EXPECT_LT(*finding(safety_sheet(without), SafetyRule::kUncertainty).value, 0.2 * *found.value);
}

TEST(SafetySheet, RefusesAFitThatOneReadingBent) {
  const std::string statics = "<alpha value=\"0\" nominal=\"0\" unit=\"rad\"/>";
  const Machine model = small_machine(statics);
  Machine truth = model;
  truth.statics[0].value = 5e-5;
  Measurement m = survey(truth, model, 1e-3);
  m.observations[100].value += 5;
  const SafetySheet sheet = safety_sheet(fit::fit(model, m).machine);
  EXPECT_FALSE(finding(sheet, SafetyRule::kOutlier).ok);
  EXPECT_EQ(finding(sheet, SafetyRule::kOutlier).culprit,
            "survey.csv:35 y");  // reading 100: row 33, header first
}

TEST(SafetySheet, RefusesAFitThatUnseenRowsDoNotBearOut) {
  const Machine model =  // a twist, which no set-up takes
      small_machine("<k value=\"0\" nominal=\"0\"/>", "", "X", "Z+k*(X-300)*(Y-200)");
  Machine truth = model, other = model;
  truth.statics[0].value = 1e-6;
  other.statics[0].value = -1e-6;
  Measurement m = survey(truth, model, 1e-3);
  const Measurement elsewhere = survey(other, model, 1e-3);
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const std::size_t row = m.observations[i].row;
    if (row % 4 != 0) continue;
    m.check[row] = 1;
    m.observations[i].value = elsewhere.observations[i].value;
  }
  const Machine fitted = fit::fit(model, m).machine;
  const SafetySheet sheet = safety_sheet(fitted);
  EXPECT_NEAR(*finding(sheet, SafetyRule::kCheckRows).value, 2, 0.3);
  EXPECT_NE(sheet.refusal().find("check-rows"), std::string::npos) << sheet.refusal();
  EXPECT_TRUE(safety_sheet(fitted, {SafetyRule::kCheckRows}).ok());
}

TEST(SafetySheet, RefusesASurveyInWhichSomethingElseMoved) {
  const Machine model = small_machine("<alpha value=\"0\" nominal=\"0\" unit=\"rad\"/>");
  Machine truth = model;
  truth.statics[0].value = 1e-4;
  Measurement m = survey(truth, model, 1e-3);
  EXPECT_TRUE(safety_sheet(fit::fit(model, m).machine).ok())
      << safety_sheet(fit::fit(model, m).machine).refusal();
  // From the 60th row on a tool that is 0.3 mm longer.
  for (Observation& o : m.observations)
    if (o.kind == ObservationKind::kZ && o.row >= 60) o.value += 0.3;
  const SafetySheet sheet = safety_sheet(fit::fit(model, m).machine);
  EXPECT_GT(*finding(sheet, SafetyRule::kDisturbed).value, 0.75);
  EXPECT_NE(sheet.refusal().find("moved before survey.csv:62"), std::string::npos) << sheet.refusal();
}

/// A machine with a term of its own along x or z and a thermometer, surveyed at the rows given.
Machine surveyed(const std::string& statics, const std::string& x, const std::string& z,
                 const std::vector<std::array<double, 4>>& rows,
                 const std::function<Eigen::Vector3d(const std::array<double, 4>&)>& error) {
  const Machine model = small_machine(statics, "<inputs><T unit=\"degC\" reference=\"20\"/></inputs>", x, z);
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal(0, 5e-4);
  std::string csv = "X[mm],Y[mm],Z[mm],T[degC],x[mm],y[mm],z[mm],u[mm]\n";
  for (const auto& row : rows) {
    const Eigen::Vector3d e = error(row);
    csv += std::to_string(row[0]) + "," + std::to_string(row[1]) + "," + std::to_string(row[2]) + "," +
           std::to_string(row[3]);
    for (Eigen::Index k = 0; k < 3; ++k)
      csv += "," + std::to_string(row[static_cast<std::size_t>(k)] + e[k] + normal(random));
    csv += ",0.0005\n";
  }
  return fit::fit(model, parse_measurement(csv, "survey.csv", model)).machine;
}

std::vector<std::array<double, 4>> everywhere(int count, double t) {
  std::mt19937_64 random(kSeed + 1);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<std::array<double, 4>> rows;
  for (int i = 0; i < count; ++i)
    rows.push_back({600 * place(random), 400 * place(random), -300 * place(random), t});
  return rows;
}

TEST(SafetySheet, RefusesHeatThatWasMeasuredAtOnePlaceAsARotation) {
  const std::string statics =
      "<k value=\"0\" nominal=\"0\" unit=\"1/K\"/><s value=\"0\" nominal=\"0\" unit=\"rad\"/>";
  // GIVEN a cold survey all over, and heat with X, Y and Z standing still
  std::vector<std::array<double, 4>> rows = everywhere(80, 20);
  for (int i = 0; i <= 20; ++i) rows.push_back({300, 200, -150, 20 + 0.5 * i});
  const auto growth = [](const std::array<double, 4>& row) {
    return Eigen::Vector3d(-2e-5 * row[1], 0, 0.004 * (row[3] - 20));
  };
  const SafetySheet sheet = safety_sheet(surveyed(statics, "X-s*Y", "Z+k*(T-20)*Y", rows, growth));
  EXPECT_FALSE(sheet.ok());
  EXPECT_FALSE(finding(sheet, SafetyRule::kUncertainty).ok)
      << *finding(sheet, SafetyRule::kUncertainty).value;
  EXPECT_EQ(finding(sheet, SafetyRule::kUncertainty).culprit, "the tool of the file, T at 30");
  // WHEN the heat is measured all over THEN the sheet passes
  std::vector<std::array<double, 4>> all = everywhere(80, 20);
  for (const auto& hot : everywhere(60, 30)) all.push_back(hot);
  const auto tilt = [](const std::array<double, 4>& row) {
    return Eigen::Vector3d(-2e-5 * row[1], 0, 2e-5 * (row[3] - 20) * row[1] / 10);
  };
  const SafetySheet good = safety_sheet(surveyed(statics, "X-s*Y", "Z+k*(T-20)*Y", all, tilt));
  EXPECT_TRUE(good.ok()) << good.refusal();
}

TEST(SafetySheet, RefusesAWaveThatTargetsDoNotShow) {
  const std::string statics =
      "<k1 value=\"0\" nominal=\"0\" unit=\"mm\"/><k2 value=\"0\" nominal=\"0\" unit=\"mm\"/>";
  // GIVEN a slow wave of 200 mm, which targets every 50 mm show as one of 40 mm too: the model has the short
  // one
  std::vector<std::array<double, 4>> rows;
  for (int pass = 0; pass < 4; ++pass)
    for (int i = 0; i <= 12; ++i) rows.push_back({50.0 * i, 130.0 * pass, -100.0 * pass, 20});
  const auto slow = [](const std::array<double, 4>& row) {
    return Eigen::Vector3d(0.006 * std::sin(2 * 3.14159265358979 * row[0] / 200), 0, 0);
  };
  const auto along = [&](const char* period) {
    return std::string("X+k1*sin(360*X/") + period + ")+k2*cos(360*X/" + period + ")";
  };
  EXPECT_FALSE(
      finding(safety_sheet(surveyed(statics, along("40"), "Z", rows, slow)), SafetyRule::kUncertainty).ok);
  const SafetySheet good = safety_sheet(surveyed(statics, along("200"), "Z", rows, slow));
  EXPECT_TRUE(finding(good, SafetyRule::kUncertainty).ok) << *finding(good, SafetyRule::kUncertainty).value;
}

TEST(SafetySheet, AFigureThatIsNotFiniteDecidesNothing) {
  SafetySheet sheet;
  EXPECT_THROW(sheet.judge(SafetyRule::kBound, std::nan(""), "axis X", {}), std::logic_error);
  EXPECT_THROW(sheet.judge(SafetyRule::kBound, std::numeric_limits<double>::infinity(), "axis X", {}),
               std::logic_error);
  sheet.judge(SafetyRule::kBound, 1.5e7, "axis X", {});
  EXPECT_FALSE(sheet.ok());
}

TEST(SafetySheet, RulesHaveTheirNamesAndNumbers) {
  // These numbers stand in images: they stay.
  const char* const kNames[] = {"correction",     "max-correction", "cancellation", "uncertainty",
                                "measured-range", "input-range",    "set-up",       "converged",
                                "residual",       "outlier",        "check-rows",   "disturbed",
                                "bound"};
  for (std::size_t i = 0; i < kSafetyRuleCount; ++i) {
    EXPECT_STREQ(rule_name(static_cast<SafetyRule>(i)), kNames[i]);
    EXPECT_EQ(rule_named(kNames[i]), static_cast<SafetyRule>(i));
  }
  EXPECT_THROW(rules_named({"nothing"}), InputError);
}

TEST(ErrorSources, SayWhatEachDoesAlone) {
  const Machine machine =
      small_machine("<alpha value=\"1e-4\" nominal=\"0\" unit=\"rad\"/><x0 value=\"0.01\" nominal=\"0\"/>",
                    "", "X-alpha*Y+x0");
  States states = make_states(2, 3, {});
  states.axis[1] << 0, 400;
  const std::vector<Source> sources = error_sources(machine, states);
  ASSERT_EQ(sources.size(), 2U);
  EXPECT_NEAR(sources[0].varying_rms_mm, 0.02, 1e-12);
  EXPECT_NEAR(sources[0].mean_mm.x(), -0.02, 1e-12);
  EXPECT_NEAR(sources[1].varying_rms_mm, 0, 1e-12);
  EXPECT_TRUE(acts(machine, {SymbolKind::kAxis, 1}));
  EXPECT_FALSE(acts(machine, {SymbolKind::kVelocity, 1}));
}

}  // namespace
}  // namespace vernier::safety_test
