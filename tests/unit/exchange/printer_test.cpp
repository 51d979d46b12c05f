// SPDX-License-Identifier: GPL-3.0-or-later
// Files for the firmwares of printers: their numbers, read back and applied by the firmware's own formula,
// remove the error of the chain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tools/exchange/left_out.h"
#include "tools/exchange/printer/correction.h"
#include "tools/exchange/printer/firmware_files.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::printer_test {

using namespace vernier::exchange;
using namespace vernier::model;
namespace {

/// Squareness in all three planes, a scale of X, and a bed whose height follows both axes.
const char* const kPrinter = R"xml(<machine name="printer"><variables><static>
    <EC0Y value="0.1" nominal="0" unit="deg"/><EA0Z value="-0.07" nominal="0" unit="deg"/>
    <EB0Z value="0.05" nominal="0" unit="deg"/><s value="0.0008" nominal="0" unit="1"/>
    <h value="0.05" nominal="0" unit="mm"/></static>
  <machineaxes><X min="0" max="200"/><Y min="-10" max="180"/><Z min="0" max="150"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X+s*X"/><sixdof n="2" rZ="EC0Y"/>
  <sixdof n="3" Y="Y" Z="h*sin(X/27)*cos(Y/300)"/>
  <sixdof n="4" rX="EA0Z" rY="EB0Z"/><sixdof n="5" Z="Z"/></transforms></machine>)xml";

Machine printer() { return parse_machine(kPrinter, "printer.xml"); }

States at_rest(const Machine& machine) { return make_states(1, machine); }

/// Positions of the tool point at commands of X, Y and Z.
Eigen::Vector3d point(const Machine& machine, const Eigen::Vector3d& command) {
  States states = make_states(1, machine);
  for (std::size_t i = 0; i < 3; ++i) states.axis[i][0] = command[static_cast<Eigen::Index>(i)];
  return forward(machine, states).position.col(0);
}

/// "key = 1.5" and "key: 1.5" of a Klipper file, and the rows of its points.
struct KlipperFile {
  std::map<std::string, double> value;
  std::vector<std::vector<double>> points;
  explicit KlipperFile(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("#") || line.starts_with("[")) continue;
      const std::size_t equals = line.find(" = ");
      if (equals != std::string::npos) {
        if (const auto number = text::parse_number(line.substr(equals + 3)))
          value[line.substr(0, equals)] = *number;
      } else if (line.starts_with("\t")) {
        points.emplace_back();
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, ',');) points.back().push_back(std::stod(cell));
      }
    }
  }
  /// klippy/extras/skew_correction.py, calc_skew; then bed_mesh.py, without fade.
  Eigen::Vector3d moved(const Eigen::Vector3d& p) const {
    const double xy = value.at("xy_skew"), xz = value.at("xz_skew"), yz = value.at("yz_skew");
    Eigen::Vector3d q(p[0] - p[1] * xy - p[2] * (xz - xy * yz), p[1] - p[2] * yz, p[2]);
    q[2] += height(q[0], q[1]);
    return q;
  }
  double height(double x, double y) const {
    const auto share = [&](double at, const char* low, const char* high, std::size_t count) {
      const double s =
          (at - value.at(low)) / (value.at(high) - value.at(low)) * static_cast<double>(count - 1);
      return std::min(std::max(s, 0.0), static_cast<double>(count - 1) - 1e-9);
    };
    const double u = share(x, "min_x", "max_x", points[0].size()),
                 v = share(y, "min_y", "max_y", points.size());
    const auto i = static_cast<std::size_t>(u), j = static_cast<std::size_t>(v);
    const double a = u - static_cast<double>(i), b = v - static_cast<double>(j);
    return (1 - b) * ((1 - a) * points[j][i] + a * points[j][i + 1]) +
           b * ((1 - a) * points[j + 1][i] + a * points[j + 1][i + 1]);
  }
};

