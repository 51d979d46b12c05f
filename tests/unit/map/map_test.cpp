// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "tools/map/simulated.h"
#include "tools/model/machine_reader.h"
#include "tools/results/field_json.h"
#include "tools/text/files.h"

namespace vernier::map_test {

using namespace vernier::kinematics;
using namespace vernier::map;
using namespace vernier::model;
using namespace vernier::results;
using namespace vernier::text;
namespace {

constexpr double kX = 600, kY = 400, kZ = 300;  // travel, mm
/// Numbers are exact but for second order: deviation (0.06 mm) times angle (1e-4).
constexpr double kSecondOrder_um = 0.02;

struct Errors {
  double scale = 0, squareness = 0, lean = 0, reversal = 0;
};

/// Tool-side X, table-side Y, so that a wrong sign of a table axis cannot hide.
/// `more` stands behind the terms of X.
Machine machine(const Errors& e, const std::string& more = "") {
  Machine m = parse_machine(R"XML(<machine><variables><static>
    <k value="0" nominal="0"/><a value="0" nominal="0"/><b value="0" nominal="0"/><r value="0" nominal="0"/></static>
    <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes></variables>
    <transforms branch="workpiece"><sixdof n="1" Y="Y"/></transforms>
    <transforms branch="tool"><sixdof n="1" X="X*(1+k)+r*dirX)XML" +
                                more +
                                R"XML(" Y="-a*X"/><sixdof n="2" X="b*Z" Z="Z"/></transforms>
    </machine>)XML",
                            "m.xml");
  const double value[] = {e.scale, e.squareness, e.lean, e.reversal};
  for (std::size_t i = 0; i < 4; ++i) m.statics[i].value = value[i];
  return m;
}

States at() { return make_states(1, 3, {}); }

const LineResult& named(const std::vector<LineResult>& lines, const std::string& name) {
  for (const LineResult& line : lines)
    if (line.name == name) return line;
  throw std::runtime_error("no line " + name);
}

TEST(ErrorField, HasANodeForEveryCombinationFirstAxisFastest) {
  const Machine m = machine({.scale = 1e-4});
  const ErrorField field = error_field(m, at(), {0, 1, 2}, 3);
  ASSERT_EQ(field.nominal.cols(), 27);
  EXPECT_NEAR(field.nominal(0, 1), 300, 1e-12);
  EXPECT_NEAR(field.nominal(1, 3), -200, 1e-12);  // the table moves the other way
  EXPECT_NEAR(field.nominal(2, 9), -150, 1e-12);
  EXPECT_NEAR(field.deviation(0, 26), 0.06, 1e-12);
  EXPECT_NEAR(field.deviation.rightCols(2).row(1).norm(), 0, 1e-12);
  EXPECT_THROW(error_field(m, at(), {}, 3), InputError);
}

// A correction by the machine's own model leaves only what no axis moves; by another model, the difference.
TEST(ErrorField, CorrectionLeavesWhatTheModelsDoNotShare) {
  const Machine m = machine({.scale = 1e-4, .squareness = 2e-5, .lean = 3e-5});
  const ErrorField field = error_field(m, at(), {0, 1, 2}, 4);
  EXPECT_GT(field.deviation.colwise().norm().maxCoeff(), 0.05);
  EXPECT_LT(corrected_deviation(m, field, m).colwise().norm().maxCoeff(), 1e-6);
  // The correction knows 9e-5 of the scale: 1e-5 of 600 mm stay.
  const Eigen::Matrix3Xd left =
      corrected_deviation(m, field, machine({.scale = 9e-5, .squareness = 2e-5, .lean = 3e-5}));
  EXPECT_NEAR(left.row(0).maxCoeff(), 0.006, 1e-5);
  EXPECT_LT(left.bottomRows(2).cwiseAbs().maxCoeff(), 1e-5);
  // A table without Z cannot take out a height.
  Machine flat = parse_machine(R"XML(<machine><variables><static><h value="1e-5" nominal="0"/></static>
      <machineaxes><X min="0" max="600"/></machineaxes></variables>
      <transforms><sixdof n="1" X="X" Z="h*X"/></transforms></machine>)XML",
                               "flat.xml");
  const ErrorField line = error_field(flat, make_states(1, flat), {0}, 3);
  EXPECT_NEAR(corrected_deviation(flat, line, flat)(2, 2), 0.006, 1e-9);
  Machine other = machine({});
  other.axes[2].name = "W";
  EXPECT_THROW(corrected_deviation(m, field, other), InputError);
}

