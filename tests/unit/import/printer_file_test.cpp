// SPDX-License-Identifier: GPL-3.0-or-later
// Layouts: Klipper (bed_mesh.py, probe.py, statistics.py, heaters.py), RepRapFirmware (Grid.cpp), Marlin
// (G30).
#include "tools/import/logs/printer_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/text/error.h"

namespace vernier::printer_file_test {

using namespace vernier::importer;
using testing::HasSubstr;
namespace {

std::string read(const std::string& text, const PrinterOptions& options = {}) {
  try {
    return measurement_csv(read_printer_file(text, "p.cfg", options).table);
  } catch (const text::InputError& error) {
    return std::string("refused: ") + error.what();
  }
}

const std::string kConfiguration =
    "[stepper_x]\nposition_max: 235\n\n[bltouch]\nx_offset: -40.0  # left of the nozzle\ny_offset = 10\n\n"
    "#*# <---------------------- SAVE_CONFIG ---------------------->\n#*#\n"
    "#*# [bed_mesh default]\n#*# version = 1\n#*# points =\n#*# \t  -0.10, 0.02, 0.05\n#*# \t0.07, 0.08, "
    "-0.03\n"
    "#*# tension = 0.2\n#*# min_x = 20.0\n#*# x_count = 3\n#*# y_count = 2\n#*# max_x = 220.0\n"
    "#*# min_y = 30.0\n#*# max_y = 200.0\n";

TEST(PrinterFile, SavedMeshOfKlipperIsPositionsOfTheNozzle) {
  EXPECT_EQ(
      read(kConfiguration),
      "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on\n60,20,-0.1,-40,10,bed\n160,20,0.02,-40,10,bed\n"
      "260,20,0.05,-40,10,bed\n60,190,0.07,-40,10,bed\n160,190,0.08,-40,10,bed\n260,190,-0.03,-40,10,bed"
      "\n");
  PrinterOptions options;
  options.offset_mm = {0, 0}, options.artefact = "plate", options.u_um = 8;
  EXPECT_THAT(read(kConfiguration, options),
              testing::StartsWith("X[mm],Y[mm],Z[mm],on,u[um]\n20,30,-0.1,plate,8\n"));
}

// A mesh in a file that the printer includes, as `vernier export klipper` writes it.
TEST(PrinterFile, AMeshWithoutTheMarksOfSavedLines) {
  std::string text = kConfiguration;
  for (std::size_t at = 0; (at = text.find("#*# ", at)) != std::string::npos;) text.erase(at, 4);
  EXPECT_EQ(read(text), read(kConfiguration));
}

TEST(PrinterFile, MeshIsChosenByName) {
  const std::string second =
      "#*# [bed_mesh warm]\n#*# points =\n#*# \t1, 2\n#*# x_count = 2\n#*# y_count = 1\n"
      "#*# min_x = 0\n#*# max_x = 10\n#*# min_y = 5\n#*# max_y = 5\n";
  PrinterOptions options;
  options.profile = "warm", options.offset_mm = {0, 0};
  EXPECT_EQ(read(kConfiguration + second, options), "X[mm],Y[mm],Z[mm],on\n0,5,1,bed\n10,5,2,bed\n");
  options.profile = "hot";
  EXPECT_THAT(read(kConfiguration + second, options), HasSubstr("has these meshes: default, warm"));
}

TEST(PrinterFile, WrongMeshesAreNamedWithTheirLine) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kConfiguration;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_THAT(read(with("x_count = 3", "x_count = 4")), HasSubstr("p.cfg:13: "));
  EXPECT_THAT(read(with("y_count = 2", "y_count = 3")),
              HasSubstr("the mesh has 2 rows, but y_count states 3"));
  EXPECT_THAT(read(with("0.02", "nan")), HasSubstr("p.cfg:13: "));
  EXPECT_THAT(read(with("min_x", "mix_x")), HasSubstr("lacks this setting"));
  EXPECT_THAT(read(with("x_count = 3", "x_count = 3000000000")), HasSubstr("from 1 to 1000"));
  EXPECT_THAT(read("[stepper_x]\n"), HasSubstr("the file has no touches"));
}

TEST(PrinterFile, LogOfKlipperHasTimesAndTemperatures) {
  const std::string log =
      "Start printer at Wed\nStats 1000.5: gcodein=0  heater_bed: target=60 temp=59.8 pwm=0.25 "
      "raspberry_pi: temp=48.3 print_time=12.5\n"
      "// probe at 30.000,40.000 is z=2.012500\nprobe at 30.000,40.000 is z=2.900000 [discarded]\n"
      "Stats 1003.5: gcodein=0  heater_bed: target=60 temp=60.1 pwm=0.2 raspberry_pi: temp=48.5\n"
      "probe: at 130.000,40.000 bed will contact at z=-0.003000\n";
  PrinterOptions nozzle;
  nozzle.offset_mm = {0, 0};
  EXPECT_EQ(
      read(log, nozzle),
      "X[mm],Y[mm],Z[mm],on,t[s],T_heater_bed[degC],T_raspberry_pi[degC]\n30,40,2.0125,bed,0,59.8,48.3\n"
      "130,40,-0.003,bed,3,60.1,48.5\n");
  EXPECT_EQ(read_printer_file(log, "k.log", nozzle).left_out, 1U);
  // A touch before the first state has no time: no column of times at all.
  EXPECT_EQ(read("probe at 1.000,2.000 is z=3.000000\n" + log, nozzle).substr(0, 21),
            "X[mm],Y[mm],Z[mm],on\n");
}

// Klipper's bed_mesh.py stores z - z_offset for the older line; the newer line is relative already.
TEST(PrinterFile, TheZOffsetOfTheConfigurationIsSubtractedFromTheOlderLine) {
  const std::string config =
      "===== Config file =====\n[bltouch]\nx_offset: -38\ny_offset: -8\nz_offset = 2.150\n=======\n";
  const std::string touch = "probe at 48.000,23.000 is z=2.158\n";
  const PrinterFile file = read_printer_file(config + touch, "klippy.log", {});
  EXPECT_NEAR(file.table.numbers("Z").front(), 0.008, 1e-12);
  EXPECT_EQ(file.zero, "z_offset 2.150 of [bltouch] is subtracted from the heights");
  EXPECT_TRUE(file.zero_known);
  const PrinterFile newer =
      read_printer_file(config + "probe: at 10,15 bed will contact at z=0.008\n", "klippy.log", {});
  EXPECT_EQ(newer.table.numbers("Z").front(), 0.008);
  EXPECT_EQ(newer.zero, "");
  // A restart writes the configuration again: each touch has the one before it.
  std::string changed = config;
  changed.replace(changed.find("2.150"), 5, "-0.70");
  const PrinterFile both =
      read_printer_file(config + touch + changed + "probe at 78,23 is z=-0.692\n", "klippy.log", {});
  EXPECT_NEAR(both.table.numbers("Z").back(), 0.008, 1e-12);
  EXPECT_THAT(both.zero, HasSubstr("; from line 14 on, z_offset -0.70 of [bltouch] is subtracted"));
  EXPECT_THAT(read(config + "[probe]\nz_offset: 1\n" + touch),
              HasSubstr("p.cfg:8: \"probe\": the sections [bltouch] and [probe] give different z_offset"));
}

TEST(PrinterFile, WithoutAZOffsetTheZeroOfTheHeightsIsNotKnown) {
  const std::string touch = "probe at 48.000,23.000 is z=2.158\n";
  const PrinterFile file = read_printer_file(touch, "klippy.log", {});
  EXPECT_EQ(file.table.numbers("Z").front(), 2.158);
  EXPECT_FALSE(file.zero_known);
  EXPECT_THAT(file.zero, HasSubstr("the probe triggered (mean 2.158 mm), and the file has no z_offset"));
  PrinterOptions options;
  options.offset_mm = {-38, -8}, options.z_offset_mm = 2.15;
  const PrinterFile stated = read_printer_file(touch, "klippy.log", options);
  EXPECT_NEAR(stated.table.numbers("Z").front(), 0.008, 1e-12);
  EXPECT_TRUE(stated.zero_known);
  EXPECT_THAT(read("Bed X: 30.0 Y: 40.0 Z: 0.5\n", options),
              HasSubstr("have the zero of the nozzle already"));
}

TEST(PrinterFile, LogOfMarlin) {
  PrinterOptions nozzle;
  nozzle.offset_mm = {0, 0};
  EXPECT_EQ(read("Bed X: 100.00 Y: 50.50 Z: -0.02\nok\nBed X:10 Y:20 Z:0.11\n", nozzle),
            "X[mm],Y[mm],Z[mm],on\n100,50.5,-0.02,bed\n10,20,0.11,bed\n");
}

TEST(PrinterFile, ADecimalCommaInALogIsRefused) {
  EXPECT_EQ(read("ok\nprobe at 30.000,40.000 is z=1,540929\n"),
            "refused: p.cfg:2: \"probe at 30.000,40.000 is z=1,540929\": this line of a touch is not "
            "understood; numbers need a decimal point");
  EXPECT_THAT(read("probe at 30,000,40,000 is z=1,540929\n"), HasSubstr("not understood"));
  EXPECT_THAT(read("Bed X: 30,5 Y: 40,5 Z: 1,5\n"), HasSubstr("not understood"));
  EXPECT_EQ(read("// probe at trigger\nprobe at 1,2 is z=3\n"), "X[mm],Y[mm],Z[mm],on\n1,2,3,bed\n");
}

TEST(PrinterFile, TouchesThatThePrinterRepeatsAreLeftOut) {
  const std::string log =
      "// probe at 1,2 is z=3\n// probe at 1,2 is z=3.1\n// Result is z=3.05\n"
      "// probe at 1,2 is z=4\n// probe at 1,2 is z=5\n// Probe samples exceed tolerance. Retrying...\n"
      "// probe at 1,2 is z=3.2\n";
  EXPECT_EQ(read(log), "X[mm],Y[mm],Z[mm],on\n1,2,3,bed\n1,2,3.1,bed\n1,2,3.2,bed\n");
  EXPECT_EQ(read_printer_file(log, "k.log", {}).left_out, 2U);
  EXPECT_EQ(read("// probe at 0,2 is z=3\n// probe at 1,2 is z=4\n// ... Retrying...\n// probe at 1,2 is "
                 "z=5\n"),
            "X[mm],Y[mm],Z[mm],on\n0,2,3,bed\n1,2,5,bed\n");
}

TEST(PrinterFile, TouchesOfTheProbeArePositionsLessItsOffset) {
  PrinterOptions options;
  options.offset_mm = {-20, 5};
  const std::string rows = "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on\n50,35,0.5,-20,5,bed\n";
  EXPECT_EQ(read("probe: at 30.0,40.0 bed will contact at z=0.5\n", options), rows);
  EXPECT_EQ(read("Bed X: 30.0 Y: 40.0 Z: 0.5\n", options), rows);
  EXPECT_EQ(read("[probe]\nx_offset = -20\ny_offset = 5\nprobe: at 30.0,40.0 bed will contact at z=0.5\n"),
            rows);
  // The older line of Klipper has the position of the nozzle: the offset moves the touched point alone.
  EXPECT_EQ(read("probe at 30.0,40.0 is z=0.5\n", options),
            "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on\n30,40,0.5,-20,5,bed\n");
  EXPECT_EQ(read("[probe]\nx_offset = -20\ny_offset = 5\nprobe at 30.0,40.0 is z=0.5\n"),
            "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on\n30,40,0.5,-20,5,bed\n");
  EXPECT_FALSE(read_printer_file("probe at 30.0,40.0 is z=0.5\n", "p.cfg", {}).offset_known);
  EXPECT_THAT(read("[include probe.cfg]\n[x]\na: 1\n" + kConfiguration.substr(kConfiguration.find("#*#"))),
              HasSubstr("state it with --offset"));
}

// Klipper's axis_twist_compensation: nozzle height minus probe height over X; the mesh has it already, or
// not.
TEST(PrinterFile, ACompensatedMeshHasHeightsOfTheNozzle) {
  const std::string twist =
      "[axis_twist_compensation]\nz_compensations = -0.1, 0.0, 0.3\ncompensation_start_x = 20\n"
      "compensation_end_x = 220\n";
  const std::string file = twist + kConfiguration;
  EXPECT_EQ(read(file),
            "X[mm],Y[mm],Z[mm],on\n20,30,-0.1,bed\n120,30,0.02,bed\n220,30,0.05,bed\n20,200,0.07,bed\n"
            "120,200,0.08,bed\n220,200,-0.03,bed\n");
  PrinterOptions options;
  options.twist = PrinterOptions::Twist::kAdd;
  EXPECT_EQ(read(file, options),
            "X[mm],Y[mm],Z[mm],on\n20,30,-0.2,bed\n120,30,0.02,bed\n220,30,0.35,bed\n20,200,-0.03,bed\n"
            "120,200,0.08,bed\n220,200,0.27,bed\n");
  EXPECT_THAT(read(kConfiguration, options), HasSubstr("has no z_compensations"));
  options.twist = PrinterOptions::Twist::kIgnore;
  EXPECT_EQ(read(file, options), read(kConfiguration));
  EXPECT_THAT(
      read("[axis_twist_compensation]\nz_compensations = 0.1\nstart_x = 1\nend_x = 2\n" + kConfiguration),
      HasSubstr("two values or more"));
}

TEST(PrinterFile, TouchesOfAProbeWithoutItsOffsetAreRefused) {
  for (const char* text :
       {"probe: at 30.0,40.0 bed will contact at z=0.5\n", "Bed X: 30.0 Y: 40.0 Z: 0.5\n",
        "[printer]\nkinematics = cartesian\nprobe: at 30.0,40.0 bed will contact at z=0.5\n",
        "RepRapFirmware height map file v2\nxmin,xmax,ymin,ymax,radius,xspacing,yspacing,xnum,ynum\n"
        "0,10,0,0,-1,10,10,2,1\n0.1,0.2\n"})
    EXPECT_THAT(read(text), HasSubstr("give --offset=X,Y in mm")) << text;
  EXPECT_THAT(read(kConfiguration.substr(kConfiguration.find("#*#"))), HasSubstr("give --offset=X,Y in mm"));
  // Klipper's default of a probe without x_offset is 0.
  EXPECT_EQ(read("[probe]\nz_offset = 2\nprobe: at 30.0,40.0 bed will contact at z=0.5\n"),
            "X[mm],Y[mm],Z[mm],on\n30,40,0.5,bed\n");
}

TEST(PrinterFile, LevellingAndRepeatsAreNoSurveyOfTheBed) {
  EXPECT_EQ(read("probe at 0,0 is z=5\nprobe at 9,0 is z=6\n// Gantry-relative probe points:\n"
                 "probe at 1,2 is z=3\nprobe at 2,2 is z=4\n"),
            "X[mm],Y[mm],Z[mm],on\n1,2,3,bed\n2,2,4,bed\n");
  EXPECT_EQ(read("probe at 1,2 is z=3\nMesh Bed Leveling Complete\nprobe at 0,0 is z=5\nprobe at 0,0 is z=6\n"
                 "probe accuracy results: maximum 6\n"),
            "X[mm],Y[mm],Z[mm],on\n1,2,3,bed\n");
  const std::string two =
      "probe at 1,2 is z=3\nMesh Bed Leveling Complete\nprobe at 1,2 is z=4\nMesh Bed Leveling Complete\n";
  EXPECT_THAT(read(two), HasSubstr("1 (1 touches from line 1), 2 (1 touches from line 3); choose one with "
                                   "--series"));
  PrinterOptions options;
  options.series = 2u;
  EXPECT_EQ(read(two, options), "X[mm],Y[mm],Z[mm],on\n1,2,4,bed\n");
  options.series = 3u;
  EXPECT_THAT(read(two, options), HasSubstr("the log has no survey of this number"));
  options.series = PrinterOptions::Survey::kAll;
  EXPECT_EQ(read(two, options), "X[mm],Y[mm],Z[mm],on\n1,2,3,bed\n1,2,4,bed\n");
}

TEST(PrinterFile, SurveysAtSeveralTemperaturesAreOneTableUnlessOneIsChosen) {
  const auto log_of = [](const std::vector<std::string>& heats, const std::string& end) {
    std::string log;
    for (const std::string& heat : heats) {
      log += "Stats 10.0: heater_bed: target=60 temp=" + heat + "\n";
      for (const char* const point : {"0,0", "9,0", "9,9", "0,9"})
        log += std::string("probe at ") + point + " is z=" + heat + "\n";
      log += end;
    }
    return log;
  };
  const std::string log = log_of({"25.0", "60.0"}, "");
  PrinterOptions options;
  // A line that ends each survey changes nothing; at one temperature the screws may have been turned.
  const std::string end = "Mesh Bed Leveling Complete\n";
  const PrinterFile ended = read_printer_file(log_of({"25.0", "60.0", "90.0"}, end), "klippy.log", options);
  EXPECT_EQ(ended.table.line.size(), 12u);
  EXPECT_THAT(ended.surveys, HasSubstr("3 (4 touches from line 14, bed at 90 degC)"));
  EXPECT_THAT(read(log_of({"25.0", "60.0", "60.4"}, end), options), HasSubstr("choose one with --series"));
  const PrinterFile both = read_printer_file(log, "klippy.log", options);
  EXPECT_EQ(both.table.line.size(), 8u);
  EXPECT_EQ(both.surveys,
            "1 (4 touches from line 2, bed at 25 degC), 2 (4 touches from line 7, bed at 60 degC)");
  options.series = 2u;
  const PrinterFile hot = read_printer_file(log, "klippy.log", options);
  EXPECT_EQ(hot.table.line.size(), 4u);
  EXPECT_EQ(hot.table.numbers("Z").front(), 60);
  EXPECT_TRUE(hot.surveys.empty());
}

TEST(PrinterFile, PointsOfAHeightMapHaveItsSpacing) {
  const std::string map =
      "RepRapFirmware height map file "
      "v2\naxis0,axis1,min0,max0,min1,max1,radius,spacing0,spacing1,num0,num1\n"
      "X,Y,20.00,180.00,0.00,0.00,-1.00,50.00,50.00,4,1\n0.1,0.2,0.3,0.4\n";
  PrinterOptions nozzle;
  nozzle.offset_mm = {0, 0};
  EXPECT_EQ(read(map, nozzle),
            "X[mm],Y[mm],Z[mm],on\n20,0,0.1,bed\n70,0,0.2,bed\n120,0,0.3,bed\n170,0,0.4,bed\n");
  std::string wrong = map;
  wrong.replace(wrong.find("50.00,50.00"), 5, "90.00");
  EXPECT_THAT(read(wrong, nozzle), HasSubstr("reach beyond the maximum"));
}

TEST(PrinterFile, AMeshThatWouldBeMirroredIsRefused) {
  std::string text = kConfiguration;
  text.replace(text.find("min_x = 20.0"), 12, "min_x = 240.0");
  EXPECT_THAT(read(text), HasSubstr("\"min_x\": the smallest position 240 is larger than the largest"));
}

TEST(PrinterFile, TwoProbesOfDifferentOffsetsAreRefused) {
  const std::string second = "[probe]\nx_offset: 5\n\n";
  EXPECT_THAT(read(second + kConfiguration), HasSubstr("the sections [bltouch] and [probe] give different"));
  PrinterOptions options;
  options.offset_mm = {0, 0};
  EXPECT_THAT(read(second + kConfiguration, options), testing::StartsWith("X[mm],Y[mm],Z[mm],on\n20,30,"));
}

TEST(PrinterFile, HeightMapsOfBothVersions) {
  const std::string title = "RepRapFirmware height map file v2 generated at 2026-01-01 00:00\n";
  const std::string present =
      title +
      "axis0,axis1,min0,max0,min1,max1,radius,spacing0,spacing1,num0,num1\n"
      "X,Y,5.00,25.00,5.00,15.00,-1.00,10.00,10.00,3,2\n  0.100, -0.050,  0.000\n -0.000,  0.200,      0\n";
  PrinterOptions nozzle;
  nozzle.offset_mm = {0, 0};
  EXPECT_EQ(read(present, nozzle),
            "X[mm],Y[mm],Z[mm],on\n5,5,0.1,bed\n15,5,-0.05,bed\n25,5,0,bed\n5,15,-0,bed\n15,15,0.2,bed\n");
  EXPECT_EQ(read_printer_file(present, "h.csv", nozzle).not_probed, 1U);
  EXPECT_EQ(
      read(title + "xmin,xmax,ymin,ymax,radius,xspacing,yspacing,xnum,ynum\n0,10,0,0,-1,10,10,2,1\n0.1,0.2\n",
           nozzle),
      "X[mm],Y[mm],Z[mm],on\n0,0,0.1,bed\n10,0,0.2,bed\n");
  EXPECT_THAT(read(title + "axis0\nX\n", nozzle), HasSubstr("lacks this value"));
  EXPECT_THAT(read(present.substr(0, present.size() - 26), nozzle), HasSubstr("fewer than the 2 rows"));
}

/// A log of touches with the configuration of 3 x 2 points; the survey ends if `end` is true.
std::string survey(std::size_t points, bool end) {
  std::string text;
  for (std::size_t i = 0; i < points; ++i)
    text += "probe at " + std::to_string(10 + 50 * (i % 3)) + "," + std::to_string(20 + 60 * (i / 3)) +
            " is z=0.1\n";
  return text + (end ? "Mesh Bed Leveling Complete\n" : "");
}

std::string notes(const std::string& text, const PrinterOptions& options = {}) {
  std::string all;
  for (const std::string& note : read_printer_file(text, "p.log", options).notes) all += note + "\n";
  return all;
}

TEST(PrinterFile, IncompleteAndRepeatedSurveysAreNoted) {
  PrinterOptions all;
  all.series = PrinterOptions::Survey::kAll;
  const std::string configuration = "[bed_mesh]\nprobe_count: 3,2\n";
  EXPECT_EQ(notes(configuration + survey(6, true)), "");
  EXPECT_THAT(notes(configuration + survey(5, false)),
              HasSubstr("has 5 of 6 points: the log may end before"));
  EXPECT_THAT(notes(survey(6, true) + survey(4, true), all),
              HasSubstr("survey 2 (from line 8) has 4 of 6 points;"));
  EXPECT_THAT(
      notes(survey(4, false) + survey(6, true)),
      HasSubstr("line 5: the survey that began in line 1 begins again at its first point: the 4 touches"));
}

TEST(PrinterFile, TheOtherMeshesOfAFileAreNamed) {
  const std::string other =
      "#*# [bed_mesh PETG]\n#*# points =\n#*# \t1, 2\n#*# x_count = 2\n#*# y_count = 1\n"
      "#*# min_x = 0\n#*# max_x = 10\n#*# min_y = 5\n#*# max_y = 5\n";
  EXPECT_THAT(notes(kConfiguration + other),
              HasSubstr("2 saved meshes (PETG, default), and \"default\" is read"));
  EXPECT_EQ(notes(kConfiguration), "");
  PrinterOptions options;
  options.profile = "PETG";
  EXPECT_EQ(notes(kConfiguration + other, options), "");
}

}  // namespace
}  // namespace vernier::printer_file_test