TEST(PrinterFiles, OfKlipperRemoveSkewAndHeightsByItsOwnFormulas) {
  Machine machine = printer();
  machine.statics[*machine.find_static("s")].value = 0;
  const ThreeAxes axes = three_axes(machine);
  PrinterCorrection correction =
      printer_correction(machine, axes, features_of(Firmware::kKlipper, {}), at_rest(machine), 1);
  const KlipperFile file(firmware_files(Firmware::kKlipper, {}, "printer", correction).at(0).text);
  EXPECT_NEAR(file.value.at("xy_skew"), std::tan(0.1 / 57.29578) * -1, 2e-5);
  const Machine ideal = nominal_machine(machine);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> x(0, 200), y(-10, 180), z(0, 150);
  // Homing sets the offset: compared with the middle of the bed.
  const Eigen::Vector3d middle(100, 85, 0);
  const Eigen::Vector3d offset = point(machine, file.moved(middle)) - point(ideal, middle);
  double largest = 0, before = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(x(random), y(random), z(random));
    largest = std::max(largest, (point(machine, file.moved(p)) - point(ideal, p) - offset).norm());
    before = std::max(before, (point(machine, p) - point(ideal, p)).norm());
  }
  EXPECT_GT(before, 0.2);
  EXPECT_LT(largest, 0.004);  // second order of 0.1 deg over 200 mm, and 1 um between the points
}

/// The record of a fit that did not determine these statics: their standard uncertainty is 0.01 rad.
Machine not_measured(const std::vector<std::string>& statics) {
  Machine machine = printer();
  const auto n = static_cast<Eigen::Index>(statics.size());
  auto record = std::make_shared<FitRecord>();
  record->parameters = statics;
  record->open = Eigen::MatrixXd::Identity(n, n) * 0.6;  // deg
  record->open_known = true;
  machine.fitted = record;
  return machine;
}

TEST(PrinterFiles, ASquarenessThatWasNotMeasuredIsNotWritten) {
  const auto files = [](const Machine& machine, Firmware firmware, PrinterCorrection& correction) {
    correction =
        printer_correction(machine, three_axes(machine), features_of(firmware, {}), at_rest(machine), 1);
    return firmware_files(firmware, {}, "printer", correction).at(0).text;
  };
  PrinterCorrection correction;
  const Machine none = not_measured({"EC0Y", "EA0Z", "EB0Z"});
  for (const auto& [firmware, word] :
       {std::pair(Firmware::kKlipper, "xy_skew"), std::pair(Firmware::kRepRap, "M556"),
        std::pair(Firmware::kMarlin, "M852")}) {
    EXPECT_NE(files(printer(), firmware, correction).find(word), std::string::npos) << word;
    EXPECT_TRUE(correction.unmeasured.empty());
    EXPECT_EQ(files(none, firmware, correction).find(word), std::string::npos) << word;
    ASSERT_EQ(correction.unmeasured.size(), 3u);
  }
  EXPECT_EQ(correction.unmeasured[0].name, "XY");
  EXPECT_NEAR(correction.unmeasured[0].std, 0.6 / 57.29578, 1e-3);
  EXPECT_NEAR(correction.unmeasured[0].um, 190 * 0.6 / 57.29578 * 1000, 200);
  // One of three: its value is 0, the others are those of the machine.
  const KlipperFile one(files(not_measured({"EC0Y"}), Firmware::kKlipper, correction));
  EXPECT_EQ(one.value.at("xy_skew"), 0);
  EXPECT_NEAR(one.value.at("yz_skew"), std::tan(0.07 / 57.29578), 2e-5);
  ASSERT_EQ(correction.unmeasured.size(), 1u);
}

