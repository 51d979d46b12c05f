// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/measurement.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::measurement_test {

using namespace vernier::model;
using namespace vernier::text;
namespace {

Machine machine() {
  return parse_machine(R"XML(<machine><variables><static><k value="0"/></static>
    <machineaxes><X/><B rotary="true"/></machineaxes><inputs><T unit="degC" reference="20"/></inputs></variables>
    <transforms><sixdof X="X+k*T" rY="B"/></transforms></machine>)XML",
                       "m.xml");
}
Measurement read(const std::string& text) { return parse_measurement(text, "m.csv", machine()); }
std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// The same machine, measured by an instrument whose u grows with the length.
Machine with_instrument(const std::string& u) {
  return parse_machine(
      "<machine><variables><machineaxes><X/></machineaxes><instrument u=\"" + u +
          "\" X=\"100\" Z=\"-50\"/></variables><transforms><sixdof X=\"X\"/></transforms></machine>",
      "m.xml");
}

TEST(MeasurementFile, UncertaintyGrowsWithTheLengthFromTheInstrument) {
  const Machine tracker = with_instrument("15um + 6um/m");
  // 3-4-5: 300 in x, 400 in z from (100, 0, -50).
  const Measurement m =
      parse_measurement("X[mm],x[mm],y[mm],z[mm]\n1,400,0,350\n2,100,,-50\n", "m.csv", tracker);
  EXPECT_NEAR(m.uncertainty[0], 0.015 + 0.006 * 0.5, 1e-12);
  EXPECT_NEAR(m.uncertainty[1], 0.015, 1e-12);
  const Measurement bar = parse_measurement("X[mm],length[mm],cx[mm],cy[mm],cz[mm]\n1,600,0,0,0\n", "m.csv",
                                            with_instrument("2.5 + L/300"));
  EXPECT_NEAR(bar.uncertainty[0], (2.5 + 600 / 300.0) * 1e-3, 1e-12);
}

TEST(MeasurementFile, AColumnOfUncertaintyStandsBeforeTheInstruments) {
  const Measurement m =
      parse_measurement("X[mm],x[mm],u[um]\n1,400,2\n", "m.csv", with_instrument("15um+6um/m"));
  EXPECT_DOUBLE_EQ(m.uncertainty[0], 0.002);
}

TEST(MeasurementFile, AnInstrumentWithoutALawIsRefusedByItsWord) {
  for (const char* u : {"", "15", "6um/s", "-3um", "15um 6um/m", "L/0", "um"}) {
    const bool bare = std::string_view(u) == "15";  // um, as in 2.5 + L/300
    try {
      with_instrument(u);
      EXPECT_TRUE(bare) << u;
    } catch (const InputError& error) {
      EXPECT_FALSE(bare) << u;
      EXPECT_NE(std::string(error.what()).find("15um + 6um/m"), std::string::npos) << error.what();
    }
  }
  EXPECT_NE(
      [] {
        try {
          parse_measurement("X[mm],x[mm],rx[deg]\n1,400,0\n", "m.csv", with_instrument("15um"));
        } catch (const InputError& error) {
          return std::string(error.what());
        }
        return std::string("accepted");
      }()
          .find("\"ua\""),
      std::string::npos);
}

TEST(MeasurementFile, ConvertsUnitsToTheBaseUnits) {
  const Measurement m = read(
      "# a comment\nX[in],B[arcsec],vX[mm/min],aX[g],feed[m/s],t[min],T[K],x[um],u[um],run,role\n"
      "1,7200,60,1,0.1,2,293.15,1500,2,a,fit\n2,0,0,0,0,3,294.15,1,1,b,check\n");
  EXPECT_DOUBLE_EQ(m.states.axis[0][0], 25.4);
  EXPECT_DOUBLE_EQ(m.states.axis[1][0], 2);
  EXPECT_DOUBLE_EQ(m.states.velocity[0][0], 1);
  EXPECT_DOUBLE_EQ(m.states.acceleration[0][0], 9806.65);
  EXPECT_DOUBLE_EQ(m.states.feed[0], 6000);
  EXPECT_DOUBLE_EQ(m.states.time[0], 120);
  EXPECT_NEAR(m.states.input[0][0], 20, 1e-12);
  EXPECT_DOUBLE_EQ(m.observations[0].value, 1.5);
  EXPECT_DOUBLE_EQ(m.uncertainty[0], 0.002);
  EXPECT_EQ(m.check[0], 0);
  EXPECT_EQ(m.check[1], 1);
  EXPECT_EQ(m.states.run_names, (std::vector<std::string>{"a", "b"}));
}

