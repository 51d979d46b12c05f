// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/machine_log.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "tools/model/machine_reader.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::machine_log_test {

using namespace vernier::importer;
using namespace vernier::model;
using namespace vernier::text;
namespace {

const char* const kMachine =
    "<machine name=\"xyz\"><variables><machineaxes><X min=\"0\" max=\"900\"/><Y min=\"0\" max=\"900\"/>"
    "<Z min=\"0\" max=\"900\"/></machineaxes></variables><transforms>"
    "<sixdof n=\"1\" X=\"X\" Y=\"Y\" Z=\"Z\" rX=\"0\" rY=\"0\" rZ=\"0\"/></transforms></machine>";

struct Survey {
  std::string log = "t[s],X[mm],Y[mm],Z[mm],T_air[degC],tool\n";
  ImportTable tracker{"tracker.txt", {{"x", "mm", {}}, {"y", "mm", {}}, {"z", "mm", {}}, {"t", "s", {}}}, {}};
  std::vector<int> dwell;  // true one of each point; -1: none
};

/// A machine that goes to `stops` places and stands at each for 2 to 4 s, logged at 5 Hz; a tracker in its
/// own frame whose clock is 1234.5 s behind and loses 2e-4; some dwells without a point, some points without
/// a dwell.
Survey survey(int stops, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal(0, 0.1);
  const Eigen::AngleAxisd turned(0.8, Eigen::Vector3d(1, -2, 0.5).normalized());
  Survey survey;
  double t = 100;
  Eigen::Vector3d at(0, 0, 0);
  const auto row = [&](const Eigen::Vector3d& q) {
    survey.log += number_text(t) + "," + number_text(q[0]) + "," + number_text(q[1]) + "," +
                  number_text(q[2]) + ",20.5,T1\n";
    t += 0.2;
  };
  const auto point = [&](const Eigen::Vector3d& p, double when, int dwell) {
    const Eigen::Vector3d seen = turned * p + Eigen::Vector3d(5000, 100, -300);
    const double clock = (when - 1234.5) / (1 + 2e-4);
    const double values[] = {seen[0] + normal(random), seen[1] + normal(random), seen[2] + normal(random),
                             clock};
    for (std::size_t k = 0; k < 4; ++k) survey.tracker.columns[k].cells.push_back(number_text(values[k]));
    survey.tracker.line.push_back(survey.tracker.line.size() + 2);
    survey.dwell.push_back(dwell);
  };
  for (int stop = 0; stop < stops; ++stop) {
    const Eigen::Vector3d to(900 * unit(random), 900 * unit(random), 900 * unit(random)), from = at;
    for (int i = 1; i < 10; ++i) row(from + (to - from) * i / 10.0);
    at = to;
    const double begin = t;
    const int rows = 11 + static_cast<int>(10 * unit(random));
    for (int i = 0; i < rows; ++i) row(at);
    if (stop % 9 == 4) continue;  // the beam was broken
    point(at, begin + 0.3 + (t - begin - 0.6) * unit(random), stop);
    if (stop % 13 == 6) point(Eigen::Vector3d(900 * unit(random), 900 * unit(random), 1500), t + 0.6, -1);
  }
  return survey;
}

void expect_right(const Survey& made, const LoggedTable& read) {
  for (std::size_t i = 0; i < made.dwell.size(); ++i) {
    const auto& found = read.pairing.dwell[i];
    EXPECT_EQ(found ? static_cast<int>(*found) : -1, made.dwell[i]) << "point " << i;
  }
}

TEST(MachineLog, PointsFindTheirDwellsByOrderWaysAndTime) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  const Survey made = survey(60, 19);
  const LoggedTable read = with_log(made.tracker, made.log, "log.csv", machine, {});
  expect_right(made, read);
  // The clock within four of the uncertainties that it states. A point lies anywhere in some 2 s, 0.5 s rms,
  // of 50 over 300 s, 80 s rms: 0.5 / (80 sqrt(50)) = 0.9e-3, and as much again for the draw.
  EXPECT_NEAR(*read.pairing.offset_s, 1234.5, 4 * *read.pairing.offset_std_s);
  EXPECT_NEAR(*read.pairing.drift, 2e-4, 4 * *read.pairing.drift_std);
  EXPECT_LT(*read.pairing.drift_std, 2e-3);
  EXPECT_NEAR(*read.pairing.rms_mm, 0.1 * std::sqrt(3.0), 0.04);
  EXPECT_EQ(read.unmatched_line.size(),
            static_cast<std::size_t>(std::count(made.dwell.begin(), made.dwell.end(), -1)));
  EXPECT_EQ(read.pairing.unused.size(), 7u);
  EXPECT_EQ(read.table.find("tool")->cells.front(), "T1");
  EXPECT_EQ(read.table.find("T_air")->cells.front(), "20.5");
  EXPECT_NE(read.table.find("X"), nullptr);
}

TEST(MachineLog, WithoutTheTrackersClockWaysAloneTell) {
  Survey made = survey(60, 23);
  made.tracker.remove("t");
  const LoggedTable read = with_log(made.tracker, made.log, "log.csv", parse_machine(kMachine, "m.xml"), {});
  expect_right(made, read);
  EXPECT_FALSE(read.pairing.offset_s.has_value());
}

TEST(MachineLog, TimesAloneTellWhereStandsAreUnknown) {
  // GIVEN dwells of uneven spacing and points in all but one of them
  PairingInput input;
  const double begin[] = {0, 5, 12, 14, 30, 37, 39, 55};
  std::vector<double> clock;
  for (std::size_t j = 0; j < 8; ++j) {
    input.dwells.push_back({10 * j, 10 * j + 5, begin[j], begin[j] + 1});
    if (j != 3) clock.push_back(begin[j] + 0.5 + 1000);
  }
  input.time = Eigen::Map<Eigen::VectorXd>(clock.data(), 7);
  input.point.resize(3, 7);
  input.point.setZero();
  const Pairing pairing = pair_points(input);
  EXPECT_EQ(pairing.unused, std::vector<std::size_t>{3});
  EXPECT_NEAR(*pairing.offset_s, -1000, 1e-6);
  input.time = std::nullopt;
  EXPECT_THROW(pair_points(input), InputError);
}

TEST(MachineLog, BadLogsAreRefusedWithLineAndWord) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  const Survey made = survey(5, 29);
  const auto error = [&](const std::string& log) {
    try {
      with_log(made.tracker, log, "log.csv", machine, {});
    } catch (const InputError& found) {
      return std::string(found.what());
    }
    return std::string("none");
  };
  EXPECT_NE(error("t[s],X[mm],Y[mm]\n0,0,0\n").find("log.csv:1: \"Z\""), std::string::npos);
  EXPECT_NE(error("t[s],X[mm],Y[mm],Z[mm]\n0,0,0,0\n1,0,a,0\n").find("log.csv:3: \"a\""), std::string::npos);
  EXPECT_NE(error("t[s],X[mm],Y[mm],Z[mm]\n1,0,0,0\n0,0,0,0\n").find("log.csv:3"), std::string::npos);
  EXPECT_NE(error("t[s],X[mm],Y[mm],Z[mm]\n0,0,0,0\n1,9,0,0\n").find("no dwell of this length"),
            std::string::npos);
}

}  // namespace
}  // namespace vernier::machine_log_test