/// What no reading determines takes its value nearest zero: a skew that is open to a third is written too
/// small by about as much (a square and a bed in one fit of all errors: 12 %).
TEST(PrinterFiles, APartThatIsOpenToMoreThanATenthIsNotWritten) {
  const auto unmeasured = [](double share, bool size_known) {
    Machine machine = not_measured({"EC0Y"});
    auto record = std::make_shared<FitRecord>(*machine.fitted);
    record->open = Eigen::MatrixXd::Constant(1, 1, 0.1 * share);  // deg, of 0.1 deg
    machine.fitted = record;
    PrinterFeatures features = features_of(Firmware::kKlipper, {});
    features.steps = true;
    features.size_known = size_known;
    std::vector<std::string> names;
    for (const UnmeasuredPart& one :
         printer_correction(machine, three_axes(machine), features, at_rest(machine), 1).unmeasured)
      names.push_back(one.name);
    return names;
  };
  using Names = std::vector<std::string>;
  const Names of_y_and_z = unmeasured(0.05, true);  // scales that the machine file does not have
  EXPECT_EQ(std::count(of_y_and_z.begin(), of_y_and_z.end(), "XY"), 0);
  EXPECT_EQ(std::count(of_y_and_z.begin(), of_y_and_z.end(), "X"), 0);
  const Names third = unmeasured(0.3, true);
  EXPECT_EQ(std::count(third.begin(), third.end(), "XY"), 1);
  // Distances without a known size give no scale, whatever value the fit left.
  const Names without_size = unmeasured(0.05, false);
  EXPECT_EQ(std::count(without_size.begin(), without_size.end(), "X"), 1);
  EXPECT_EQ(std::count(without_size.begin(), without_size.end(), "XY"), 0);
}

TEST(PrinterErrors, AreThoseOfTheChainWithTheFiles) {
  const Machine machine = printer();
  const ThreeAxes axes = three_axes(machine);
  for (const Firmware firmware : {Firmware::kKlipper, Firmware::kRepRap, Firmware::kMarlin}) {
    const PresentSetting present{std::array<double, 3>{80, 80, 400}};
    PrinterCorrection correction =
        printer_correction(machine, axes, features_of(firmware, present), at_rest(machine), 1);
    firmware_files(firmware, present, machine.name, correction);
    const PrinterErrors errors = printer_errors(machine, axes, correction, at_rest(machine));
    EXPECT_GT(errors.rms_before_um, 100);
    EXPECT_LT(errors.rms_after_um, 2);  // digits of the files: 1 um of height
  }
}

TEST(PrinterErrors, ScaleStaysWithoutThePresentSteps) {
  const Machine machine = printer();
  const ThreeAxes axes = three_axes(machine);
  PrinterCorrection correction =
      printer_correction(machine, axes, features_of(Firmware::kMarlin, {}), at_rest(machine), 1);
  const std::string text = firmware_files(Firmware::kMarlin, {}, "printer", correction).at(0).text;
  EXPECT_EQ(text.find("M92"), std::string::npos);
  const PrinterErrors errors = printer_errors(machine, axes, correction, at_rest(machine));
  EXPECT_NEAR(errors.after_um[0], 0.0008 * 100 * 1000, 3);  // half of the travel to each side of the middle
}

/// The bed bows by 2 um per K: the files of one temperature do not hold that of another one.
TEST(PrinterErrors, OfATemperatureAreStatedAtTheEndsOfItsRange) {
  const Machine machine = parse_machine(R"xml(<machine name="warm"><variables>
  <static><k value="0.002" nominal="0"/><grow value="0.01" nominal="0"/></static>
  <machineaxes><X min="0" max="200"/><Y min="0" max="200"/><Z min="0" max="150"/></machineaxes>
  <inputs><T_bed unit="degC" reference="20" min="20" max="60"/></inputs></variables>
  <transforms branch="tool"><sixdof n="1" X="X" Y="Y"/>
  <sixdof n="2" Z="Z+(T_bed-20)*(grow+k*(X-100)*(X-100)/10000)"/></transforms></machine>)xml",
                                        "warm.xml");
  const ThreeAxes axes = three_axes(machine);
  const PrinterCorrection correction =
      printer_correction(machine, axes, features_of(Firmware::kKlipper, {}), at_rest(machine), 1);
  const std::vector<LeftOut> left = errors_of_inputs(machine, axes, correction, at_rest(machine), {});
  ASSERT_EQ(left.size(), 1U);  // at 20 degC nothing changes
  EXPECT_NE(left[0].what.find("the files hold T_bed = 20 degC, and not T_bed = 60 degC"), std::string::npos)
      << left[0].what;
  // 80 um between the middle and the edge, whose mean is 26.7 um; homing removes the growth.
  EXPECT_NEAR(left[0].um, 80 - 80.0 / 3, 2);
}