TEST(VolumeJson, IsTheFieldOverTheLinearAxes) {
  Errors errors;
  errors.scale = 1e-4;
  std::string why_not;
  const auto json = volume_json(machine(errors), 3, why_not);
  ASSERT_TRUE(json.has_value()) << why_not;
  EXPECT_EQ((*json)["axes"], (nlohmann::ordered_json{"X", "Y", "Z"}));
  EXPECT_EQ((*json)["point_mm"].size(), 27U);
  // 1e-4 of 0, 300 and 600 mm: 0, 30 and 60 um.
  EXPECT_NEAR((*json)["max_um"].get<double>(), 60, 1e-9);
  EXPECT_NEAR((*json)["rms_um"].get<double>(), std::sqrt((30 * 30 + 60 * 60) / 3.0), 1e-9);
  EXPECT_NEAR((*json)["deviation_um"][2][0].get<double>(), 60, 1e-9);
}

TEST(VolumeJson, SaysWhyThereIsNone) {
  Machine open = machine({});
  open.axes[0].max.reset();
  std::string why_not;
  EXPECT_FALSE(volume_json(open, 3, why_not).has_value());
  EXPECT_NE(why_not.find("this axis has no min and max"), std::string::npos);
}

TEST(Measured, ScaleErrorOnAxesAndDiagonals) {
  const Machine m = machine({.scale = 1e-4});
  const Bench bench(m, at());
  const auto lines = axis_lines(m, bench), crossing = diagonals(m, bench);
  EXPECT_NEAR(named(lines, "X").error_um, 60, kSecondOrder_um);
  EXPECT_NEAR(named(lines, "Y").error_um, 0, kSecondOrder_um);
  ASSERT_EQ(crossing.size(), 10u);
  const double body = std::sqrt(kX * kX + kY * kY + kZ * kZ), face = std::hypot(kX, kY);
  EXPECT_NEAR(named(crossing, "+X+Y+Z").error_um, 0.1 * kX * kX / body, kSecondOrder_um);
  EXPECT_NEAR(named(crossing, "+X-Y").error_um, 0.1 * kX * kX / face, kSecondOrder_um);
  EXPECT_NEAR(named(crossing, "+Y+Z").error_um, 0, kSecondOrder_um);
  for (const LineResult& line : crossing) EXPECT_NEAR(line.reversal_um, 0, 1e-9);
  EXPECT_NEAR(circles_json(bench)[0]["circular_deviation_ccw_um"].get<double>(), 0.1 * 180, 0.05);
}

TEST(Measured, SquarenessInDiagonalsAndSquares) {
  const Machine m = machine({.squareness = 5e-5});
  const Bench bench(m, at());
  const auto crossing = diagonals(m, bench);
  // The X motion turns to -Y; a table Y turns the plane over: the tool goes +Y when the table goes -Y.
  const double expected = 0.05 * kX * kY / std::hypot(kX, kY);
  EXPECT_NEAR(named(crossing, "+X+Y").forward_um.back(), expected, kSecondOrder_um);
  EXPECT_NEAR(named(crossing, "+X-Y").forward_um.back(), -expected, kSecondOrder_um);
  const auto squares = squares_json(bench);
  EXPECT_NEAR(squares[0]["angle_um_per_m"].get<double>(), 50, 0.01);
  EXPECT_NEAR(squares[1]["angle_um_per_m"].get<double>(), 0, 0.01);
  // An ellipse at 45 deg: radii differ by the angle times the radius.
  EXPECT_NEAR(circles_json(bench)[0]["circular_deviation_cw_um"].get<double>(), 0.05 * 180, 0.02);
}

