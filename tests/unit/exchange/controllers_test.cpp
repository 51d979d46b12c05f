// SPDX-License-Identifier: GPL-3.0-or-later
// Files for controllers of machine tools: their numbers, read back by the rules of the format and applied by
// the controller's formula, remove the error of the chain.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <sstream>

#include "tools/exchange/controller/controller_files.h"
#include "tools/exchange/controller/placing.h"
#include "tools/exchange/controller/tables.h"
#include "tools/model/chain/chain.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/model/parameters.h"
#include "tools/text/error.h"

namespace vernier::controllers_test {

using namespace vernier::exchange;
using namespace vernier::model;
namespace {

/// Positioning and straightness of X (cubic, between stations), backlash of X and Z, squareness, scale of Z.
const char* const kMill = R"xml(<machine name="mill"><variables><static>
    <EC0Y value="0.004" nominal="0" unit="deg"/><s value="0.0001" nominal="0" unit="1"/>
    <revX value="-0.006" nominal="0" unit="mm"/><revZ value="-0.002" nominal="0" unit="mm"/></static>
  <machineaxes><X min="0" max="600"/><Y min="-400" max="0"/><Z min="-300" max="0"/></machineaxes>
  <comptables><table axis="X" interpolation="cubic">
    <station loc="0" X="0" Y="0"/><station loc="150" X="0.02" Y="0.008"/><station loc="300" X="0.011" Y="0.01"/>
    <station loc="450" X="-0.013" Y="0.007"/><station loc="600" X="-0.004" Y="0"/></table></comptables></variables>
  <transforms branch="tool"><sixdof n="1" X="X+lXx+revX*dirX" Y="lXy"/><sixdof n="2" rZ="EC0Y"/>
  <sixdof n="3" Y="Y"/><sixdof n="4" Z="Z+s*Z+revZ*dirZ"/></transforms></machine>)xml";

struct Case {
  Machine machine;
  ThreeAxes axes;
  States at;
  ControllerTables tables;
  std::map<std::string, std::string> files;
};

Case export_of(Controller controller, const char* xml = kMill, double step_mm = 0,
               const ControllerSetting& setting = {}, const std::array<double, 3>& reference = {0, 0, 0}) {
  Case result{parse_machine(xml, "mill.xml"), {}, {}, {}, {}};
  result.axes = three_axes(result.machine);
  result.at = make_states(1, result.machine);
  const ControllerWishes wishes{1, step_mm, reference};
  result.tables =
      controller_tables(result.machine, result.axes, rules_of(controller, setting), result.at, wishes);
  for (const ConfigurationFile& file :
       controller_files(controller, setting, result.machine.name, result.tables))
    result.files[file.name] = file.text;
  return result;
}

using Point = Eigen::Vector3d;

Point tool_point(const Machine& machine, const Point& command, const Point& direction) {
  States states = make_states(1, machine);
  for (std::size_t i = 0; i < 3; ++i) {
    states.axis[i][0] = command[static_cast<Eigen::Index>(i)];
    states.direction[i][0] = direction[static_cast<Eigen::Index>(i)];
  }
  return forward(machine, states).position.col(0);
}

/// Largest error of a component at random positions and directions, without the mean, um.
Point largest_um(const Case& one, const std::function<Point(const Point&, const Point&)>& moved) {
  const Machine ideal = nominal_machine(one.machine);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> x(0, 600), y(-400, 0), z(-300, 0);
  constexpr Eigen::Index kCount = 600;
  Eigen::Matrix3Xd error(3, kCount);
  for (Eigen::Index k = 0; k < kCount; ++k) {
    const Point p(x(random), y(random), z(random));
    Point d;
    for (double& each : d) each = random() % 2 == 0 ? 1 : -1;
    error.col(k) = tool_point(one.machine, moved(p, d), d) - tool_point(ideal, p, d);
  }
  const Point mean = error.rowwise().mean();
  error.colwise() -= mean;
  return 1000 * error.cwiseAbs().rowwise().maxCoeff();
}

Point unmoved(const Point& p, const Point&) { return p; }

double between(const std::map<int, double>& values, double place) {
  const double held = std::clamp(place, 0.0, static_cast<double>(values.size() - 1));
  const int k = std::min(static_cast<int>(held), static_cast<int>(values.size()) - 2);
  return values.at(k) + (held - k) * (values.at(k + 1) - values.at(k));
}

// --- SINUMERIK: "a positive compensation value causes the axis to move in the negative direction" ---

struct SiemensFile {
  std::map<std::string, double> variable;               // "$AA_ENC_COMP_STEP[0,AX1]"
  std::map<std::string, std::map<int, double>> values;  // by axis or table
  std::map<std::string, int> axis;                      // "$AN_CEC_INPUT_AXIS[0]" -> 1