TEST(PrinterLostMotion, IsInTheFilesOfFirmwareThatHasACommandForIt) {
  // GIVEN X falls short by 8 um in both directions (the twentieth part more at its end), and Y goes too far
  const Machine machine = parse_machine(R"xml(<machine name="lost"><variables>
  <static><b value="-0.008" nominal="0"/><s value="1e-4" nominal="0"/></static>
  <machineaxes><X min="0" max="200"/><Y min="0" max="200"/><Z min="0" max="150"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X+b*dirX*(1+(X-100)/2000)+s*Y" Y="Y-b*dirY"/>
  <sixdof n="2" Z="Z"/></transforms></machine>)xml",
                                        "lost.xml");
  const ThreeAxes axes = three_axes(machine);
  const auto text_of = [&](Firmware firmware) {
    PrinterCorrection correction =
        printer_correction(machine, axes, features_of(firmware, {}), at_rest(machine), 1);
    return firmware_files(firmware, {}, machine.name, correction).front().text;
  };
  EXPECT_NE(text_of(Firmware::kMarlin).find("\nM425 F1 X0.0160 ; lost motion"), std::string::npos)
      << text_of(Firmware::kMarlin);
  EXPECT_NE(text_of(Firmware::kRepRap).find("\nM425 X0.0160 ; lost motion"), std::string::npos);
  EXPECT_EQ(text_of(Firmware::kKlipper).find("M425"), std::string::npos);
  // THEN what changes along the axis stays, and the axis that goes too far is left out
  const std::vector<LeftOut> left = beyond_straight_axes(machine, at_rest(machine), true, {0.016, 0, 0});
  ASSERT_GE(left.size(), 2U);
  EXPECT_EQ(left[0].what, "change along the axis of the reversal error of X");
  EXPECT_NEAR(left[0].um, 0.8, 0.01);
  EXPECT_EQ(left.back().what, "reversal error (backlash) of Y");
  EXPECT_NEAR(left.back().um, 16, 0.1);
}

TEST(PrinterErrors, OfKindsThatAPrinterCannotCorrectAreNamed) {
  const Machine machine = parse_machine(R"xml(<machine name="kinds"><variables>
  <static><b value="0.008" nominal="0"/><w value="0.003" nominal="0"/><s value="0.01" nominal="0"/></static>
  <machineaxes><X min="0" max="200"/><Y min="0" max="200"/><Z min="0" max="150"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X+b*dirX+w*sin(36*X)" Y="Y+s*(X-100)*(X-100)/10000"/>
  <sixdof n="2" Z="Z"/></transforms></machine>)xml",
                                        "kinds.xml");
  const std::vector<LeftOut> left = beyond_straight_axes(machine, at_rest(machine), true);
  ASSERT_EQ(left.size(), 3U);
  EXPECT_EQ(left[0].what, "reversal error (backlash) of X");
  EXPECT_NEAR(left[0].um, 16, 0.1);
  EXPECT_EQ(left[1].what, "positioning error of X that is no scale (lead error, cyclic error)");
  EXPECT_NEAR(left[1].um, 3, 0.3);
  EXPECT_EQ(left[2].what, "error along Y over the travel of X that is no squareness (straightness)");
  EXPECT_NEAR(left[2].um, 20.0 / 3, 0.5);  // a parabola of 10 um beside the best straight line
  // Squareness, scale and a bed that follows both axes are in the files.
  EXPECT_TRUE(beyond_straight_axes(printer(), at_rest(printer()), true).empty());
}

