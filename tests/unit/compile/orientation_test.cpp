// SPDX-License-Identifier: GPL-3.0-or-later
// Position and direction of the tool, on the executed program against forward solutions in double.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "tests/unit/compile/agreement.h"
#include "tests/unit/compile/left_over.h"
#include "tests/unit/effects/candidates.h"
#include "tools/compile/orientation.h"
#include "tools/model/machine_reader.h"

namespace vernier::orientation_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr unsigned kSeed = 17;
/// What is asked for; ten times less than the first source's own goal of 0.025 deg.
constexpr double kTilt_deg = 0.002;
constexpr double kDeg = 180 / std::numbers::pi;

/// Published location errors (Chanal, Duc, Chevalier 2022, Table 4), mm and deg.
Machine five_axis() {
  Machine machine = read_machine(diagnose_test::machine_path("five_axis_bhead_ctable"));
  const std::map<std::string, double> published = {{"EC0Y", -1.0654e-5 * kDeg},
                                                   {"EA0Z", 7.0883e-7 * kDeg},
                                                   {"EB0Z", 1.2581e-7 * kDeg},
                                                   {"EA0C", -7.0883e-7 * kDeg},
                                                   {"EB0C", -1.2581e-7 * kDeg},
                                                   {"EA0B", 3.2419e-4 * kDeg},
                                                   {"EX0B", 0.0294}};
  for (Static& s : machine.statics)
    if (const auto found = published.find(s.name); found != published.end()) s.value = found->second;
  machine.correct_orientation = true;
  return machine;
}

/// The fibre placement machine over the ranges of its tables, errors of `size` times 0.1 mm and 0.15 deg.
Machine fibre_placement(double size) {
  Machine machine = read_machine(diagnose_test::machine_path("fibre_placement"));
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (const Table* const table = machine.table_of(i)) {
      machine.axes[i].min = table->stations.front().loc;
      machine.axes[i].max = table->stations.back().loc;
    }
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> share(-1, 1);
  for (Static& s : machine.statics) {
    if (!s.hidden && !s.nominal) s.nominal = s.value;
    if (s.hidden || !s.nominal) continue;
    const bool angle = s.name.find("mr") != std::string::npos || s.name.find("clr") == 0;
    s.value += size * share(random) * (angle ? 0.15 : s.name.find("flex") != std::string::npos ? 1.0 : 0.1);
  }
  machine.correct_orientation = true;
  return machine;
}

void print(const char* name, const TestMachine& test, const LeftOver& left) {
  std::printf(
      "%s: seed %u, %.1f um and %.4f deg before, %.5f um and %.7f deg left (%.4f deg in %zu damped poses), "
      "%d evaluations, %zu operations\n",
      name, kSeed, left.before_um, left.tilt_before_deg, left.left_um, left.tilt_deg, left.damped_tilt_deg,
      left.damped, test.compiled.evaluations, test.compiled.program.instructions.size());
}

TEST(Orientation, FibrePlacementMachineIsPutRightWithLargeErrors) {
  const TestMachine test(fibre_placement(1));
  const LeftOver left = left_over(test, 20000, kSeed);
  print("fibre placement", test, left);
  EXPECT_GT(left.tilt_before_deg, 0.5);
  EXPECT_LE(left.tilt_deg, kTilt_deg);
  EXPECT_EQ(left.damped, 0u);  // A and B stand across each other over the declared ranges
  EXPECT_GT(left.before_um, 1000);
  EXPECT_LE(left.left_um, 0.1);
}

TEST(Orientation, FiveAxisMachineIsPutRightWithItsPublishedErrors) {
  const TestMachine test(five_axis());
  const LeftOver left = left_over(test, 20000, kSeed);
  print("five axes", test, left);
  EXPECT_GT(left.tilt_before_deg, 0.015);
  EXPECT_LE(left.tilt_deg, kTilt_deg);
  EXPECT_LE(left.left_um, 0.1);  // towards B = 0 too
  // |sin B| < 1/16 is 4.0 % of +-90 deg.
  EXPECT_NEAR(static_cast<double>(left.damped) / 20000, 0.040, 0.005);
  EXPECT_LE(left.damped_tilt_deg, left.tilt_before_deg);
}