  void read(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      const std::size_t equals = line.find('=');
      if (line.empty() || line[0] != '$' || equals == std::string::npos) continue;
      const std::string name = line.substr(0, equals), value = line.substr(equals + 1);
      int a = 0, k = 0;
      if (std::sscanf(name.c_str(), "$AA_ENC_COMP[0,%d,AX%d]", &k, &a) == 2)
        values["AX" + std::to_string(a)][k] = std::stod(value);
      else if (std::sscanf(name.c_str(), "$AN_CEC[%d,%d]", &a, &k) == 2)
        values[std::to_string(a)][k] = std::stod(value);
      else if (std::sscanf(value.c_str(), "(AX%d)", &a) == 1)
        axis[name] = a;
      else
        variable[name] = std::stod(value);
    }
  }

  Point moved(const Point& p, const Point& d) const {
    Point q = p;
    for (int i = 0; i < 3; ++i) {
      const std::string name = "AX" + std::to_string(i + 1), index = "[0," + name + "]";
      q[i] -= between(values.at(name), (p[i] - variable.at("$AA_ENC_COMP_MIN" + index)) /
                                           variable.at("$AA_ENC_COMP_STEP" + index));
      q[i] += variable.at("$MA_BACKLASH" + index) / 2 * d[i];
    }
    for (int t = 0; values.contains(std::to_string(t)); ++t) {
      const std::string index = "[" + std::to_string(t) + "]";
      const int input = axis.at("$AN_CEC_INPUT_AXIS" + index) - 1,
                output = axis.at("$AN_CEC_OUTPUT_AXIS" + index) - 1;
      q[output] -= between(values.at(std::to_string(t)), (p[input] - variable.at("$AN_CEC_MIN" + index)) /
                                                             variable.at("$AN_CEC_STEP" + index));
    }
    return q;
  }
};

TEST(SiemensFiles, RemovePositioningStraightnessSquarenessAndBacklash) {
  const Case one = export_of(Controller::kSiemens);
  SiemensFile file;
  for (const auto& [name, text] : one.files) file.read(text);
  const Point before = largest_um(one, unmoved),
              after = largest_um(one, [&](const Point&p, const Point&d) { return file.moved(p, d); });
  EXPECT_GT(before[0], 20);
  EXPECT_GT(before[2], 10);
  // Tolerance of 1 um between the points, and a cross table below a quarter of it that is not written.
  for (const double um : after) EXPECT_LT(um, 1.5);
  EXPECT_NEAR(file.variable.at("$MA_BACKLASH[0,AX1]"), 0.012, 1e-6);  // table travel is too short: positive
  const ControllerErrors errors = controller_errors(one.machine, one.axes, one.tables, one.at);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(errors.after_um[i], after[static_cast<Eigen::Index>(i)], 0.7);
    EXPECT_EQ(errors.after_um[i], std::max(errors.after_positive_um[i], errors.after_negative_um[i]));
  }
}

TEST(SiemensFiles, EndAtTheLastPointOfTheirRange) {
  const Case one = export_of(Controller::kSiemens, kMill, 70);
  SiemensFile file;
  for (const auto& [name, text] : one.files) file.read(text);
  for (const char* axis : {"AX1", "AX2", "AX3"}) {
    const std::string index = std::string("[0,") + axis + "]";
    const double parts =
        (file.variable.at("$AA_ENC_COMP_MAX" + index) - file.variable.at("$AA_ENC_COMP_MIN" + index)) /
        file.variable.at("$AA_ENC_COMP_STEP" + index);
    EXPECT_NEAR(parts, static_cast<double>(file.values.at(axis).size() - 1), 1e-9);
  }
  EXPECT_GE(file.variable.at("$AA_ENC_COMP_MAX[0,AX1]"), 600);
}