TEST(MeasurementFile, UnitsOfAShopFloorAreRead) {
  const Measurement m = read(
      "X[µm],B[°],T[°C],vB[rpm],x[\u03bcm],u[µm],i[A],n[rpm],duty[%],f[Hz],p[bar],q[Pa],m[Nm],w[N·m],e[W],"
      "s[µm/m]\n2000,3,21,2,1500,2,1,2,3,4,5,6,7,8,9,10\n");
  EXPECT_DOUBLE_EQ(m.states.axis[0][0], 2);
  EXPECT_DOUBLE_EQ(m.states.axis[1][0], 3);
  EXPECT_DOUBLE_EQ(m.states.input[0][0], 21);
  EXPECT_DOUBLE_EQ(m.states.velocity[1][0], 12);  // 2 turns a minute
  EXPECT_DOUBLE_EQ(m.observations[0].value, 1.5);
  EXPECT_DOUBLE_EQ(m.uncertainty[0], 0.002);
  std::vector<std::string> units;
  for (const CandidateInput& candidate : m.candidates) units.push_back(candidate.unit);
  EXPECT_EQ(units, (std::vector<std::string>{"A", "rpm", "%", "Hz", "bar", "Pa", "Nm", "Nm", "W", "um/m"}));
}

TEST(MeasurementFile, FahrenheitIsATemperature) {
  const Measurement m = read("X[mm],B[deg],T[degF],x[mm]\n1,0,68,2\n2,0,77,3\n");
  EXPECT_NEAR(m.states.input[0][0], 20, 1e-12);
  EXPECT_NEAR(m.states.input[0][1], 25, 1e-12);
  EXPECT_NEAR(read("X[mm],B[deg],T[°F],x[mm]\n1,0,50,2\n").states.input[0][0], 10, 1e-12);
}

TEST(MeasurementFile, UnknownUnitIsNamedAsWritten) {
  EXPECT_EQ(error_of("X[mm],B[deg],x[furlong]\n1,2,3\n").substr(0, 32), "m.csv:1: \"furlong\": unknown unit");
}

TEST(MeasurementFile, AbsentColumnsHaveTheirDefaults) {
  const Measurement m = read("X[mm],B[deg],x[mm]\n1,2,3\n");
  EXPECT_EQ(m.states.velocity[0][0], 0);
  EXPECT_EQ(m.states.since[0][0], kLongWay);
  EXPECT_EQ(m.states.input[0][0], 20);  // the input's reference
  EXPECT_EQ(m.uncertainty[0], 0);
}

/// Out and back in two runs: the travel before the first reversal of a run is not known. A read position
/// scatters by some um while the axis stands.
TEST(MeasurementFile, CountsTheTravelSinceAReversalFromSuccessiveRows) {
  const Measurement m = read(
      "X[mm],B[deg],dirX,x[mm],run\n0,0,1,0,a\n40,0,1,0,a\n10,0,-1,0,a\n10.003,0,-1,0,a\n5,0,-1,0,a\n"
      "100,0,1,0,b\n20,0,-1,0,b\n");
  // Run b begins with the way from the last row of run a. The travel before the first row is not known: 0.
  const double expected[] = {0, 40, 30, 30.003, 35.006, 95, 80};
  for (Eigen::Index row = 0; row < 7; ++row) EXPECT_NEAR(m.states.since[0][row], expected[row], 1e-6) << row;
  EXPECT_EQ(m.states.since[1][3], kLongWay);  // B has no column of directions
  EXPECT_FALSE(m.has_recorded("sinceX"));
}

TEST(MeasurementFile, ARunThatBeginsAgainstTheWayToItsFirstRowBeganWithATurn) {
  const Measurement m = read("X[mm],B[deg],dirX,x[mm],run\n0,0,1,0,a\n40,0,1,0,a\n10,0,1,0,b\n40,0,1,0,b\n");
  const double expected[] = {0, 40, 0, 30};
  for (Eigen::Index row = 0; row < 4; ++row) EXPECT_NEAR(m.states.since[0][row], expected[row], 1e-6) << row;
}

/// The axis went beyond a position and came back: no row shows the reversal.
TEST(MeasurementFile, TheTravelSinceAReversalIsNotKnownIfAStepDisagreesWithItsDirection) {
  const auto last = [](const std::string& rows) {
    return read("X[mm],B[deg],dirX,x[mm]\n0,0,1,0\n40,0,1,0\n10,0,-1,0\n" + rows).states.since[0].tail(1)[0];
  };
  EXPECT_EQ(last("5,0,-1,0\n"), 35);
  EXPECT_EQ(last("5,0,1,0\n"), kLongWay);
  EXPECT_EQ(last("10,0,1,0\n"), 0) << "the end of a linear test: a little beyond the position and back";
  EXPECT_EQ(last("5,0,0,0\n"), kLongWay);
  EXPECT_EQ(last("10,0,0,0\n"), 30);
  EXPECT_EQ(read("X[mm],B[deg],dirX,sinceX[mm],x[mm]\n0,0,1,7,0\n40,0,1,7,0\n").states.since[0][1], 7);
}