TEST(Orientation, PositionAloneLeavesTheTilt) {
  Machine machine = five_axis();
  machine.correct_orientation = false;
  const LeftOver left = left_over(TestMachine(machine), 5000, kSeed);
  EXPECT_GT(left.tilt_deg, 0.015);
  EXPECT_LE(left.left_um, 0.1);
}

TEST(Orientation, BoundsHold) {
  const TestMachine test(five_axis());
  const Agreement seen = compare(test, 2, 4000, kSeed);
  EXPECT_LE(seen.worst_share, 1);
  const LeftOver left = left_over(test, 8000, kSeed);
  ASSERT_TRUE(test.compiled.tilt.has_value());
  EXPECT_LE(left.tilt_deg, test.compiled.tilt->left_deg());
  EXPECT_LE(left.tilt_before_deg, test.compiled.tilt->deviation_deg);
  const TestMachine fibre(fibre_placement(0.02));
  const LeftOver fibre_left = left_over(fibre, 8000, kSeed);
  EXPECT_LE(fibre_left.tilt_deg, fibre.compiled.tilt->left_deg());
  EXPECT_LE(fibre.compiled.tilt->left_deg(), kTilt_deg);
  EXPECT_LE(compare(fibre, 1, 4000, kSeed).worst_share, 1);
}

TEST(Orientation, LimitOfARotaryAxisCostsTiltAndNoPosition) {
  // GIVEN a C axis that may be corrected by 0.02 deg
  Machine machine = five_axis();
  for (Axis& axis : machine.axes)
    if (axis.name == "C") axis.max_correction = 0.02;
  // WHEN the corrections run over all poses
  const TestMachine test(machine);
  const LeftOver left = left_over(test, 20000, kSeed);
  print("five axes, C limited", test, left);
  // THEN the linear axes follow what C really does
  EXPECT_LE(left.largest[*machine.find_axis("C")], 0.02 + 1e-6);
  EXPECT_LE(left.left_um, 0.1);
  EXPECT_GT(left.tilt_deg, kTilt_deg);
}

TEST(Orientation, SingularPoseIsToldAndKeepsTheTiltThatItsAxesReach) {
  // GIVEN B = 0: C turns the tool about itself, B still tilts it
  const TestMachine test(five_axis());
  EXPECT_TRUE(std::any_of(test.compiled.notes.begin(), test.compiled.notes.end(),
                          [](const std::string& note) {
                            return note.find("B and C tilt the tool in the same direction") !=
                                   std::string::npos;
                          }))
      << "no note";
  ASSERT_TRUE(test.compiled.orientation && test.compiled.orientation->damped);
  EXPECT_NEAR(*test.compiled.orientation->damped, 0.04, 0.02);  // 512 samples
  std::mt19937_64 random(kSeed);
  std::vector<CycleInput> inputs = test.random_poses(50, random);
  for (CycleInput& input : inputs) input.axis[3].position = AxisPosition(0);
  const States states = test.states_of(inputs), corrected = corrected_states(test, inputs, states);
  const Poses nominal = forward(nominal_machine(test.machine), states),
              after = forward(test.machine, corrected);
  for (std::size_t i = 0; i < states.count; ++i) {
    const Eigen::Vector3d left = after.rotation[i].col(2) - nominal.rotation[i].col(2);
    // WHEN corrected, THEN the plane in which B tilts is right, in workpiece coordinates turned by C
    const double c = states.axis[4][static_cast<Eigen::Index>(i)] / kDeg;
    EXPECT_LE(std::abs(std::cos(c) * left.x() - std::sin(c) * left.y()) * kDeg, kTilt_deg);
    EXPECT_TRUE(damped_poses(test.machine, states)[i]);
  }
  EXPECT_LE((corrected.axis[4] - states.axis[4]).abs().maxCoeff(), 1e-3);
}

