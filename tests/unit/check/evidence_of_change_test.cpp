// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/check/evidence_of_change.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

#include "tools/check/history.h"
#include "tools/fit/fit.h"
#include "tools/model/chain/chain.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"

namespace vernier::check_test {

using namespace vernier::check;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr double kNoise_mm = 0.001, kFalseAlarms = 0.05;

const char* const kBridge = R"XML(<machine name="bridge"><variables><static>
    <sxy value="0" nominal="0" unit="rad"/><szx value="0" nominal="0" unit="rad"/><kx value="0" nominal="0"/>
    <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/></static>
    <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" X="X+kx*X"/><sixdof n="2" Y="Y" X="sxy*Y"/><sixdof n="3" Z="Z" X="szx*Z"/>
    </transforms></machine>)XML";

Machine true_machine(const std::function<void(Machine&)>& change) {
  Machine truth = parse_machine(kBridge, "m.xml");
  truth.statics[*truth.find_static("sxy")].value = 20e-6;
  truth.statics[*truth.find_static("szx")].value = -15e-6;
  truth.statics[*truth.find_static("kx")].value = 10e-6;
  change(truth);
  return truth;
}

/// Points of a machine with the values given, in a set-up of their own, with noise; `wander_mm`: of the
/// instrument in each direction, of which nine tenths are kept from row to row.
std::string rows(int count, const std::function<void(Machine&)>& change, std::mt19937_64& random,
                 double noise_mm, double drift_mm = 0, double wander_mm = 0) {
  const Machine truth = true_machine(change);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal(0, 1);
  States states = make_states(static_cast<std::size_t>(count), 3, {});
  for (Eigen::Index i = 0; i < count; ++i) {
    states.axis[0][i] = std::round(600 * share(random));
    states.axis[1][i] = std::round(400 * share(random));
    states.axis[2][i] = std::round(-300 * share(random));
  }
  const Eigen::Vector3d shift(normal(random), normal(random), normal(random));
  Eigen::Matrix3Xd points = forward(truth, states).position.colwise() + shift;
  constexpr double kKept = 0.9;
  const auto drawn = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  Eigen::Vector3d away = wander_mm > 0 ? Eigen::Vector3d(wander_mm * drawn()) : Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; wander_mm > 0 && i < count; ++i) {
    points.col(i) += away;
    away = kKept * away + std::sqrt(1 - kKept * kKept) * wander_mm * drawn();
  }
  std::string text = "X[mm],Y[mm],Z[mm],dirX,x[mm],y[mm],z[mm],u[mm]\n";
  for (Eigen::Index i = 0; i < count; ++i) {
    const int sense = i % 2 == 0 ? 1 : -1;
    text += fmt::format(
        "{},{},{},{},{:.6f},{:.6f},{:.6f},{}\n", states.axis[0][i], states.axis[1][i], states.axis[2][i],
        sense, points(0, i) + noise_mm * normal(random) + drift_mm * static_cast<double>(i) / count,
        points(1, i) + noise_mm * normal(random), points(2, i) + noise_mm * normal(random), kNoise_mm);
  }
  return text;
}

void nothing(Machine& /*machine*/) {}

/// Where one check measures: points along a line, or anywhere; in one approach direction or in both; the
/// instrument turned by an angle about a random direction.
struct Visit {
  enum class Where : std::uint8_t { kLineX, kLineY, kLineZ, kVolume } where = Where::kVolume;
  bool both_directions = true;
  double turned_deg = 0;
  int points = 10;
};