TEST(MeasurementFile, EmptyCellsAreAbsentObservationsOrExcludedRows) {
  const Measurement m =
      read("X[mm],B[deg],T[degC],x[mm],y[mm],load[kg],run\n1,0,20,5,,3,a\n2,0,,5,6,3,a\n3,0,21,,7,,a\n");
  EXPECT_EQ(m.excluded, 1U);
  EXPECT_EQ(m.rows(), 2U);
  EXPECT_EQ(m.observations.size(), 2U);
  EXPECT_EQ(m.states.visit[1], 2);  // the excluded row was visited all the same
  EXPECT_EQ(m.candidates[0].name, "load");
  EXPECT_TRUE(std::isnan(m.candidates[0].value[1]));
  EXPECT_EQ(m.line[1], 4U);
}

TEST(MeasurementFile, ErrorsNameFileLineAndWord) {
  EXPECT_EQ(error_of("X[mm],x[mm]\n1,2\n"),
            "m.csv:1: \"B\": the column of this axis is missing; if the axis did not move, add its position: "
            "vernier "
            "import table m.csv --set \"B[deg]=POSITION\" -o NEW.csv");
  EXPECT_EQ(error_of("X[mm],B[deg],x[mm]\n1,2,3\n1,2\n").substr(0, 14), "m.csv:3: \"1,2\"");
  EXPECT_EQ(error_of("X[mm],B[deg],x[mm]\n1,2,3a\n"), "m.csv:2: \"3a\": not a number, in column x");
  EXPECT_EQ(error_of("X[mm],B[mm],x[mm]\n1,2,3\n"),
            "m.csv:1: \"B[mm]\": this column needs a unit, for example deg");
  EXPECT_EQ(error_of("X[mm],B[deg],x[furlong]\n1,2,3\n").substr(0, 28), "m.csv:1: \"furlong\": unknown ");
}

TEST(MeasurementFile, RefusesWhatItWouldOtherwiseHaveToGuess) {
  for (const char* text : {"", "X[mm],B[deg],x[mm]\n", "X[mm],B[deg]\n1,2\n", "X,B,x\n1,2,3\n",
                           "X[mm],B[deg],x[mm],x[mm]\n1,2,3,4\n", "X[mm],B[deg],x[mm],role\n1,2,3,chek\n",
                           "X[mm],B[deg],x[mm],dirX\n1,2,3,0.5\n", "X[mm],B[deg],x[mm],u[mm]\n1,2,3,0\n",
                           "X[mm],B[deg],x[mm],u[mm]\n1,2,3,\n", "X[mm],B[deg],length[mm]\n1,2,3\n",
                           "X[mm],B[deg],d[mm],nx,ny,nz\n1,2,3,1,0,0\n",
                           "X[mm],B[deg],d[mm],nx,ny,nz,px[mm],py[mm],pz[mm]\n1,2,3,0,0,0,0,0,0\n",
                           "X[mm],B[deg],x[mm]\n,2,3\n", "X[mm],B[deg],x[mm]\n1,2,nan\n",
                           "X[mm],B[deg],x[mm]\n1,2,1e999\n", "X[mm],B[deg],x[mm],T[mm]\n1,2,3,4\n",
                           "X[mm],B[deg],x[mm],run\n1,2,3,\"a\n", "X[mm],B[deg],x[mm],a b\n1,2,3,4\n"})
    EXPECT_NE(error_of(text), "accepted") << text;
}

TEST(MeasurementFile, SelectedRowsKeepTheirObservations) {
  const Measurement all = read("X[mm],B[deg],x[mm],y[mm]\n1,0,1,2\n2,0,3,4\n3,0,5,6\n");
  const Measurement some = select_rows(all, {0, 2});
  ASSERT_EQ(some.observations.size(), 4U);
  EXPECT_EQ(some.observations[2].row, 1U);
  EXPECT_EQ(some.observations[2].value, 5);
  EXPECT_EQ(some.line[1], 4U);
}

constexpr const char* kOnAndOff =
    "X[mm],B[deg],x[mm],correctionX[um],correctionB[arcsec],load[kg]\n"
    "100.1,10,1,2.5,-7.2,1\n100.1,10,2,,,2\n0.3,-4,3,-1,0,3\n";