TEST(Measured, ReversalSeparatesTheSenses) {
  const Machine m = machine({.reversal = 0.003});
  const Bench bench(m, at());
  EXPECT_NEAR(named(axis_lines(m, bench), "X").reversal_um, 6, 1e-9);
  EXPECT_NEAR(named(axis_lines(m, bench), "Z").reversal_um, 0, 1e-9);
  const auto circles = circles_json(bench);
  ASSERT_EQ(circles.size(), 3u);
  EXPECT_NEAR(circles[0]["hysteresis_um"].get<double>(), 6, 0.1);  // at 90 deg of its reversal, one step wide
  EXPECT_NEAR(circles[1]["hysteresis_um"].get<double>(), 0, 0.01);
}

TEST(Measured, LeaningCylinderIsRoundAndTilted) {
  const Machine m = machine({.lean = 4e-5});
  const auto cylinder = cylinder_json(Bench(m, at()));
  EXPECT_NEAR(cylinder["axis_tilt_um_per_m"][0].get<double>(), 40, 0.01);
  EXPECT_NEAR(cylinder["axis_tilt_um_per_m"][1].get<double>(), 0, 0.01);
  EXPECT_NEAR(cylinder["cylindricity_um"].get<double>(), 0, 0.01);
}

TEST(Measured, FreeLinesStayInTheVolume) {
  const Machine m = machine({.scale = 1e-4});
  const Bench bench(m, at());
  const std::string path = testing::TempDir() + "free_lines.csv";
  write_file(path, "x[mm],y[mm],z[m],run\n100,-100,-0.05,a\n300,-100,-0.05,a\n10,-10,0,b\n10,-390,0,b\n");
  const auto lines = free_lines_json(bench, path);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NEAR(lines[0]["length_deviation_um"].get<double>(), 20, kSecondOrder_um);
  EXPECT_NEAR(lines[1]["length_deviation_um"].get<double>(), 0, kSecondOrder_um);
  write_file(path, "x[mm],y[mm],z[mm]\n100,100,0\n300,100,0\n");  // y is -400..0
  EXPECT_THROW(free_lines_json(bench, path), InputError);
  write_file(path, "x[mm],y[mm],z[mm]\n100,-100,0\n");
  EXPECT_THROW(free_lines_json(bench, path), InputError);
}

TEST(Measured, ATermThatIsNotAffineTakesNoResultAway) {
  const Machine plain = machine({.scale = 1e-4, .reversal = 2e-3});
  const Machine coupled = machine({.scale = 1e-4, .reversal = 2e-3}, "+0*Y*Z");
  ASSERT_FALSE(closed_solution(nominal_machine(coupled), at()));
  const Bench exact(plain, at()), iterated(coupled, at());
  const auto lengths = axis_lines(plain, exact), same = axis_lines(coupled, iterated);
  ASSERT_EQ(lengths.size(), same.size());
  const auto wanted = diagonals(plain, exact), got = diagonals(coupled, iterated);
  ASSERT_EQ(wanted.size(), 10u);
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(got[i].name, wanted[i].name);
    EXPECT_NEAR(got[i].error_um, wanted[i].error_um, 1e-3);
    EXPECT_NEAR(got[i].reversal_um, wanted[i].reversal_um, 1e-3);
  }
  EXPECT_EQ(circles_json(iterated).size(), circles_json(exact).size());
}

TEST(Measured, LinesThatTheChainCannotFollowAreLeftOut) {
  const Machine bending = parse_machine(
      R"XML(<machine><variables><machineaxes><X min="0" max="100"/></machineaxes></variables>
      <transforms><sixdof n="1" rZ="X"/><sixdof n="2" X="X+100"/></transforms></machine>)XML",
      "bending.xml");
  const Bench bench(bending, make_states(1, 1, {}));
  EXPECT_TRUE(axis_lines(bending, bench).empty());
}

TEST(Measured, AxesWithoutRangesAreRefused) {
  Machine endless = machine({});
  endless.axes[1].max.reset();
  EXPECT_THROW(Bench(endless, at()), InputError);
}

}  // namespace
}  // namespace vernier::map_test