std::string rows_of(const Visit& visit, const std::function<void(Machine&)>& change,
                    std::mt19937_64& random) {
  const Machine truth = true_machine(change);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal(0, 1);
  States states = make_states(static_cast<std::size_t>(visit.points), 3, {});
  const double from[3] = {0, 0, -300}, length[3] = {600, 400, 300};
  const double still[3] = {share(random), share(random), share(random)};
  for (int i = 0; i < visit.points; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool along =
          visit.where == Visit::Where::kVolume || static_cast<std::size_t>(visit.where) == axis;
      const double at = visit.where == Visit::Where::kVolume ? share(random)
                        : along                              ? static_cast<double>(i) / (visit.points - 1)
                                                             : still[axis];
      states.axis[axis][i] = std::round(from[axis] + length[axis] * at);
    }
  const Eigen::Vector3d about = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(visit.turned_deg / 57.29577951308232, about).matrix();
  const Eigen::Vector3d shift(100 * normal(random), 100 * normal(random), 100 * normal(random));
  const Eigen::Matrix3Xd points = (turn * forward(truth, states).position).colwise() + shift;
  std::string text = "X[mm],Y[mm],Z[mm],dirX,dirY,dirZ,x[mm],y[mm],z[mm],u[mm]\n";
  for (Eigen::Index i = 0; i < visit.points; ++i) {
    const int sense = visit.both_directions && i % 2 != 0 ? -1 : 1;
    text += fmt::format("{},{},{},{},{},{},{:.6f},{:.6f},{:.6f},{}\n", states.axis[0][i], states.axis[1][i],
                        states.axis[2][i], sense, sense, sense, points(0, i) + kNoise_mm * normal(random),
                        points(1, i) + kNoise_mm * normal(random), points(2, i) + kNoise_mm * normal(random),
                        kNoise_mm);
  }
  return text;
}

Machine fitted(std::mt19937_64& random, int count = 40, double wander_mm = 0) {
  const Machine machine = parse_machine(kBridge, "m.xml");
  const FitResult result = fit::fit(
      machine, parse_measurement(rows(count, nothing, random, kNoise_mm, 0, wander_mm), "s.csv", machine));
  return result.machine;
}

CheckRecord check(const Machine& machine, const std::string& text) {
  return record_of(machine, parse_measurement(text, "c.csv", machine), "a check");
}

TEST(Checks, AQuietMachineRaisesFewerAlarmsThanStated) {
  // 200 machines, each fitted from its own survey and looked at after each of 15 checks.
  std::mt19937_64 random(41);
  constexpr int kMachines = 200, kChecks = 15;
  int alarms = 0;
  for (int k = 0; k < kMachines; ++k) {
    const Machine machine = fitted(random);
    std::vector<CheckRecord> history;
    bool alarm = false;
    for (int week = 0; week < kChecks && !alarm; ++week) {
      history.push_back(check(machine, rows(8, nothing, random, kNoise_mm)));
      alarm = judge(machine, history, kFalseAlarms).verdict != CheckVerdict::kValid;
    }
    alarms += alarm ? 1 : 0;
  }
  // 5 %, of change and of scatter together: 10 expected at most, four standard deviations above.
  EXPECT_LE(alarms, 10 + 12);
}

TEST(Checks, AQuietMachineUnderAnInstrumentThatWandersRaisesFewerAlarmsThanStated) {
  // GIVEN a survey whose readings hang together, and checks by the same instrument
  std::mt19937_64 random(46);
  constexpr int kMachines = 100, kChecks = 15;
  constexpr double kWander_mm = 2 * kNoise_mm;
  int alarms = 0, as_if_independent = 0;
  for (int k = 0; k < kMachines; ++k) {
    const Machine machine = fitted(random, 80, kWander_mm);
    ASSERT_TRUE(machine.fitted->noise.has_value());
    // The file keeps it.
    const Machine read = parse_machine(update_machine_text(kBridge, machine, false), "m.xml");
    EXPECT_DOUBLE_EQ(read.fitted->noise->drift, machine.fitted->noise->drift);
    Machine forgot = machine;
    auto record = std::make_shared<FitRecord>(*machine.fitted);
    record->noise.reset();
    forgot.fitted = record;
    std::vector<CheckRecord> history, plain;
    bool alarm = false, plain_alarm = false;
    for (int week = 0; week < kChecks; ++week) {
      const std::string text = rows(10, nothing, random, kNoise_mm, 0, kWander_mm);
      history.push_back(check(machine, text));
      plain.push_back(check(forgot, text));
      alarm = alarm || judge(machine, history, kFalseAlarms).verdict != CheckVerdict::kValid;
      plain_alarm = plain_alarm || judge(forgot, plain, kFalseAlarms).verdict != CheckVerdict::kValid;
    }
    alarms += alarm ? 1 : 0;
    as_if_independent += plain_alarm ? 1 : 0;
  }
  std::printf("%d of %d machines alarmed, %d if readings counted as independent\n", alarms, kMachines,
              as_if_independent);
  EXPECT_LE(alarms, 5 + 9);
  EXPECT_GT(as_if_independent, 50) << "what the noise is for";
}