// --- HEIDENHAIN ---

struct ComFile {
  std::map<std::string, std::map<int, double>> column;
  explicit ComFile(const std::string& text) {
    std::istringstream in(text);
    std::string line, word;
    std::getline(in, line);
    EXPECT_TRUE(line.starts_with("BEGIN "));
    std::getline(in, line);
    std::istringstream head(line);
    std::vector<std::string> names;
    while (head >> word) names.push_back(word);
    for (int row = 0; std::getline(in, line) && line != "[END]"; ++row) {
      std::istringstream cells(line);
      for (const std::string& name : names) {
        cells >> word;
        column[name][row] = std::stod(word);
      }
      EXPECT_EQ(column["NR"][row], row);
    }
    EXPECT_EQ(line, "[END]");
  }
};

TEST(HeidenhainFiles, HoldBothDirectionsAndTheOtherAxes) {
  const Case one = export_of(Controller::kHeidenhain);
  const std::array<std::string, 3> names = {"X", "Y", "Z"};
  std::vector<ComFile> com;
  for (const std::string& name : names) com.emplace_back(one.files.at(name + ".COM"));
  const auto moved = [&](const Point& p, const Point& d) {
    Point q = p;
    for (std::size_t input = 0; input < 3; ++input) {
      const auto i = static_cast<Eigen::Index>(input);
      const std::map<int, double>& position = com[input].column.at("AXISPOS");
      const double place = (p[i] - position.at(0)) / (position.at(1) - position.at(0));
      for (std::size_t output = 0; output < 3; ++output) {
        const std::string column = input == output && d[i] < 0 ? "BACKLASH" : names[output];
        q[static_cast<Eigen::Index>(output)] -= between(com[input].column.at(column), place);
      }
    }
    return q;
  };
  for (const double um : largest_um(one, moved)) EXPECT_LT(um, 1.5);
  for (const ComFile& file : com) EXPECT_LE(file.column.at("NR").size(), 256U);
  EXPECT_NEAR(com[0].column.at("X").at(0) - com[0].column.at("BACKLASH").at(0), -0.012, 1.1e-4);
}

// --- FANUC ---

struct FanucFile {
  std::map<std::pair<int, int>, double> parameter;  // number, axis
  std::map<int, int> data;
  explicit FanucFile(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      int n = 0, a = 0;
      double value = 0;
      if (std::sscanf(line.c_str(), "N%dQ1A%dP%lf", &n, &a, &value) == 3)
        parameter[{n, a}] = value;
      else if (std::sscanf(line.c_str(), "N%dQ0P%lf", &n, &value) == 2)
        data[n - 10000] = static_cast<int>(value);
      else
        EXPECT_EQ(line, "%");
    }
  }
  /// Sum of the data of the sections between the reference and a position; the value of a section acts in its
  /// middle. Section k above the reference has the number 3620 + k, section 1 below has the number 3620.
  double correction_mm(int axis, double position, double reference, double unit_mm) const {
    const double interval = parameter.at({3624, axis}), place = (position - reference) / interval;
    const int zero = static_cast<int>(parameter.at({3620, axis})),
              nearest = static_cast<int>(std::floor(place + 0.5));
    int sum = 0;
    for (int k = 1; k <= nearest; ++k) sum += data.at(zero + k);
    for (int k = 0; k > nearest; --k) sum -= data.at(zero + k);
    return sum * unit_mm * parameter.at({3623, axis});
  }
};

