// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/survey.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

#include "tools/model/chain/chain_rows.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"

namespace vernier::survey_test {

using namespace vernier::importer;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr double kDeg = 180 / std::numbers::pi;

ColumnMap map_of(const std::string& text) {
  ColumnMap map;
  read_column_map(map, text, "map.txt");
  return map;
}

const char* const kMachine = R"XML(<machine><variables><machineaxes><X/><Y/></machineaxes>
  <inputs><T unit="degC" reference="20"/></inputs></variables>
  <transforms branch="tool"><sixdof n="1" X="X" Y="Y"/></transforms></machine>)XML";

std::string message_of(const std::string& map, const std::string& text) {
  try {
    ImportTable table = mapped_table(text, "data.txt", map_of(map));
    finish_tracker(table);
    measurement_csv(table);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Tracker, AMapsUnknownSeparatorIsNamedWithItsPlace) {
  EXPECT_EQ(message_of("# a map\nseparator = colon\n", "1,2\n").find("map.txt:2: \"colon\": "), 0u);
}

TEST(Tracker, ReadsEveryWayOfWritingATable) {
  const std::string map =
      "column 1 = X[mm]\ncolumn 2=Y[mm]\ncolumn 3 = x[m]\n# a comment\n\ncolumn 4 = y[mm]\ncolumn 5 = "
      "T[degC]\n"
      "set run = s 1\nset u[um] = 5\n";
  const struct {
    const char *statements, *text;
  } ways[] = {
      {"", "1,2.5,0.25,-3,21\n4,5,0.5,6e-1,22\n"},
      {"separator = semicolon\ndecimal = comma\n", "1;2,5;0,25;-3;21\r\n4;5;0,5;6e-1;22\r\n"},
      {"separator = tab\n", "1\t2.5\t0.25\t-3\t21\n4\t5\t0.5\t6e-1\t22\n"},
      {"", "  1  2.5 0.25   -3 21  \n4 5 0.5 6e-1 22"},
      {"decimal = comma\n", "1 2,5 0,25 -3 21\n4 5 0,5 0,6 22\n"},
      {"skip = 2\ncomment = %\n",
       "Tracker\nof a day\n% note, with commas\n1,2.5,0.25,-3,21\n\n4,5,0.5,+0.6,22\n"},
      {"header = yes\n", "a,b,c,d,e\n1,2.5,0.25,-3,21\n\"4\",5,0.5,0.6,22\n"},
  };
  for (const auto& way : ways) {
    ImportTable table = mapped_table(way.text, "data.txt", map_of(way.statements + map));
    finish_tracker(table);
    const Measurement m =
        parse_measurement(measurement_csv(table), "out.csv", parse_machine(kMachine, "machine.xml"));
    ASSERT_EQ(m.rows(), 2u) << way.text;
    EXPECT_EQ(m.states.axis[1][0], 2.5) << way.text;
    EXPECT_EQ(m.states.input[0][1], 22);
    EXPECT_EQ(m.states.run_names[0], "s 1");
    ASSERT_EQ(m.observations.size(), 4u);
    EXPECT_DOUBLE_EQ(m.observations[0].value, 250);
    EXPECT_DOUBLE_EQ(m.observations[3].value, 0.6);
    EXPECT_DOUBLE_EQ(m.uncertainty[0], 0.005);
  }
}

TEST(Tracker, TakesColumnsByTheirNamesInTheHeader) {
  ImportTable table = mapped_table("Point;T air;X=;x\n7;20;1;2\n", "data.txt",
                                   map_of("column T air = T[degC]\ncolumn x = x[mm]\ncolumn X= = X[mm]\n"));
  finish_tracker(table);
  EXPECT_EQ(measurement_csv(table), "T[degC],x[mm],X[mm]\n20,2,1\n");
}

TEST(Tracker, OrientationsBecomeTheRotationVectorOfTheChain) {
  std::mt19937_64 random(30);
  std::uniform_real_distribution<double> angle(-170, 170);
  for (int i = 0; i < 50; ++i) {
    const std::array<double, 3> angles = {angle(random), angle(random) / 2, angle(random)};
    // The second derivation: the frame that the chain itself makes of these angles.
    const Eigen::Matrix3d rotation = sixdof_frame({0, 0, 0, angles[0], angles[1], angles[2]}).rotation;
    const Eigen::AngleAxisd expected(rotation);
    EXPECT_LE((rotation_vector_of_angles(angles) - kDeg * expected.angle() * expected.axis()).norm(), 1e-9);
    const Eigen::Quaterniond q(rotation);
    EXPECT_LE((rotation_vector_of_quaternion({-q.w(), -q.x(), -q.y(), -q.z()}) -
               kDeg * expected.angle() * expected.axis())
                  .norm(),
              1e-9);
  }
  ImportTable table = mapped_table("0.25\t0 0.5\n", "d",
                                   map_of("separator=space\ncolumn 1 = rX[rad]\n"
                                          "column 2 = rY[deg]\ncolumn 3=rZ[deg]\nset x[mm]=1\n"));
  finish_tracker(table);
  EXPECT_EQ(table.find("rX"), nullptr);
  EXPECT_NEAR(table.numbers("rx")[0], 0.25 * kDeg, 1e-3);
  EXPECT_NEAR(table.numbers("rz")[0], 0.5, 1e-2);
}

TEST(Tracker, LinesOfATitleAreFoundAboveATable) {
  const auto skipped = [](const std::string& text, bool header = false) {
    DelimitedFormat format;
    format.header = header;
    return title_lines(text, "t.txt", format).skip;
  };
  const std::string rows = "P1   1.5   2.5   3.5\nP2   4.5   5.5   6.5\nP3   7.5   8.5   9.5\n";
  EXPECT_EQ(skipped(rows), 0U);
  EXPECT_EQ(skipped("// AT960  Messung 12.05.2026  Einheit mm\n" + rows), 1U);
  EXPECT_EQ(skipped("// four words of comment\n" + rows), 1U);
  EXPECT_EQ(skipped("Messung an der Fraese\n\nTemperatur: 20,3 degC\n" + rows), 3U);
  EXPECT_EQ(skipped("Messung der Fraese 4711\n" + rows), 1U);  // as many words as a row has fields
  EXPECT_EQ(skipped("Name X Y Z\n" + rows), 0U);
  EXPECT_EQ(skipped("Messung vom 12.05.2026, zweiter Aufbau\nName X Y Z\n" + rows, true), 1U);
  EXPECT_EQ(title_lines("# a\nMessung \"neu\nP1;1,5;2\nP2;3;4\nP3;5;6\n", "t.txt", {}).texts,
            std::vector<std::string>{"Messung \"neu"});
  // Rows of more words than numbers.
  EXPECT_EQ(
      skipped("Messung 4711\nName;Status;Bemerkung;z\nP1;ok;neu;1,5\nP2;ok;alt;2,5\nP3;ok;alt;3,5\n", true),
      1U);
  // A row without a field is an error of the table, and not its title.
  EXPECT_EQ(skipped("P0   1.5   2.5\n" + rows), 0U);
  // Headings of two words in a table of blanks: no line is the header.
  EXPECT_EQ(skipped("Name X [mm] Y [mm] Z [mm]\n" + rows, true), 0U);
}

TEST(Camera, PosesOfABoardKeepTheirFrame) {
  const std::string map =
      "column 1 = X[mm]\ncolumn 2 = x[m]\ncolumn 3 = y[m]\ncolumn 4 = z[m]\ncolumn 5 = rx[rad]\n"
      "column 6 = ry[rad]\ncolumn 7 = rz[rad]\nset Y[mm] = 0\nset ua[mrad] = 0.2\n";
  const std::string text = "10,0.1,-0.2,0.5,3,0.1,-0.2\n";
  const Machine machine = parse_machine(kMachine, "machine.xml");
  for (const bool on_tool : {true, false}) {
    ImportTable table = mapped_table(text, "data.txt", map_of(map));
    finish_camera(table, on_tool);
    const Measurement m = parse_measurement(measurement_csv(table), "out.csv", machine);
    ASSERT_EQ(m.observations.size(), 6u);
    EXPECT_EQ(m.observations[0].kind, on_tool ? ObservationKind::kBoardX : ObservationKind::kX);
    EXPECT_EQ(m.observations[5].kind, on_tool ? ObservationKind::kBoardRz : ObservationKind::kRz);
    EXPECT_DOUBLE_EQ(m.observations[1].value, -200);
    EXPECT_NEAR(m.observations[3].value, 3 * kDeg, 1e-9);
    EXPECT_NEAR(m.angle_uncertainty[0], 2e-4 * kDeg, 1e-12);
  }
  ImportTable half = mapped_table("10,0.1\n", "data.txt", map_of("column 1 = X[mm]\ncolumn 2 = x[m]\n"));
  EXPECT_THROW(finish_camera(half, true), InputError);
}

TEST(Tracker, ErrorsNameFileLineAndWord) {
  const std::string map = "column 1 = X[mm]\ncolumn 2 = x[mm]\n";
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_EQ(message_of(map, "1,2\n"), "");
  EXPECT_TRUE(has(message_of(map, "1,2\n1,2x\n"), "data.txt:2: \"2x\""));
  EXPECT_TRUE(has(message_of(map, "1,2\n# c\n1,2,3\n"), "data.txt:3: \"1,2,3\""));
  EXPECT_TRUE(has(message_of(map, "1;2,5\n"), "\"2,5\""));  // decimal comma not asked for
  EXPECT_TRUE(has(message_of(map, "1;2,5\n"), "give --decimal comma"));
  EXPECT_TRUE(has(message_of(map, "1,nan\n"), "\"nan\""));
  EXPECT_TRUE(has(message_of(map, "1\n"), "\"2\": this column does not exist"));
  EXPECT_TRUE(has(message_of(map, "# nothing\n"), "no rows"));
  EXPECT_TRUE(has(message_of(map, std::string("1,2\0\n", 5)), "zero byte"));
  EXPECT_TRUE(has(message_of(map, "1,\"2\n"), "quote"));
  EXPECT_TRUE(has(message_of("column 1 = x[furlong]\n", "1\n"), "map.txt:1: \"furlong\""));
  EXPECT_TRUE(has(message_of(map + "column 1 = x[mm]\n", "1,2\n"), "map.txt:3: \"x\""));
  EXPECT_TRUE(has(message_of("colum 1 = x[mm]\n", "1\n"), "map.txt:1: \"colum 1\""));
  EXPECT_TRUE(has(message_of("column Far = x[mm]\n", "a,b\n1,2\n"), "data.txt:1: \"Far\""));
  EXPECT_TRUE(has(message_of("column a = x[mm]\n", "a,a\n1,2\n"), "several"));
  EXPECT_TRUE(has(message_of("column 1 = X[mm]\n", "1,2\n"), "no measured column is mapped"));
  EXPECT_TRUE(has(message_of("column 1 = rX[deg]\n", "1,2\n"), "rY rZ"));
  EXPECT_TRUE(has(message_of("column 1=qw\ncolumn 2=qx\ncolumn 3=qy\ncolumn 4=qz\n", "1,0,0,0\n1,0.2,0,0\n"),
                  "data.txt:2: \"qw\""));
  EXPECT_TRUE(
      has(message_of("column 1=qw\ncolumn 2=qx\ncolumn 3=qy\ncolumn 4=qz\nset rx[deg]=1\n", "1,0,0,0\n"),
          "mapped twice, in two forms"));
  EXPECT_TRUE(
      has(message_of("column 1 = x[mm]\ncolumn 2 = role\n", "1,fit\n2,chek\n"), "data.txt:2: \"chek\""));
}

TEST(Tracker, EveryNthRowJudges) {
  ImportTable table = mapped_table("1\n2\n3\n4\n5\n", "d", map_of("column 1 = x[mm]\n"));
  set_roles(table, 2);
  EXPECT_EQ(table.find("role")->cells, (std::vector<std::string>{"fit", "check", "fit", "check", "fit"}));
  EXPECT_THROW(set_roles(table, 2), InputError);
}

constexpr const char* kTouch =
    "column 1 = X[mm]\ncolumn 2 = Y[mm]\ncolumn 3 = px[mm]\ncolumn 4 = py[mm]\ncolumn 5 = pz[mm]\n"
    "column 6 = nx\ncolumn 7 = ny\ncolumn 8 = nz\n";

TEST(Probe, DeviationIsRecordedMinusNominalAlongTheNormal) {
  const std::string map = std::string(kTouch) + "column 9 = mx[mm]\ncolumn 10 = my[mm]\ncolumn 11 = mz[um]\n";
  ImportTable table = mapped_table("9,9, 10,20,30, 0.6,0,0.8, 10.01,20.5,30020\n", "d", map_of(map));
  finish_probe(table, 0);
  EXPECT_NEAR(table.numbers("d")[0], 0.6 * 0.01 + 0.8 * 0.02, 1e-12);
  EXPECT_EQ(table.find("mx"), nullptr);
  const Measurement m =
      parse_measurement(measurement_csv(table), "out.csv", parse_machine(kMachine, "machine.xml"));
  ASSERT_EQ(m.observations.size(), 1u);
  EXPECT_EQ(m.observations[0].kind, ObservationKind::kD);
  EXPECT_DOUBLE_EQ(m.states.normal[2][0], 0.8);
  EXPECT_DOUBLE_EQ(m.nominal_point(0, 0), 10);
}

TEST(Probe, BallCentresAreComparedWithThePointOffTheSurface) {
  const std::string map = std::string(kTouch) + "column 9 = mx[mm]\ncolumn 10 = my[mm]\ncolumn 11 = mz[mm]\n";
  ImportTable table = mapped_table("9,9, 10,20,30, 0,0,1.0004, 10,20,33.01\n", "d", map_of(map));
  finish_probe(table, 3);
  EXPECT_NEAR(table.numbers("d")[0], 0.01, 1e-12);
  EXPECT_NEAR(table.numbers("pz")[0], 33, 1e-12);
  EXPECT_DOUBLE_EQ(table.numbers("nz")[0], 1);
}

TEST(Probe, RefusesAnIncompleteTouch) {
  const auto message = [](const std::string& map, const std::string& text) {
    try {
      ImportTable table = mapped_table(text, "data.txt", map_of(map));
      finish_probe(table, 0);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string with_d = std::string(kTouch) + "column 9 = d[um]\n";
  EXPECT_EQ(message(with_d, "0,0,1,2,3,0,0,1,5\n"), "");
  EXPECT_NE(message(with_d, "0,0,1,2,3,0,0,1,5\n0,0,1,2,3,0,0,0.9,5\n").find("data.txt:2: \"nx\""),
            std::string::npos);
  EXPECT_NE(message(with_d, "0,0,1,2,3,0,,1,5\n").find("empty cell"), std::string::npos);
  EXPECT_NE(message(kTouch, "0,0,1,2,3,0,0,1,5\n").find("neither"), std::string::npos);
  EXPECT_NE(message(std::string(kTouch) + "column 9 = d\n", "0,0,1,2,3,0,0,1,5\n")
                .find("needs a unit, for example mm"),
            std::string::npos);
  EXPECT_NE(message("column 1 = d[mm]\n", "1\n").find("normal"), std::string::npos);
}

}  // namespace
}  // namespace vernier::survey_test