TEST(Checks, AChangeIsNamedWithItsSize) {
  std::mt19937_64 random(42);
  int named = 0;
  constexpr int kMachines = 40;
  for (int k = 0; k < kMachines; ++k) {
    const Machine machine = fitted(random);
    std::vector<CheckRecord> history;
    for (int week = 0; week < 3; ++week)
      history.push_back(check(machine, rows(8, nothing, random, kNoise_mm)));
    const auto crash = [](Machine& m) { m.statics[*m.find_static("sxy")].value += 40e-6; };
    history.push_back(check(machine, rows(8, crash, random, kNoise_mm)));
    const CheckAnswer answer = judge(machine, history, kFalseAlarms);
    if (answer.verdict != CheckVerdict::kChanged) continue;
    if (answer.changed.front().quantity.name != "sxy") continue;
    ++named;
    EXPECT_NEAR(answer.changed.front().change, 40e-6, 5 * answer.changed.front().std);
    EXPECT_EQ(answer.changed.front().since, 3U);
  }
  EXPECT_GE(named, 38);
}

/// The scale of X by so much over its travel.
std::function<void(Machine&)> longer_x(double mm) {
  return [mm](Machine& m) { m.statics[*m.find_static("kx")].value += mm / 600; };
}

TEST(Checks, AChangeIsReportedAlthoughEarlierChecksDidNotLookThere) {
  // GIVEN histories whose last check depends on an error that no check before it depended on
  using Where = Visit::Where;
  const std::vector<std::vector<Visit>> histories = {
      {{Where::kLineY}, {Where::kLineX}},
      {{Where::kLineY}, {Where::kLineZ}, {Where::kVolume}},
      {{Where::kLineX, false}, {Where::kLineX, true}},
      {{Where::kVolume, false}, {Where::kVolume, true}},
  };
  std::mt19937_64 random(47);
  for (const auto& visits : histories)
    for (int k = 0; k < 10; ++k) {
      const Machine machine = fitted(random);
      std::vector<CheckRecord> history;
      for (std::size_t i = 0; i + 1 < visits.size(); ++i)
        history.push_back(check(machine, rows_of(visits[i], nothing, random)));
      EXPECT_TRUE(std::isfinite(judge(machine, history, kFalseAlarms).evidence));
      // WHEN the scale of X has changed by 20 um over its travel
      history.push_back(check(machine, rows_of(visits.back(), longer_x(0.02), random)));
      const CheckAnswer answer = judge(machine, history, kFalseAlarms);
      // THEN the check says so
      EXPECT_TRUE(std::isfinite(answer.evidence));
      EXPECT_EQ(answer.verdict, CheckVerdict::kChanged) << answer.explanation;
      EXPECT_FALSE(answer.assurance.holds());
    }
}

TEST(Checks, AQuietMachineUnderATurnedInstrumentAndNewPosesRaisesFewerAlarmsThanStated) {
  using Where = Visit::Where;
  std::mt19937_64 random(48);
  std::uniform_real_distribution<double> angle(0, 180);
  std::uniform_int_distribution<int> where(0, 3), coin(0, 1);
  constexpr int kHistories = 60, kWeeks = 8;
  int alarms = 0, shown_10 = 0, shown_20 = 0;
  for (int k = 0; k < kHistories; ++k) {
    const Machine machine = fitted(random);
    std::vector<CheckRecord> history;
    bool alarm = false;
    for (int week = 0; week < kWeeks; ++week) {
      const Visit visit{static_cast<Where>(where(random)), coin(random) == 1, angle(random)};
      history.push_back(check(machine, rows_of(visit, nothing, random)));
      const CheckAnswer answer = judge(machine, history, kFalseAlarms);
      ASSERT_TRUE(std::isfinite(answer.evidence));
      alarm =
          alarm || answer.verdict == CheckVerdict::kChanged || answer.verdict == CheckVerdict::kInstrument;
    }
    alarms += alarm ? 1 : 0;
    for (const double change_mm : {0.01, 0.02}) {
      std::vector<CheckRecord> changed = history;
      changed.push_back(
          check(machine, rows_of({Where::kVolume, true, angle(random)}, longer_x(change_mm), random)));
      if (judge(machine, changed, kFalseAlarms).verdict == CheckVerdict::kChanged)
        ++(change_mm < 0.015 ? shown_10 : shown_20);
    }
  }
  std::printf("%d alarms in %d quiet histories; of as many changes reported: 10 um %d, 20 um %d\n", alarms,
              kHistories, shown_10, shown_20);
  // 5 %: 3 expected at most, four standard deviations above.
  EXPECT_LE(alarms, 3 + 7);
  // A scale known to 1 um / sqrt(10) / 0.3 of its travel shows by three to six times that.
  EXPECT_GE(shown_20, kHistories - 1);
  EXPECT_GE(shown_10, kHistories * 2 / 3);
}