TEST(KlipperFiles, OfTwoProfilesHaveTwoNames) {
  const Machine machine = printer();
  for (const std::string name : {"vernier_20", "vernier_60"}) {
    PresentSetting present;
    present.profile = name;
    PrinterCorrection correction = printer_correction(
        machine, three_axes(machine), features_of(Firmware::kKlipper, present), at_rest(machine), 1);
    const ConfigurationFile file = firmware_files(Firmware::kKlipper, present, "printer", correction).at(0);
    EXPECT_EQ(file.name, name + ".cfg");
    for (const std::string& words : {"[bed_mesh " + name + "]\n", "[skew_correction " + name + "]\n",
                                     "[include " + name + ".cfg]", "BED_MESH_PROFILE LOAD=" + name + "."})
      EXPECT_NE(file.text.find(words), std::string::npos) << words;
  }
}

/// A printer without errors whose last fit touched a bed that falls 1 mm in 1000 along X and rises 2 along Y.
/// `workpiece`: the bed moves along Z, so that the tool point rises over the bed as Z falls.
Machine over_a_bed(const std::string& planes, bool workpiece = false) {
  const std::string z =
      workpiece ? "</transforms><transforms branch=\"workpiece\"><sixdof n=\"1\" Z=\"Z\"/></transforms>"
                : "<sixdof n=\"3\" Z=\"Z\"/></transforms>";
  return parse_machine(
      R"xml(<machine name="bed"><variables>
  <machineaxes><X min="0" max="200"/><Y min="0" max="180"/><Z min="0" max="150"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X"/><sixdof n="2" Y="Y"/>)xml" +
          z + "<fitted><measured><X min=\"20\" max=\"160\"/><Y min=\"30\" max=\"170\"/></measured>" + planes +
          "</fitted></machine>",
      "bed.xml");
}
const char* const kBed = R"(<plane name="bed" x="50" y="50" z="7" nx="0.001" ny="-0.002" nz="1"/>)";

TEST(PrinterBed, HeightsFollowItsSlopeWhereItWasTouched) {
  for (const bool workpiece : {false, true}) {
    const Machine machine = over_a_bed(kBed, workpiece);
    const ThreeAxes axes = three_axes(machine);
    const std::optional<Bed> bed = bed_of(machine, axes, "");
    ASSERT_TRUE(bed.has_value());
    PrinterCorrection correction =
        printer_correction(machine, axes, features_of(Firmware::kKlipper, {}), at_rest(machine), 1, bed);
    const KlipperFile file(firmware_files(Firmware::kKlipper, {}, "bed", correction).at(0).text);
    EXPECT_DOUBLE_EQ(file.value.at("min_x"), 20);
    EXPECT_DOUBLE_EQ(file.value.at("max_y"), 170);
    const double sign = workpiece ? -1 : 1;
    EXPECT_NEAR(file.height(160, 30) - file.height(20, 30), sign * -0.14, 1e-6);
    EXPECT_NEAR(file.height(20, 170) - file.height(20, 30), sign * 0.28, 1e-6);
    const PrinterErrors errors = printer_errors(machine, axes, correction, at_rest(machine), bed);
    EXPECT_GT(errors.rms_before_um, 50);
    EXPECT_LT(errors.rms_after_um, 0.01);
    // Beyond the mesh, up to 40 mm in X and 30 mm in Y, the end values are held.
    EXPECT_NEAR(errors.beyond_bed_um, 40 * 1 + 30 * 2, 40);
  }
}

