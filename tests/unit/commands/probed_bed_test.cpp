// SPDX-License-Identifier: GPL-3.0-or-later
// The bed of a printer, touched with a probe beside the nozzle: what improve learns is not confirmed at the
// nozzle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/commands/shell_folder.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::probed_bed_test {

using testing::HasSubstr;
using testing::Not;
namespace {

namespace fs = std::filesystem;

constexpr const char* kMachine = R"xml(<machine name="printer"><variables><static>
  <twist value="0" nominal="0" unit="deg"/></static>
  <machineaxes><X min="0" max="220"/><Y min="0" max="220"/><Z min="0" max="250"/></machineaxes>
  <artefact name="bed" type="plane"/></variables>
  <transforms branch="tool"><sixdof n="1" Y="Y" Z="Z" rY="twist*(Y-110)/220"/><sixdof n="2" X="X"/></transforms></machine>)xml";

constexpr double kU_mm = 0.003;

/// Survey of a bowed bed under a beam that turns about Y by `turn` (rad) over its travel: 240 touches of a
/// probe at (-30, 20) mm, every fifth a check row.
std::string survey(double turn = 0.0014) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> x(10, 180), y(25, 210);
  std::normal_distribution<double> noise(0, kU_mm);
  std::string text = "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on,u[mm],role\n";
  for (int i = 0; i < 240; ++i) {
    const double px = x(random), py = y(random), ax = px + 30, ay = py - 20;
    const double bow = 0.15 * (1 - (px - 110) * (px - 110) / 12100);
    const double z = bow + turn * (ay - 110) / 220 * px + noise(random);
    for (const double value : {ax, ay, z}) text += text::number_text(std::round(value * 1e5) / 1e5) + ",";
    text += i % 5 == 0 ? "-30,20,bed,0.003,check\n" : "-30,20,bed,0.003,fit\n";
  }
  return text;
}

struct ProbedBed : commands_test::ShellFolder {
  ProbedBed() : ShellFolder("probed_bed") {
    text::write_file(folder + "/p.xml", kMachine);
    text::write_file(folder + "/bed.csv", survey());
  }
};

TEST_F(ProbedBed, ImproveAddsNoTermThatCheckRowsOfTheNozzleDoNotConfirm) {
  ASSERT_EQ(run("vernier improve p.xml bed.csv -o out --yes"), 0) << said;
  EXPECT_THAT(said, HasSubstr("verdict: missing-effect"));  // the check rows of the probe confirm the term
  EXPECT_THAT(said, HasSubstr("not added: "));
  EXPECT_THAT(said, HasSubstr("no check row touches it with the tool point"));
  const auto json = nlohmann::json::parse(text::read_file(folder + "/out/improve.json"));
  EXPECT_EQ(json["ladder"].size(), 1U);  // the given machine
  EXPECT_EQ(json["not_confirmed"]["check_rows"], 0);
}

TEST_F(ProbedBed, ALoopThatLeavesMoreThanTheModelSaysWhyAndWhatToDo) {
  // GIVEN an axis Z that may correct a tenth of the bow only, and touches of the tool point itself
  std::string limited = kMachine, touches = survey();
  limited.replace(limited.find("max=\"250\""), 9, "max=\"250\" maxcorrection=\"0.02\"");
  for (std::size_t at = 0; (at = touches.find(",-30,20,", at)) != std::string::npos;)
    touches.replace(at, 8, ",0,0,");
  text::write_file(folder + "/limited.xml", limited);
  text::write_file(folder + "/tip.csv", touches);
  ASSERT_EQ(run("vernier improve limited.xml tip.csv -o out --yes"), 0) << said;
  EXPECT_THAT(said, HasSubstr("the loop leaves "));
  EXPECT_THAT(said, HasSubstr("the correction is at its limit in "));
  EXPECT_THAT(said, HasSubstr("raise maxcorrection of the axes"));
  const auto json = nlohmann::json::parse(text::read_file(folder + "/out/improve.json"));
  EXPECT_TRUE(json["loop"].back().contains("note"));
  EXPECT_EQ(json["simulation"]["note"], json["loop"].back()["note"]);  // the page shows it
  // Without the limit there is nothing to say.
  ASSERT_EQ(run("vernier improve p.xml tip.csv -o out --yes"), 0) << said;
  EXPECT_THAT(said, Not(HasSubstr("the loop leaves ")));
}