TEST(Checks, AnInstrumentTurnedByHalfADegreeOrAnyAngleIsNoChange) {
  std::mt19937_64 random(49);
  const Machine machine = fitted(random);
  for (const double turned_deg : {0.0, 0.4, 1.0, 10.0, 90.0, 135.0, 179.0, 180.0}) {
    const CheckAnswer answer = judge(
        machine, {check(machine, rows_of({Visit::Where::kVolume, true, turned_deg}, nothing, random))}, 0.01);
    EXPECT_EQ(answer.verdict, CheckVerdict::kValid) << turned_deg << " deg: " << answer.explanation;
    EXPECT_TRUE(answer.assurance.holds());
  }
}

TEST(Checks, TheChanceOfTheScatterIsEvenWhateverTheSetUpTakes) {
  // Along a line the set-up takes up nearly all that the parameters do: none of them is a degree of freedom.
  std::mt19937_64 random(51);
  constexpr int kChecks = 200;
  int below = 0;
  for (int k = 0; k < kChecks; ++k) {
    const Machine machine = fitted(random);
    const Visit visit{static_cast<Visit::Where>(k % 3), true, 20.0 * (k % 9), 6};
    below += judge(machine, {check(machine, rows_of(visit, nothing, random))}, 0.01).noise_p < 0.1 ? 1 : 0;
  }
  EXPECT_NEAR(below, 0.1 * kChecks, 4 * std::sqrt(0.1 * 0.9 * kChecks));
}

TEST(Checks, ACheckWithLoudReadingsIsLeftOutOfTheEvidence) {
  std::mt19937_64 random(50);
  const Machine machine = fitted(random);
  std::vector<CheckRecord> history = {check(machine, rows(12, nothing, random, 30 * kNoise_mm))};
  EXPECT_EQ(judge(machine, history, 0.01).verdict, CheckVerdict::kInstrument);
  history.push_back(check(machine, rows(12, nothing, random, kNoise_mm)));
  const CheckAnswer answer = judge(machine, history, 0.01);
  EXPECT_EQ(answer.verdict, CheckVerdict::kValid) << answer.explanation;
  EXPECT_FALSE(answer.assurance.uncovered().empty());
}

TEST(Checks, TheInstrumentIsTold) {
  std::mt19937_64 random(43);
  const Machine machine = fitted(random);
  EXPECT_EQ(judge(machine, {check(machine, rows(12, nothing, random, 5 * kNoise_mm))}, kFalseAlarms).verdict,
            CheckVerdict::kInstrument);
  EXPECT_EQ(
      judge(machine, {check(machine, rows(12, nothing, random, kNoise_mm, 0.03))}, kFalseAlarms).verdict,
      CheckVerdict::kInstrument);
}