TEST(Orientation, TableTableMachineIsPutRight) {
  const std::string text = R"XML(<machine name="trunnion"><variables><static>
    <e1 value="0.02" nominal="0" unit="deg"/><e2 value="-0.015" nominal="0" unit="deg"/>
    <e3 value="0.04" nominal="0" unit="mm"/></static>
    <machineaxes correct="position orientation"><X min="-300" max="300"/><Y min="-200" max="200"/>
    <Z min="0" max="400"/><A rotary="true" min="20" max="90"/><C rotary="true" rollover="true" min="0" max="360"/>
    </machineaxes></variables>
    <transforms branch="workpiece"><sixdof n="1" rX="A+e1*sin(A)" rY="e2"/><sixdof n="2" X="e3" Z="-50" rZ="C"/>
    </transforms><transforms branch="tool"><sixdof n="1" X="X"/><sixdof n="2" Y="Y" rX="e2"/>
    <sixdof n="3" Z="Z" rY="e1"/></transforms></machine>)XML";
  const TestMachine test(parse_machine(text, "m.xml"), text);
  const LeftOver left = left_over(test, 10000, kSeed);
  print("trunnion", test, left);
  EXPECT_GT(left.tilt_before_deg, 0.02);
  EXPECT_LE(left.tilt_deg, kTilt_deg);
  EXPECT_EQ(left.damped, 0u);
  EXPECT_LE(left.left_um, 0.1);
}

TEST(Orientation, OneRotaryAxisCorrectsAcrossItself) {
  const std::string text = R"XML(<machine name="four"><variables><static>
    <e1 value="0.02" nominal="0" unit="deg"/><e2 value="0.01" nominal="0" unit="deg"/></static>
    <machineaxes correct="position orientation"><X min="-300" max="300"/><Y min="-200" max="200"/>
    <Z min="0" max="400"/><B rotary="true" min="-90" max="90"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" X="X" Y="Y" Z="Z" rY="e1" rX="e2"/><sixdof n="2" rY="B"/>
    <sixdof n="3" Z="-150"/></transforms></machine>)XML";
  const TestMachine test(parse_machine(text, "m.xml"), text);
  const LeftOver left = left_over(test, 5000, kSeed);
  print("four axes", test, left);
  EXPECT_NEAR(left.tilt_before_deg, std::hypot(0.02, 0.01), 1e-4);
  EXPECT_NEAR(left.tilt_deg, 0.01, 1e-4);
  EXPECT_LE(left.left_um, 0.1);
  EXPECT_TRUE(std::any_of(
      test.compiled.notes.begin(), test.compiled.notes.end(),
      [](const std::string& note) { return note.find("only one rotary axis") != std::string::npos; }));
}

TEST(Orientation, RefusedWhereLinearAxesDoNotPutThePointRight) {
  Machine machine = disturbed(read_machine(diagnose_test::machine_path("ur10e")), kSeed);
  machine.correct_orientation = true;
  try {
    compile_machine(machine, {}, {});
    FAIL() << "a robot";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("position orientation"), std::string::npos) << error.what();
  }
}

TEST(Orientation, ThreeAxisMachineIsCompiledAsItIs) {
  Machine machine = disturbed(read_machine(diagnose_test::machine_path("moving_bridge")), kSeed);
  const CompiledMachine plain = compile_machine(machine, {}, {});
  machine.correct_orientation = true;
  const CompiledMachine asked = compile_machine(machine, {}, {});
  EXPECT_EQ(asked.image, plain.image);
  EXPECT_NE(asked.notes, plain.notes);
}

}  // namespace
}  // namespace vernier::orientation_test