TEST(FanucFiles, RemovePositioningAndBacklashAndLeaveSquareness) {
  const Case one = export_of(Controller::kFanuc);
  const FanucFile file(one.files.at("PITCH.TXT"));
  const auto moved = [&](const Point& p, const Point& d) {
    Point q = p;
    for (int i = 0; i < 3; ++i) {
      q[i] += file.correction_mm(i + 1, p[i], 0, 1e-3);
      q[i] += file.parameter.at({1851, i + 1}) * 1e-3 / 2 * d[i];
    }
    return q;
  };
  const Point before = largest_um(one, unmoved), after = largest_um(one, moved);
  EXPECT_LT(after[2], 1.6);  // half a unit, half a stair and the offset of the mean
  EXPECT_GT(before[2], 10);
  EXPECT_LT(after[0], before[0]);
  const ControllerErrors errors = controller_errors(one.machine, one.axes, one.tables, one.at);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(errors.after_um[i], after[static_cast<Eigen::Index>(i)], 0.7);
  EXPECT_EQ(file.parameter.at({1851, 1}), 12);
}

TEST(FanucFiles, CountFromAReferenceInsideTheRange) {
  const std::array<double, 3> reference = {250, -100, -80};
  const ControllerSetting half{{1, 2, 3}, 0.5};
  const Case one = export_of(Controller::kFanuc, kMill, 7, half, reference);
  const FanucFile file(one.files.at("PITCH.TXT"));
  // The number of the reference, and one section for each 7 mm on both sides.
  EXPECT_EQ(file.parameter.at({3620, 1}) - file.parameter.at({3621, 1}) + 1, std::ceil(250 / 7.0));
  EXPECT_EQ(file.parameter.at({3622, 1}) - file.parameter.at({3620, 1}), std::ceil(350 / 7.0));
  EXPECT_EQ(file.correction_mm(1, 250, 250, 5e-4), 0);
  const auto moved = [&](const Point& p, const Point& d) {
    Point q = p;
    for (int i = 0; i < 3; ++i) {
      q[i] += file.correction_mm(i + 1, p[i], reference[static_cast<std::size_t>(i)], 5e-4);
      q[i] += file.parameter.at({1851, i + 1}) * 5e-4 / 2 * d[i];
    }
    return q;
  };
  EXPECT_LT(largest_um(one, moved)[2], 1);  // half a stair of 7 mm (0.35 um), half a unit, the mean
}

TEST(FanucFiles, KeepTheRangesOfNumbersAndValues) {
  // Coarse intervals of a large scale: the magnification grows.
  std::string steep = kMill;
  steep.replace(steep.find("0.0001"), 6, "0.0009");
  const Case one = export_of(Controller::kFanuc, steep.c_str(), 100);
  const FanucFile file(one.files.at("PITCH.TXT"));
  EXPECT_GT(file.parameter.at({3623, 3}), 1);
  int next = 0;
  for (int axis = 1; axis <= 3; ++axis) {
    const int first = static_cast<int>(file.parameter.at({3621, axis})),
              last = static_cast<int>(file.parameter.at({3622, axis}));
    EXPECT_EQ(first, next);
    EXPECT_LE(last - first, 127);
    const int reference = static_cast<int>(file.parameter.at({3620, axis}));
    EXPECT_LE(first, reference);
    EXPECT_LE(reference, last);
    for (int k = first; k <= last; ++k) EXPECT_LE(std::abs(file.data.at(k)), 7);
    next = last + 1;
  }
  EXPECT_EQ(static_cast<int>(file.data.size()), next);
}

TEST(ControllerTables, RefuseMorePointsThanTheControllerKeeps) {
  EXPECT_THROW(export_of(Controller::kHeidenhain, kMill, 1), text::InputError);
  EXPECT_THROW(export_of(Controller::kFanuc, kMill, 4), text::InputError);
  EXPECT_THROW(export_of(Controller::kSiemens, kMill, 0.5), text::InputError);
}