/// A simulated printer: a beam that turns about Y over the travel of Y and sags, an X carriage that rolls
/// about X, a bed with a bow and a wave, and a probe beside the nozzle.
struct ProbedPrinter {
  static constexpr std::array<double, 2> kOffset = {-30, 20};
  double roll = 0.0008;  // of the carriage about X at the ends of its travel, rad

  static double bed(double x, double y) {
    const auto arch = [](double at) { return 1 - (at - 110) * (at - 110) / 12100; };
    return 0.001 * x + 0.15 * arch(x) * arch(y) + 0.03 * std::sin(x / 15) * std::cos(y / 17);
  }
  /// Height of a point at `offset` beside the nozzle above its nominal height.
  double error(double x, double y, const std::array<double, 2>& offset) const {
    const double turn = 0.0014 * (y - 110) / 220;
    return -0.15 * (1 - (x - 110) * (x - 110) / 12100) - turn * (x + offset[0]) +
           roll * (x - 110) / 110 * offset[1];
  }
  /// Row of a measurement: the axes when the probe, or the nozzle, touches the bed at x and y.
  std::string row(double x, double y, bool of_probe, const char* role = "") const {
    const std::array<double, 2> offset = of_probe ? kOffset : std::array<double, 2>{};
    const double ax = x - offset[0], ay = y - offset[1];
    const double z = bed(x, y) - error(ax, ay, offset);
    std::ostringstream text;
    text << std::fixed << ax << ',' << ay << ',' << z << ',' << offset[0] << ',' << offset[1] << ",bed,"
         << role << '\n';
    return text.str();
  }
  /// A survey of 19 x 19 touches of the probe.
  std::string mesh() const {
    std::string text = "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on,role\n";
    for (int j = 0; j < 19; ++j)
      for (int i = 0; i < 19; ++i) text += row(10 + 170 * i / 18.0, 25 + 185 * j / 18.0, true);
    return text;
  }
  /// Largest error of the nozzle's height between the stations, without a constant offset, um; `slope`:
  /// without the slope too.
  double largest_um(const KlipperFile& file, bool slope = false) const {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> x(25, 170), y(35, 200);
    Eigen::VectorXd off(500);
    Eigen::MatrixXd plane(500, 3);
    for (Eigen::Index i = 0; i < off.size(); ++i) {
      const double ax = x(random), ay = y(random);
      off[i] = 1000 * (file.height(ax, ay) + error(ax, ay, {}) - bed(ax, ay));
      plane.row(i) << 1, ax, ay;
    }
    if (!slope) plane.rightCols(2).setZero();
    const Eigen::VectorXd fitted = plane * maths::least_norm(plane, off);
    return (off - fitted).cwiseAbs().maxCoeff();
  }
};

/// The machine of the survey; `sag` and `twist` as a fit gives them.
Machine probed_machine(double twist_deg, double sag) {
  std::ostringstream text;
  text << R"xml(<machine name="printer"><variables><static><twist value=")xml" << twist_deg
       << R"xml(" nominal="0" unit="deg"/><sag value=")xml" << sag << R"xml(" nominal="0" unit="mm"/></static>
  <machineaxes><X min="0" max="220"/><Y min="0" max="220"/><Z min="0" max="250"/></machineaxes>
  <inputs><probeX unit="mm" reference="0"/><probeY unit="mm" reference="0"/></inputs>
  <artefact name="bed" type="plane"/></variables><transforms branch="tool">
  <sixdof n="1" Y="Y" Z="Z" rY="twist*(Y-110)/220"/><sixdof n="2" X="X" Z="sag*(1-(X-110)*(X-110)/12100)"/>
  <sixdof n="3" X="probeX" Y="probeY"/></transforms>
  <fitted><measured><X min="40" max="210"/><Y min="5" max="190"/>
  <probeX min="-30" max="-30"/><probeY min="20" max="20"/></measured>
  <plane name="bed" x="100" y="100" z="0" nx="0" ny="0" nz="1"/></fitted></machine>)xml";
  return parse_machine(text.str(), "printer.xml");
}