TEST(MeasurementFile, TheMachineStoodWhereItWasCommandedPlusWhatTheBoardAdded) {
  const Measurement m = read(kOnAndOff);
  EXPECT_DOUBLE_EQ(m.correction[0][0], 2.5e-3);
  EXPECT_DOUBLE_EQ(m.correction[1][0], -2e-3);
  EXPECT_EQ(m.correction[0][1], 0);  // an empty cell: nothing was added
  EXPECT_DOUBLE_EQ(m.states.axis[0][0], 100.1025);
  EXPECT_DOUBLE_EQ(m.states.axis[1][0], 9.998);
  EXPECT_EQ(m.states.axis[0][1], 100.1);
  // As it was written, to the last bit: both rows are at one pose.
  EXPECT_EQ(commanded(m, 0)[0], 100.1);
  EXPECT_EQ(commanded(m, 0)[2], 0.3);
  EXPECT_EQ(commanded(m, 1, 0), 10);
  ASSERT_EQ(m.candidates.size(), 1U);
  EXPECT_EQ(m.candidates[0].name, "load");
}

TEST(MeasurementFile, CorrectionsGoWithTheirRows) {
  const Measurement some = select_rows(read(kOnAndOff), {1, 2});
  ASSERT_EQ(some.correction.size(), 2U);
  EXPECT_EQ(some.correction[0][1], -1e-3);
  EXPECT_DOUBLE_EQ(some.states.axis[0][1], 0.299);
  const Measurement left = read("X[mm],B[deg],x[mm],correctionX[mm],T[degC]\n1,0,1,1,\n2,0,1,0.5,20\n");
  EXPECT_EQ(left.excluded, 1U);
  EXPECT_EQ(left.correction[0][0], 0.5);
  EXPECT_EQ(left.correction[1][0], 0);  // no column: nothing was added to this axis
  EXPECT_EQ(left.states.axis[0][0], 2.5);
}

TEST(MeasurementFile, FilesWithAndWithoutCorrectionsMix) {
  const std::string folder = testing::TempDir() + "mixed_" + std::to_string(getpid());
  const std::vector<std::string> paths = {folder + "_off.csv", folder + "_on.csv", folder + "_again.csv"};
  write_file(paths[0], "X[mm],B[deg],x[mm]\n1,0,1\n");
  write_file(paths[1], "X[mm],B[deg],x[mm],correctionB[deg],corrected\n1,0,1,0.5,00000000deadBEEF\n");
  write_file(paths[2], "X[mm],B[deg],x[mm]\n3,0,1\n");
  const Measurement m = read_measurement(paths, machine());
  for (const std::string& path : paths) std::filesystem::remove(path);
  EXPECT_EQ(m.correction[1][0], 0);
  EXPECT_EQ(m.correction[1][1], 0.5);
  EXPECT_EQ(m.correction[1][2], 0);
  EXPECT_EQ(m.states.axis[1][1], 0.5);
  // The columns say it: the image need not be at hand.
  EXPECT_EQ(m.corrected, (std::vector<std::string>{"", "00000000deadbeef", ""}));
}

TEST(MeasurementFile, RefusesACorrectionThatItCannotTakeAway) {
  EXPECT_EQ(error_of("X[mm],B[deg],x[mm],corrected\n1,2,3,\n1,2,3,0123456789abcdef\n").substr(0, 27),
            "m.csv:3: \"0123456789abcdef\"");
  EXPECT_EQ(error_of("X[mm],B[deg],x[mm],corrected\n1,2,3,on\n").substr(0, 13), "m.csv:2: \"on\"");
  EXPECT_EQ(error_of("X[mm],B[deg],C[deg],x[mm],correctionC[deg]\n1,2,3,4,0\n"),
            "m.csv:1: \"correctionC\": the machine file has no axis of this name");
  EXPECT_EQ(error_of("X[mm],B[deg],x[mm],correctionX[deg]\n1,2,3,0\n").substr(0, 28),
            "m.csv:1: \"correctionX[deg]\":");
  EXPECT_EQ(error_of("X[mm],B[deg],x[mm],corrected\n1,2,3,\n"), "accepted");  // no image ran
}

TEST(MeasurementFiles, AFileWithoutTimesHasItsOwnClock) {
  const Machine m = machine();
  const std::string timed = "X[mm],B[deg],x[mm],t[s]\n1,0,1,380\n2,0,2,388\n",
                    plain = "X[mm],B[deg],x[mm]\n3,0,3\n4,0,4\n";
  for (const bool timed_first : {true, false}) {
    Measurement all = parse_measurement(timed_first ? timed : plain, "a.csv", m);
    append_measurement(all, parse_measurement(timed_first ? plain : timed, "b.csv", m));
    EXPECT_NO_THROW(require_time_order(all));
    EXPECT_NE(all.states.of(all.states.clock, 1), all.states.of(all.states.clock, 2));
    EXPECT_EQ(all.states.of(all.states.clock, 0), all.states.of(all.states.clock, 1));
  }
  Measurement falls = parse_measurement(timed, "a.csv", m);
  append_measurement(falls, parse_measurement("X[mm],B[deg],x[mm],t[s]\n3,0,3,5\n", "b.csv", m));
  EXPECT_THROW(require_time_order(falls), InputError);
}

}  // namespace
}  // namespace vernier::measurement_test