/// The travel of X is the direction of the part: its slope is a rotation, a squareness of Y is none.
TEST(ControllerTables, SayWhichRotationOfTheWholePartTheyHold) {
  const auto errors_of = [](const char* x, const char* y) {
    const std::string text =
        std::string(
            R"xml(<machine name="turned"><variables><static><a value="2e-5" nominal="0" unit="rad"/></static>
    <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" X=")xml") +
        x + "\" Y=\"" + y + "\" Z=\"Z\"/></transforms></machine>";
    const Case one = export_of(Controller::kHeidenhain, text.c_str());
    return controller_errors(one.machine, one.axes, one.tables, one.at);
  };
  const ControllerErrors turned = errors_of("X-a*Y", "Y+a*X");
  EXPECT_NEAR(std::abs(turned.rotation_urad[2]), 20, 0.5);  // the tables hold 1 um between their points
  EXPECT_NEAR(turned.rotation_um, 2e-5 * std::hypot(300, 200) * 1000, 0.3);
  const ControllerErrors square = errors_of("X-a*Y", "Y");
  EXPECT_LT(square.rotation_um, 0.3) << "the tolerance of 1 um between the points";
}

/// 257 points of 2000 mm are too few for a period of 10 mm.
TEST(ControllerTables, DoNotIncreaseAnErrorThatTheyCannotHold) {
  const char* const cyclic = R"xml(<machine name="cyclic"><variables><static>
    <c value="0.003" nominal="0" unit="mm"/></static>
    <machineaxes><X min="0" max="2000"/><Y min="0" max="100"/><Z min="-100" max="0"/></machineaxes></variables>
    <transforms branch="workpiece"><sixdof n="1" X="-(X+c*sin(360*X/10))"/></transforms>
    <transforms branch="tool"><sixdof n="1" Y="Y"/><sixdof n="2" Z="Z"/></transforms></machine>)xml";
  for (const Controller controller : {Controller::kHeidenhain, Controller::kFanuc}) {
    const Case one = export_of(controller, cyclic);
    const ControllerErrors errors = controller_errors(one.machine, one.axes, one.tables, one.at);
    EXPECT_LT(errors.after_um[0], errors.before_um[0] + 1);  // rounding of the detection unit
    EXPECT_GT(one.tables.between_um[0], 1);
  }
  // The axis carries the workpiece: 801 points 2.5 mm apart hold a sine of 3 um to 0.9 um.
  const Case fine = export_of(Controller::kSiemens, cyclic);
  EXPECT_LT(controller_errors(fine.machine, fine.axes, fine.tables, fine.at).after_um[0], 1);
}

TEST(ControllerTables, AreZeroAtTheReference) {
  const Case one = export_of(Controller::kSiemens);
  for (const ControllerTable& table : one.tables.tables)
    EXPECT_NEAR((table.at(0, 1) + table.at(0, -1)) / 2, 0, 1e-6) << table.input << table.output;
}

/// The straightness of Y along X by a fit: each value has this standard uncertainty.
Case with_straightness_uncertain_by(double std_mm) {
  Case one = export_of(Controller::kSiemens);
  auto record = std::make_shared<FitRecord>();
  one.machine.tables.front().free[1] = true;  // the column Y
  const ParameterSet parameters(one.machine, {});
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].name.ends_with("].Y")) record->parameters.push_back(parameters[i].name);
  const auto n = static_cast<Eigen::Index>(record->parameters.size());
  EXPECT_GT(n, 3);
  record->factor = Eigen::MatrixXd::Identity(n, n) * std_mm;
  one.machine.fitted = record;
  one.tables =
      controller_tables(one.machine, one.axes, rules_of(Controller::kSiemens, {}), one.at, {1, 0, {0, 0, 0}});
  return one;
}

TEST(ControllerTables, HaveNoStraightnessThatIsAsUncertainAsItself) {
  const Case sure = with_straightness_uncertain_by(0.0005), open = with_straightness_uncertain_by(0.005);
  EXPECT_TRUE(sure.tables.uncertain.empty());
  ASSERT_EQ(open.tables.uncertain.size(), 1U);
  EXPECT_EQ(open.tables.uncertain.front().input, 0U);
  EXPECT_EQ(open.tables.uncertain.front().output, 1U);
  EXPECT_GT(open.tables.uncertain.front().std_um, open.tables.uncertain.front().um / 2);
  const ControllerTable *curve = sure.tables.find(0, 1), *line = open.tables.find(0, 1);
  ASSERT_NE(curve, nullptr);
  ASSERT_NE(line, nullptr);
  const auto bend = [](const ControllerTable& table) {
    const std::vector<double>& v = table.forward;
    return std::abs(v[v.size() / 2] - (v.front() + v.back()) / 2);
  };
  EXPECT_GT(bend(*curve), 0.005);
  EXPECT_LT(bend(*line), 0.00011);  // the resolution of the values
  EXPECT_EQ(line->at(0, 1), 0);     // zero at the reference
  EXPECT_EQ(open.tables.find(0, 0)->forward, sure.tables.find(0, 0)->forward);
}