TEST_F(ProbedBed, AReversalHasOneValueInFitAndDiagnose) {
  // GIVEN a reversal value of 12 um: the coefficient of dirX is 6 um
  text::write_file(
      folder + "/x.xml",
      R"xml(<machine name="x"><variables><machineaxes><X min="0" max="100"/></machineaxes></variables>
  <transforms><sixdof X="X"/></transforms></machine>)xml");
  std::string rows = "X[mm],dirX,x[mm],u[mm]\n";
  for (int run = 0; run < 3; ++run)
    for (int x = 0; x <= 100; x += 10)
      for (const int sense : {1, -1})
        rows += std::to_string(x) + "," + std::to_string(sense) + "," +
                std::to_string(x + 0.006 * sense + 0.0003 * ((x / 10 + run) % 3 - 1)) + ",0.0003\n";
  text::write_file(folder + "/x.csv", rows);
  ASSERT_EQ(run("vernier add backlash:axis=X x.xml -o b.xml && vernier fit b.xml x.csv -o f.xml"), 0) << said;
  EXPECT_THAT(said, HasSubstr("coefficient of dirX; reversal value B = 12 um"));
  ASSERT_EQ(run("vernier diagnose x.xml x.csv -o d.html"), 0) << said;
  EXPECT_THAT(said, HasSubstr("(coefficient of dirX; reversal value B = 12 um)"));
  EXPECT_THAT(said, HasSubstr("X carriage: backlash, reversal value B 12.0"));
  ASSERT_EQ(run("vernier effects backlash"), 0) << said;
  EXPECT_THAT(said, HasSubstr("reversal value B = 2 k"));
}

/// A user stated 0.005 (mm) as --u, which is in um: the fit of touches of 5 nm did not converge.
TEST_F(ProbedBed, AnUncertaintyInAnotherUnitIsNamed) {
  text::write_file(
      folder + "/printer.cfg",
      "[stepper_x]\nrotation_distance: 40\n[stepper_y]\nrotation_distance: 40\n"
      "[stepper_z]\nrotation_distance: 8\n[probe]\nx_offset: -30\ny_offset: 20\n"
      "[bed_mesh default]\npoints =\n  0.01, 0.02, 0.03\n  0.02, 0.03, 0.05\n  0.04, 0.05, 0.08\n"
      "x_count = 3\ny_count = 3\nmin_x = 30\nmax_x = 180\nmin_y = 30\nmax_y = 180\n");
  EXPECT_EQ(run("vernier import printer printer.cfg --u 0.005 -o t.csv"), 1) << said;
  EXPECT_THAT(said, HasSubstr("for 0.005 mm state --u 5"));
  EXPECT_EQ(run("vernier import printer printer.cfg --u 5m -o t.csv"), 1) << said;
  EXPECT_THAT(said, HasSubstr("of the form 5 (um), 5um or 0.005mm"));
  ASSERT_EQ(run("vernier import printer printer.cfg --u 5 -o um.csv"), 0) << said;
  EXPECT_THAT(said, HasSubstr("with --steps 40,40,8, export klipper also corrects measured scales"));
  ASSERT_EQ(run("vernier import printer printer.cfg --u 0.005mm -o mm.csv"), 0) << said;
  EXPECT_EQ(text::read_file(folder + "/um.csv").substr(text::read_file(folder + "/um.csv").find("X[mm]")),
            text::read_file(folder + "/mm.csv").substr(text::read_file(folder + "/mm.csv").find("X[mm]")));
}