/// The bridge with six errors of each axis at stations: far more parameters than a check has readings.
std::string bridge_with_tables() {
  std::string text = kBridge;
  const auto table = [](const char* axis, int from, int to, int step) {
    std::string rows = fmt::format("<table axis=\"{}\" fit=\"X Y Z rX rY rZ\">", axis);
    for (int at = from; at <= to; at += step)
      rows += fmt::format("<station loc=\"{}\" X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/>", at);
    return rows + "</table>";
  };
  const auto before = [&](const std::string& mark, const std::string& what) {
    text.insert(text.find(mark), what);
  };
  before("</variables>", "<comptables>" + table("X", 0, 600, 100) + table("Y", 0, 400, 100) +
                             table("Z", -300, 0, 50) + "</comptables>");
  before("</transforms>", "<sixdof n=\"4\" Z=\"-100\"/>");
  const auto replace = [&](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  const auto angles = [](char axis) { return fmt::format(" rX=\"r{0}x\" rY=\"r{0}y\" rZ=\"r{0}z\"", axis); };
  replace("X=\"X+kx*X\"", "X=\"X+kx*X+lXx\" Y=\"lXy\" Z=\"lXz\"" + angles('X'));
  replace("Y=\"Y\" X=\"sxy*Y\"", "Y=\"Y+lYy\" X=\"sxy*Y+lYx\" Z=\"lYz\"" + angles('Y'));
  replace("Z=\"Z\" X=\"szx*Z\"", "Z=\"Z+lZz\" X=\"szx*Z+lZx\" Y=\"lZy\"" + angles('Z'));
  return text;
}

/// The verdict of a check against the machine with tables, with noise of so many times its u.
CheckAnswer check_of_tables(const Machine& machine, double times, const std::function<void(Machine&)>& change,
                            std::mt19937_64& random) {
  return judge(machine, {check(machine, rows(10, change, random, times * kNoise_mm))}, kFalseAlarms);
}

TEST(Checks, LoudReadingsOfAMachineOfManyParametersNameNoChange) {
  // GIVEN a machine of 123 parameters, whose checks leave no degree of freedom beside all of them
  std::mt19937_64 random(52);
  const Machine machine = parse_machine(bridge_with_tables(), "m.xml");
  const Machine fit_machine =
      fit::fit(machine, parse_measurement(rows(100, nothing, random, kNoise_mm), "s.csv", machine)).machine;
  int changed = 0, instrument = 0, quiet_alarms = 0, right = 0;
  constexpr int kChecks = 20;
  const auto crash = [](Machine& m) { m.statics[*m.find_static("sxy")].value += 60e-6; };
  for (int k = 0; k < kChecks; ++k) {
    // WHEN the readings scatter by three times their u
    const CheckAnswer loud = check_of_tables(fit_machine, 3, nothing, random);
    changed += loud.verdict == CheckVerdict::kChanged ? 1 : 0;
    instrument += loud.verdict == CheckVerdict::kInstrument ? 1 : 0;
    quiet_alarms += check_of_tables(fit_machine, 1, nothing, random).verdict != CheckVerdict::kValid ? 1 : 0;
    const CheckAnswer moved = check_of_tables(fit_machine, 1, crash, random);
    for (const Change& one : moved.changed) {
      right += one.quantity.name == "sxy" ? 1 : 0;
      EXPECT_LT(std::abs(one.change), one.quantity.unit == "deg" ? 1 : 0.2) << one.quantity.name;
    }
    for (const Change& one : moved.resolved)
      EXPECT_LT(one.std, one.quantity.unit == "deg" ? 10 : 1) << one.quantity.name;
  }
  std::printf("loud: %d changed, %d instrument; quiet: %d alarms; sxy named in %d of %d\n", changed,
              instrument, quiet_alarms, right, kChecks);
  // THEN the noise is reported, no change of the machine; a change of a machine at rest is still named
  EXPECT_LE(changed, 1);
  EXPECT_GE(instrument, kChecks - 2);
  EXPECT_LE(quiet_alarms, 1);
  EXPECT_GE(right, kChecks * 3 / 4);
}

TEST(Checks, TooLittleIsSaid) {
  std::mt19937_64 random(44);
  const Machine machine = fitted(random);
  EXPECT_EQ(judge(machine, {check(machine, rows(2, nothing, random, kNoise_mm))}, kFalseAlarms).verdict,
            CheckVerdict::kTooLittle);
  EXPECT_THROW(check(parse_machine(kBridge, "m.xml"), rows(8, nothing, random, kNoise_mm)), InputError);
}

TEST(Checks, AHistoryReadsBackAsItWasWritten) {
  std::mt19937_64 random(45);
  const Machine machine = fitted(random);
  CheckHistory history{identity_of(machine), {}};
  for (int week = 0; week < 3; ++week)
    history.checks.push_back(check(machine, rows(8, nothing, random, kNoise_mm)));
  const CheckHistory again = parse_history(history_text(history), "h.json");
  EXPECT_EQ(history_text(again), history_text(history));
  EXPECT_DOUBLE_EQ(judge(machine, again.checks, 0.01).evidence,
                   judge(machine, history.checks, 0.01).evidence);
  EXPECT_THROW(parse_history("{\"format\":\"other\"}", "h.json"), InputError);
  EXPECT_THROW(parse_history("[[[", "h.json"), InputError);
}

}  // namespace
}  // namespace vernier::check_test