TEST(ControllerTables, MoveEachAxisAgainstItsError) {
  const Case one = export_of(Controller::kSiemens);
  const ControllerTable& own = *one.tables.find(0, 0);
  EXPECT_NEAR(own.at(150, 1), -0.02, 2e-3);                     // the carriage is 20 um too far
  EXPECT_NEAR(one.tables.find(0, 1)->at(300, 1), -0.01, 1e-3);  // straightness of X
  // Squareness of 0.004 deg: Y at -400 mm is 28 um too far along +X.
  EXPECT_NEAR(one.tables.find(1, 0)->at(-400, 1), -400 * std::sin(0.004 / 57.29578), 1e-4);
}

// --- golden texts ---

const char* const kSmall = R"xml(<machine name="small"><variables><static>
    <s value="0.0001" nominal="0" unit="1"/><q value="0.00002" nominal="0" unit="1"/>
    <rev value="-0.003" nominal="0" unit="mm"/></static>
  <machineaxes><X min="0" max="200"/><Y min="0" max="100"/><Z min="-100" max="0"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X+s*X+rev*dirX" Y="q*X"/><sixdof n="2" Y="Y"/>
  <sixdof n="3" Z="Z"/></transforms></machine>)xml";

TEST(ControllerFiles, HaveTheTextOfTheFormat) {
  EXPECT_EQ(export_of(Controller::kSiemens, kSmall, 100).files.at("AX1_EEC.INI"),
            R"(%_N_AX1_EEC_INI
; small: leadscrew and encoder errors of X (AX1)
; The machine file describes errors that were measured with these compensations off. If the tables were
; on, add the present values to those of this file.
; Needs MD38000 $MA_MM_ENC_COMP_MAX_POINTS[0,AX1] >= 3. A change of MD38000 clears memory: save the
; data first. MD32700 $MA_ENC_COMP_ENABLE[0,AX1] must be 0 while this file is loaded, then 1, and the
; axis must be referenced again.
; Sign: a positive value moves the axis in its negative direction.
; Test move: with the table off, move X from 0.000 to 200.000 mm in the positive direction and
; measure X: its error changes by 20.0 um. With the table on, this change must be near 0 um. If
; the change is near 40.0 um, change the sign of all values.
CHANDATA(1)
$AA_ENC_COMP[0,0,AX1]=0.000000
$AA_ENC_COMP[0,1,AX1]=0.009999
$AA_ENC_COMP[0,2,AX1]=0.019998
$AA_ENC_COMP_STEP[0,AX1]=100.000000
$AA_ENC_COMP_MIN[0,AX1]=0.000000
$AA_ENC_COMP_MAX[0,AX1]=200.000000
$AA_ENC_COMP_IS_MODULO[0,AX1]=0
; Backlash, positive if the encoder is ahead of the machine part
$MA_BACKLASH[0,AX1]=0.005999
M17
)");
  // The model has no reversal error of Y: 0 is not written without a word.
  const auto siemens = export_of(Controller::kSiemens, kSmall, 100).files;
  EXPECT_EQ(siemens.at("AX1_EEC.INI").find("no reversal error"), std::string::npos);
  EXPECT_NE(siemens.at("AX3_EEC.INI").find("; The model has no reversal error of Z: the next value switches"),
            std::string::npos);
  EXPECT_EQ(export_of(Controller::kHeidenhain, kSmall, 100).files.at("X.COM"),
            R"(BEGIN X.COM MM
NR   AXISPOS     BACKLASH    X          Y          Z
0    +0.0000     +0.0030    -0.0030    +0.0000    +0.0000
1    +100.0000   +0.0130    +0.0070    +0.0020    +0.0000
2    +200.0000   +0.0230    +0.0170    +0.0040    +0.0000
[END]
)");
  EXPECT_EQ(export_of(Controller::kHeidenhain, kSmall, 100).files.at("CONFIG.CMA"),
            R"(BEGIN CONFIG.CMA
NR   ACTIVE  X           Y           Z
0    *       X.COM       Y.COM       Z.COM
[END]
)");
  ControllerSetting setting;
  setting.number = {1, 3, 2};
  EXPECT_EQ(export_of(Controller::kFanuc, kSmall, 100, setting).files.at("PITCH.TXT"),
            R"(%
N01851Q1A1P6
N03620Q1A1P0
N03621Q1A1P0
N03622Q1A1P2
N03623Q1A1P2
N03624Q1A1P100.000
N01851Q1A3P0
N03620Q1A3P3
N03621Q1A3P3
N03622Q1A3P4
N03623Q1A3P1
N03624Q1A3P100.000
N01851Q1A2P0
N03620Q1A2P5
N03621Q1A2P5
N03622Q1A2P5
N03623Q1A2P1
N03624Q1A2P100.000
N10000Q0P0
N10001Q0P-5
N10002Q0P-5
N10003Q0P0
N10004Q0P0
N10005Q0P0
%
)");
}