TEST_F(ProbedBed, AnExistingMachineFileGetsAnArtefact) {
  std::string text = kMachine;
  const std::string bed = "  <artefact name=\"bed\" type=\"plane\"/>";
  text.erase(text.find(bed), bed.size());
  text::write_file(folder + "/none.xml", text);
  ASSERT_EQ(run("vernier set none.xml --artefact bed:plane -o with.xml"), 0) << said;
  EXPECT_THAT(text::read_file(folder + "/with.xml"), HasSubstr("<artefact name=\"bed\" type=\"plane\"/>"));
  EXPECT_EQ(run("vernier fit with.xml bed.csv -o fit.xml"), 0) << said;
  EXPECT_EQ(run("vernier set with.xml --artefact bed:plane -o again.xml"), 1) << said;
  EXPECT_EQ(run("vernier set none.xml --artefact bed:blob -o again.xml"), 1) << said;
  EXPECT_EQ(run("vernier set none.xml -o again.xml"), 1) << said;
}

/// Largest error of an exported mesh against the bow of the survey, without a constant offset, um.
double largest_of_mesh_um(const std::string& text) {
  const auto number = [&](const std::string& name) {
    const std::size_t at = text.find("\n" + name + " = ");
    return std::stod(text.substr(text.find('=', at) + 1));
  };
  const double low = number("min_x"), high = number("max_x");
  const int columns = static_cast<int>(number("x_count"));
  std::istringstream rows(text.substr(text.find("points =")));
  std::string line;
  std::getline(rows, line);
  std::vector<double> off;
  while (std::getline(rows, line) && line.find(',') != std::string::npos) {
    std::istringstream cells(line);
    for (int i = 0; i < columns; ++i) {
      std::string cell;
      std::getline(cells, cell, ',');
      const double x = low + (high - low) * i / (columns - 1);
      off.push_back(1000 * (std::stod(cell) - 0.15 * (1 - (x - 110) * (x - 110) / 12100)));
    }
  }
  const auto [least, most] = std::minmax_element(off.begin(), off.end());
  return off.empty() ? 1e9 : (*most - *least) / 2;
}

TEST_F(ProbedBed, ExportFollowsTheTouchesWhereNothingDistinguishesBedFromAxes) {
  // GIVEN free tables over a bowed bed under straight axes: the fit takes the bow for errors of the axes
  text::write_file(folder + "/bed.csv", survey(0));
  ASSERT_EQ(
      run("vernier new gantry --axis X:0:220 --axis Y:0:220 --axis Z:0:250 --artefact bed:plane -o p.xml && "
          "vernier fit p.xml bed.csv -o fit.xml"),
      0)
      << said;
  EXPECT_THAT(said, HasSubstr("(flatness-assumed)"));
  EXPECT_EQ(run("vernier export klipper fit.xml -o out --accept uncertainty --accept measured-range"), 1)
      << said;
  EXPECT_THAT(said, HasSubstr("--touches FILE"));
  EXPECT_FALSE(fs::exists(folder + "/out"));
  ASSERT_EQ(run("vernier export klipper fit.xml -o out --touches bed.csv --json out.json"), 0) << said;
  EXPECT_THAT(said, HasSubstr("do not distinguish the shape of the bed from the straightness of a carriage"));
  const auto json = nlohmann::json::parse(text::read_file(folder + "/out.json"));
  // At p + (-30, 20) the bow is up to 0.07 mm higher or lower than at p.
  EXPECT_GT(json["bed_shape"]["undetermined_um"], 50);
  EXPECT_EQ(json["bed_shape"]["touches_of_probe"], 192);
  // u is 3 um; the errors of the fitted axes would add 100 um and more.
  EXPECT_LT(largest_of_mesh_um(text::read_file(folder + "/out/vernier.cfg")), 15);
}