KlipperFile mesh_of_touches(const Machine& machine, const std::string& touches, BedShape* shape = nullptr) {
  const ThreeAxes axes = three_axes(machine);
  std::optional<Bed> bed = bed_of(machine, axes, "");
  if (!touches.empty()) give_shape(*bed, machine, axes, parse_measurement(touches, "bed.csv", machine));
  if (shape != nullptr) *shape = *bed->shape;
  PrinterCorrection correction =
      printer_correction(machine, axes, features_of(Firmware::kKlipper, {}), at_rest(machine), 1, bed);
  return KlipperFile(firmware_files(Firmware::kKlipper, {}, "bed", correction).at(0).text);
}

TEST(PrinterBedShape, IsRightAtTheNozzleWhereAnOffsetProbeTouched) {
  ProbedPrinter printer;
  printer.roll = 0;
  const Machine machine = probed_machine(0.0014 * 57.29578, -0.15);
  const KlipperFile plane = mesh_of_touches(machine, ""), shaped = mesh_of_touches(machine, printer.mesh());
  EXPECT_GT(printer.largest_um(plane, true), 60);  // the bow of the bed remains
  // Spline between stations 10 mm apart of a wave of 94 mm, and bilinear cells of the mesh.
  EXPECT_LT(printer.largest_um(shaped), 3);
}

TEST(PrinterBedShape, TouchesOfTheNozzleGiveWhatTheProbeDoesNotShow) {
  const ProbedPrinter printer;
  // The fit took a part of the bow for the sag of the beam, and does not know the roll.
  const Machine machine = probed_machine(0.0014 * 57.29578, -0.05);
  BedShape alone({BedTouch{{0, 0, 0}, {0, 0, 0}, {}, false}, BedTouch{{9, 0, 0}, {9, 0, 0}, {}, false},
                  BedTouch{{0, 9, 0}, {0, 9, 0}, {}, false}}),
      with = alone;
  const std::string mesh = printer.mesh();
  const double before = printer.largest_um(mesh_of_touches(machine, mesh, &alone));
  EXPECT_GT(before, 20);
  EXPECT_GT(alone.undetermined_um, before);  // the stated size is a bound
  std::string touches = mesh;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) touches += printer.row(20 + 75 * i, 35 + 80 * j, false);
  for (int i = 0; i < 12; ++i) touches += printer.row(25 + 13 * i, 40 + 71 * i % 160, false, "check");
  const KlipperFile file = mesh_of_touches(machine, touches, &with);
  EXPECT_LT(printer.largest_um(file), 3);
  EXPECT_EQ(with.by_nozzle, 9U);
  EXPECT_EQ(with.checks, 12U);
  EXPECT_LT(with.check_rms_um, 2);
  EXPECT_EQ(with.undetermined_um, 0);
}

TEST(PrinterBedShape, OfAPlaneIsTheRegionOfTheTouchedPoints) {
  const Machine machine = probed_machine(0, 0);
  std::string text = "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on\n";
  const std::optional<Bed> bed = bed_of(machine, three_axes(machine), "");
  EXPECT_DOUBLE_EQ(bed->low[0], 10);
  EXPECT_DOUBLE_EQ(bed->high[0], 180);
  EXPECT_DOUBLE_EQ(bed->low[1], 25);
  EXPECT_DOUBLE_EQ(bed->high[1], 210);
  EXPECT_THROW(mesh_of_touches(machine, text + "40,5,0,-30,20,bed\n50,5,0,-30,20,bed\n"), text::InputError);
}