TEST(ControllerFiles, TellHowToCheckTheSign) {
  for (const Controller controller : {Controller::kHeidenhain, Controller::kFanuc})
    EXPECT_NE(export_of(controller, kSmall, 100)
                  .files.at("README.txt")
                  .find("Test move: with the table off, move X"),
              std::string::npos);
  EXPECT_NE(export_of(Controller::kSiemens, kSmall, 100)
                .files.at("NC_CEC.INI")
                .find("measure X: its error changes by 2.0 um"),
            std::string::npos);
}

/// The numbers of the sentences that check straightness and squareness.
std::vector<double> checked_um(const Case& one, const std::string& file) {
  std::vector<double> numbers;
  const std::string& text = one.files.at(file);
  for (const std::string before : {"is then ", "measure X: its error changes by "})
    for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at + 1))
      numbers.push_back(std::stod(text.substr(at + before.size())));
  return numbers;
}

/// The bow of X is 22 um from the line between the ends. A tracker that is rotated by 57.7 urad reads 34.6 um
/// at X 600 mm; the rotation of the whole part is an error of no straightedge and of no square.
TEST(ControllerFiles, CheckStraightnessAndSquarenessWithoutTheAlignmentOfTheInstrument) {
  const auto machine = [](const std::string& rotation) {
    return R"xml(<machine name="bow"><variables><static>
    <EC0Y value="0.00005" nominal="0" unit="1"/><r value=")xml" +
           rotation + R"xml(" nominal="0" unit="rad"/></static>
  <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes>
  <comptables><table axis="X"><station loc="0" Y="0"/><station loc="300" Y="-0.022"/><station loc="600" Y="0"/>
  </table></comptables></variables><transforms branch="tool"><sixdof n="1" X="-r*Y+EC0Y*Y" Y="r*X"/>
  <sixdof n="2" X="X" Y="lXy"/><sixdof n="3" Y="Y"/><sixdof n="4" Z="Z"/></transforms></machine>)xml";
  };
  const auto numbers = [&](Controller controller, const std::string& rotation, const std::string& file) {
    return checked_um(export_of(controller, machine(rotation).c_str()), file);
  };
  for (const std::string rotation : {"0", "-0.0000577"})
    for (const auto& [controller, file] :
         {std::pair(Controller::kSiemens, "NC_CEC.INI"), std::pair(Controller::kHeidenhain, "README.txt")}) {
      const std::vector<double> um = numbers(controller, rotation, file);
      ASSERT_EQ(um.size(), 2U) << rotation << " " << file;
      EXPECT_NEAR(um[0], -22, 0.35) << rotation << " " << file;  // two ends and a point, 0.1 um in the file
      EXPECT_NEAR(um[1], 20, 0.35) << rotation << " " << file;   // 50 urad over 400 mm
    }
}

}  // namespace
}  // namespace vernier::controllers_test