// Heights that contain the z_offset of a probe: the printer would print 2.15 mm above the bed.
TEST_F(ProbedBed, HeightsFarFromZeroNeedAWordAboutTheirZero) {
  std::string log;
  for (int i = 0; i < 25; ++i)
    log += "probe at " + std::to_string(50 + 30 * (i % 5)) + "," + std::to_string(50 + 30 * (i / 5)) +
           " is z=2.15" + std::to_string(i % 3) + "\n";
  text::write_file(folder + "/k.log", log);
  text::write_file(folder + "/z.log", "[probe]\nz_offset: 2.150\n" + log);
  ASSERT_EQ(
      run("vernier new gantry --axis X:0:220 --axis Y:0:220 --axis Z:0:250 --artefact bed:plane -o p.xml && "
          "vernier import printer k.log --offset=-38,-8 -o k.csv"),
      0)
      << said;
  EXPECT_THAT(said, HasSubstr("note: the zero of the heights is not known"));
  for (const std::string firmware : {"klipper", "rrf", "marlin"}) {
    EXPECT_EQ(run("vernier export " + firmware + " p.xml --touches k.csv -o out"), 2) << said;
    EXPECT_THAT(said, HasSubstr("have a mean of 2.15"));
    EXPECT_THAT(said, HasSubstr("above the bed; nothing is written"));
    EXPECT_FALSE(fs::exists(folder + "/out"));
  }
  EXPECT_EQ(run("vernier export klipper p.xml --touches k.csv -o middle --zero middle"), 0) << said;
  EXPECT_THAT(said, HasSubstr("0 in the middle of the mesh: set the offset of Z of the printer again"));
  EXPECT_EQ(run("vernier export klipper p.xml --touches k.csv -o touches --zero touches"), 0) << said;
  EXPECT_THAT(said, HasSubstr("(mean height of the mesh 2.15"));
  EXPECT_EQ(run("vernier import printer z.log -o z.csv && vernier export klipper p.xml --touches z.csv -o z"),
            0)
      << said;
  EXPECT_THAT(said, HasSubstr("z_offset 2.150 of [probe] is subtracted from the heights"));
  EXPECT_THAT(said, HasSubstr("(mean height of the mesh 0.00"));
}

/// The standard uncertainty of an angle that no reading determines is that of its scale: as a length over the
/// travel it was printed as an error of 2.5 mm.
TEST_F(ProbedBed, ASquarenessThatNoReadingDeterminesHasNoSizeInTheExport) {
  ASSERT_EQ(
      run("vernier new gantry --axis X:0:235 --axis Y:0:235 --axis Z:0:250 --artefact bed:plane -o g.xml "
          "&& vernier fit g.xml bed.csv -o g.xml"),
      0)
      << said;
  ASSERT_EQ(run("vernier export klipper g.xml -o json --touches bed.csv --json out.json"), 0) << said;
  const auto left = nlohmann::json::parse(text::read_file(folder + "/out.json"))["left_out"];
  for (const auto& one : left)
    EXPECT_EQ(one["um"].is_null(), one["what"].get<std::string>().starts_with("squareness")) << one;
  ASSERT_FALSE(left.empty());
  ASSERT_EQ(run("vernier export klipper g.xml -o out --touches bed.csv"), 0) << said;
  EXPECT_THAT(said, HasSubstr("left out: squareness XY: the readings of the last fit do not determine it"));
  EXPECT_THAT(said, HasSubstr("the files do not contain it: size unknown"));
  EXPECT_THAT(said, Not(HasSubstr("+- 0.0")));
}