// The bed is 0.25 mm above the zero of Z, and 0.05 mm more at large X: so are the heights.
TEST(PrinterBedShape, KeepsTheZeroOfTheTouches) {
  std::ostringstream text;
  text << "X[mm],Y[mm],Z[mm],probeX[mm],probeY[mm],on\n";
  for (int x = 20; x <= 180; x += 40)
    for (int y = 30; y <= 190; y += 40)
      text << x << ',' << y << ',' << 0.25 + 0.05 * (x - 20) / 160 << ",0,0,bed\n";
  const KlipperFile file = mesh_of_touches(probed_machine(0, 0), text.str());
  EXPECT_NEAR(file.points.front().front(), 0.25, 1e-5);
  EXPECT_NEAR(file.points.back().back(), 0.30, 1e-5);
}

TEST(PrinterBed, IsTheNamedPlaneOrTheOnlyOne) {
  const auto said = [](const std::string& planes, const std::string& name) {
    const Machine machine = over_a_bed(planes);
    try {
      const std::optional<Bed> bed = bed_of(machine, three_axes(machine), name);
      return bed ? bed->name : std::string("none");
    } catch (const text::InputError& error) {
      return std::string(error.what());
    }
  };
  const std::string second = R"(<plane name="glass" x="0" y="0" z="1" nx="0" ny="0" nz="1"/>)";
  EXPECT_EQ(said("", ""), "none");
  EXPECT_EQ(said(kBed + second, "glass"), "glass");
  EXPECT_NE(said(kBed + second, "").find("several planes (bed, glass)"), std::string::npos);
  EXPECT_NE(said(kBed + second, "wood").find("its planes are bed, glass"), std::string::npos);
  EXPECT_NE(said("", "bed").find("no rows that touch a plane"), std::string::npos);
  EXPECT_NE(
      said(R"(<plane name="wall" x="0" y="0" z="1" nx="1" ny="0" nz="0"/>)", "").find("nearly vertical"),
      std::string::npos);
}

TEST(PrinterFiles, OfGrblHaveTheStepsOfEachAxis) {
  const Machine machine = printer();
  const PresentSetting present{std::array<double, 3>{80, 80, 400}};
  PrinterCorrection correction = printer_correction(
      machine, three_axes(machine), features_of(Firmware::kGrbl, present), at_rest(machine), 1);
  const std::string text = firmware_files(Firmware::kGrbl, present, "printer", correction).at(0).text;
  const std::size_t at = text.find("$100=");
  ASSERT_NE(at, std::string::npos) << text;
  // The carriage goes 0.08 % too far, so that it needs fewer steps.
  EXPECT_NEAR(std::stod(text.substr(at + 5)), 80 / 1.0008, 1e-3);
  EXPECT_EQ(correction.mesh.z.size(), 0);
}

TEST(PrinterFiles, AreOfThreeLinearAxesWithRanges) {
  const auto refused = [](std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    EXPECT_THROW(three_axes(parse_machine(text, "printer.xml")), text::InputError) << to;
  };
  refused(kPrinter, "<Z min=\"0\" max=\"150\"/>", "<Z/>");
  refused(kPrinter, "<Z min=\"0\" max=\"150\"/>",
          "<Z min=\"0\" max=\"150\"/><C rotary=\"true\" min=\"0\" max=\"360\"/>");
}

TEST(HeightMesh, HoldsItsEndsAndIsLinearBetweenItsPoints) {
  HeightMesh mesh{0, 10, 0, 20, {}};
  mesh.z.resize(2, 2);
  mesh.z << 1, 2, 3, 5;
  EXPECT_DOUBLE_EQ(mesh.at(0, 0), 1);
  EXPECT_DOUBLE_EQ(mesh.at(10, 0), 2);
  EXPECT_DOUBLE_EQ(mesh.at(0, 20), 3);
  EXPECT_DOUBLE_EQ(mesh.at(5, 10), 2.75);
  EXPECT_DOUBLE_EQ(mesh.at(11, 21), 5);
  EXPECT_DOUBLE_EQ(mesh.at(-1, -1), 1);
}

}  // namespace
}  // namespace vernier::printer_test