/// The distances of a printed square do not show the bow of the bed.
TEST_F(ProbedBed, APrintedSquareBesideTheMeshMakesNoBowOfTheAxes) {
  text::write_file(folder + "/bed.csv", survey(0));
  text::write_file(folder + "/square.csv",
                   "X[mm],Y[mm],Z[mm],distance[mm],from,u[mm]\n30,30,0.2,,,0.02\n200,30,0.2,170,1,0.02\n"
                   "200,200,0.2,240.92,1,0.02\n30,200,0.2,170,1,0.02\n30,200,0.2,239.92,2,0.02\n");
  for (const std::string errors : {"all", "square"}) {
    ASSERT_EQ(run("vernier new gantry --axis X:0:220 --axis Y:0:220 --axis Z:0:250 --artefact bed:plane "
                  "--errors " +
                  errors +
                  " -o p.xml && vernier fit p.xml bed.csv square.csv -o fit.xml && "
                  "vernier export klipper fit.xml -o out --touches bed.csv"),
              0)
        << said;
    EXPECT_THAT(said, HasSubstr("(flatness-assumed)"));
    EXPECT_LT(largest_of_mesh_um(text::read_file(folder + "/out/vernier.cfg")), 15);
  }
  // The square alone: its skew, and no mesh of zeros
  ASSERT_EQ(run("vernier fit p.xml square.csv -o s.xml && vernier export klipper s.xml -o s --accept "
                "measured-range"),
            0)
      << said;
  const std::string text = text::read_file(folder + "/s/vernier.cfg");
  EXPECT_THAT(text, Not(HasSubstr("[bed_mesh")));
  EXPECT_THAT(text, HasSubstr("# Not measured: xz_skew and yz_skew"));
}

/// A machine file with all errors: the fit that the export offers measures what the fit of a machine file
/// with these errors alone measures. Without the yaw of Y (table.Y.rZ) in the list there was no skew.
TEST_F(ProbedBed, TheFitThatAnExportOffersMeasuresTheSquarenessAndBothScales) {
  text::write_file(folder + "/bed.csv", survey(0));
  // Corners at (40, 40) to (190, 190); true x = 1.0021 (X - 0.0016 Y), y = 0.9988 Y.
  text::write_file(folder + "/square.csv",
                   "point,X[mm],Y[mm],Z[mm],distance[mm],from\nA,40,40,0.2,,\nB,190,40,0.2,,\n"
                   "C,190,190,0.2,,\nD,40,190,0.2,,\nA-B,190,40,0.2,150.34,A\nB-C,190,190,0.2,149.84,B\n"
                   "C-D,40,190,0.2,150.32,C\nD-A,40,40,0.2,149.81,D\nA-C,190,190,0.2,212.09,A\n"
                   "B-D,40,190,0.2,212.42,B\n");
  for (const std::string errors : {"all", "square"})
    ASSERT_EQ(run("vernier new gantry --axis X:0:235 --axis Y:0:235 --axis Z:0:250 --artefact bed:plane "
                  "--errors " +
                  errors + " -o " + errors + ".xml && vernier fit " + errors + ".xml square.csv -o " +
                  errors + "-fit.xml && vernier export klipper " + errors + "-fit.xml -o " + errors +
                  " --touches bed.csv --steps 40,40,8 --json " + errors + ".json"),
              0)
        << said;
  const auto offered = nlohmann::json::parse(text::read_file(folder + "/all.json"))["fit_again"];
  ASSERT_EQ(run("vernier fit all.xml square.csv -o all-fit.xml --json fit.json"), 0) << said;
  EXPECT_THAT(said,
              HasSubstr("note: To measure squareness and scales with the distances of a printed square"));
  EXPECT_EQ(nlohmann::json::parse(text::read_file(folder + "/fit.json"))["fit_again"], offered);
  // Held values of an earlier fit are no measurement: a button of the page fitted so, and the skew was a
  // fifth too small.
  ASSERT_EQ(run("vernier fit all-fit.xml square.csv -o junk.xml --hold table.X.X,table.Y.rZ --json fit.json"),
            0)
      << said;
  EXPECT_THAT(said, HasSubstr("at values of an earlier fit that its readings did not determine"));
  // The numbers of another firmware have another meaning.
  EXPECT_EQ(run("vernier export klipper all-fit.xml -o no --touches bed.csv --steps 80,80,400"), 1) << said;
  EXPECT_THAT(said, HasSubstr("these look like steps per mm"));
  EXPECT_EQ(run("vernier export marlin all-fit.xml -o no --touches bed.csv --steps 40,40,8"), 1) << said;
  EXPECT_THAT(said, HasSubstr("these look like the rotation_distance of Klipper"));
  EXPECT_FALSE(nlohmann::json::parse(text::read_file(folder + "/square.json")).contains("fit_again"));
  const auto listed = [&](const char* option) {
    std::string words;
    for (const auto& one : offered[option]) words += (words.empty() ? "" : ",") + one.get<std::string>();
    return fmt::format(" --{} \"{}\"", option, words);
  };
  ASSERT_EQ(run("vernier fit all.xml square.csv -o again.xml" + listed("hold") + listed("free") +
                " && vernier export klipper again.xml -o again --touches bed.csv --steps 40,40,8 --json "
                "again.json"),
            0)
      << said;
  EXPECT_FALSE(nlohmann::json::parse(text::read_file(folder + "/again.json")).contains("fit_again"));
  EXPECT_THAT(said, Not(HasSubstr("note: To measure squareness")));
  const auto number = [&](const std::string& file, const std::string& name, std::size_t which) {
    const std::string text = text::read_file(folder + "/" + file);
    std::size_t at = 0;
    for (std::size_t i = 0; i <= which; ++i) {
      at = text.find("\n" + name, at + (i > 0 ? 1 : 0));
      if (at == std::string::npos) return 0.0;
    }
    return std::stod(text.substr(text.find_first_of("=:", at) + 1));
  };
  // The readings have two decimals over 212 mm: 0.0001 rad.
  constexpr double kReadings = 1e-4;
  EXPECT_NEAR(number("again/vernier.cfg", "xy_skew", 0), -0.0016, kReadings);
  EXPECT_NEAR(number("again/vernier.cfg", "xy_skew", 0), number("square/vernier.cfg", "xy_skew", 0), 1e-6);
  for (const std::size_t axis : {0U, 1U}) {
    const double steps = number("again/vernier_steppers.cfg", "rotation_distance", axis);
    EXPECT_NEAR(steps, number("square/vernier_steppers.cfg", "rotation_distance", axis), 1e-4);
    EXPECT_NEAR(steps / 40, axis == 0 ? 1.0022 : 0.9988, 2 * kReadings);
  }
  // Without the present setting no file can have the scales, and the command says what is missing.
  const std::string way_on =
      "measured): state the present rotation_distance of X, Y and Z with --steps X,Y,Z";
  EXPECT_EQ(said.find(way_on), std::string::npos) << said;
  ASSERT_EQ(run("vernier export klipper again.xml -o without --touches bed.csv"), 0) << said;
  EXPECT_THAT(said, testing::AllOf(HasSubstr("scale X (2"), HasSubstr("scale Y (-1"), HasSubstr(way_on)));
}

TEST_F(ProbedBed, HeightsAtOneTemperatureAreThoseOfOneSurvey) {
  std::istringstream rows(survey());
  std::string heated, line;
  while (std::getline(rows, line)) heated += line + (heated.empty() ? ",T_bed[degC]\n" : ",60\n");
  text::write_file(folder + "/bed.csv", heated);
  ASSERT_EQ(
      run("vernier fit p.xml bed.csv -o fit.xml && vernier export klipper fit.xml -o out --touches bed.csv "
          "--at T_bed=100"),
      1)
      << said;
  EXPECT_THAT(said, HasSubstr("\"T_bed\": this machine has no axis, input or motion quantity of this name"));
  EXPECT_THAT(said, HasSubstr("give with --touches the touches of one survey (vernier import printer LOG "
                              "--series N, or PRINTER.CFG --profile NAME) in the place of --at"));
}

}  // namespace
}  // namespace vernier::probed_bed_test
