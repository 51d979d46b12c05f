// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "tests/support/machines.h"
#include "tests/unit/kinematics/machines.h"
#include "tools/kinematics/inverse.h"
#include "tools/kinematics/rotations.h"
#include "tools/model/machine_reader.h"

namespace vernier::solve_test {

using namespace vernier::kinematics;
using namespace vernier::model;
namespace {

constexpr unsigned long kSeed = 20;

std::vector<std::string> reference_machines() {
  std::vector<std::string> files = {VERNIER_SOURCE_DIR "/tests/data/electroimpact/kinematic_before.xml"};
  for (const auto& entry : std::filesystem::directory_iterator(VERNIER_SOURCE_DIR "/tables/machines"))
    if (entry.path().extension() == ".xml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

std::size_t rotary_count(const Machine& machine) { return machine.axes.size() - linear_axes(machine).size(); }

/// The most that the axes of this machine can meet.
InverseOptions most_of(const Machine& machine) {
  InverseOptions options;
  const std::size_t linear = linear_axes(machine).size(), rotary = rotary_count(machine);
  options.match = linear + rotary >= 6 && rotary >= 3 ? Match::kPose
                  : rotary >= 2 && linear >= 3        ? Match::kDirection
                                                      : Match::kPosition;
  options.only_reachable = linear + rotary < 3;  // a plane machine cannot reach out of its plane
  options.keep_ranges = false;                   // asked of each machine below where it declares them
  return options;
}

Poses pose_of(const Poses& all, std::size_t i) {
  Poses one;
  one.position = all.position.col(static_cast<Eigen::Index>(i));
  one.rotation = {all.rotation[i]};
  return one;
}

/// Random poses that are no singular ones: forward, inverse from the middle of the ranges, forward again.
void expect_round_trip(const Machine& machine, std::size_t count) {
  std::printf("seed %lu, %s\n", kSeed, machine.name.empty() ? machine.file.c_str() : machine.name.c_str());
  std::mt19937_64 random(kSeed);
  const States states = random_states(machine, count, random), middle = random_states(machine, 1, random);
  const Poses poses = forward(machine, states);
  const InverseOptions options = most_of(machine);
  std::size_t singular = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const InverseResult there = solve(machine, pose_of(poses, i), select_states(states, {i}), options);
    if (there.each[0].condition > 1e5 && !options.only_reachable) {
      ++singular;
      continue;
    }
    const InverseResult found = solve_anywhere(machine, pose_of(poses, i), middle, options, 300);
    ASSERT_TRUE(found.each[0].converged) << machine.file << " pose " << i << " "
                                         << name_of(found.each[0].fault) << " " << found.each[0].residual_mm;
    const Poses again = forward(machine, found.states);
    // The tolerance of the solver, and rounding of coordinates of some metres.
    EXPECT_LE((again.position.col(0) - poses.position.col(static_cast<Eigen::Index>(i))).norm(), 2e-9);
    if (options.match == Match::kPose) {
      EXPECT_LE(rotation_vector(again.rotation[0] * poses.rotation[i].transpose()).norm(), 1e-10);
    }
    if (options.match == Match::kDirection) {
      EXPECT_LE((again.rotation[0].col(2) - poses.rotation[i].col(2)).norm(), 1e-10);
    }
  }
  EXPECT_LE(singular, count / 10);
}

TEST(Inverse, ReferenceMachinesComeBackToTheirPoses) {
  for (const std::string& file : reference_machines()) {
    const Machine machine = read_machine(file);
    expect_round_trip(machine, 40);
    expect_round_trip(nominal_machine(machine), 10);
  }
}

TEST(Inverse, ArmComesBackToItsPoses) { expect_round_trip(robot(), 60); }

TEST(Inverse, MachineWithTablesFlexureAndLagComesBack) { expect_round_trip(support::full_machine(), 60); }

TEST(Inverse, ColumnMachineComesBack) {
  std::mt19937_64 random(kSeed);
  expect_round_trip(column_machine(random), 60);
}

TEST(Inverse, StretchedWristIsReportedSingular) {
  const Machine machine = robot();
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    States states = random_states(machine, 1, random);
    states.axis[4][0] = 0;  // J4 and J6 turn about one line
    const Poses target = forward(machine, states);
    const InverseResult found = solve(machine, target, states, {});
    EXPECT_FALSE(found.each[0].converged);
    EXPECT_EQ(found.each[0].fault, InverseFault::kSingular);
    EXPECT_GT(found.each[0].condition, 1e6);
  }
}

TEST(Inverse, TargetBeyondTheArmIsOutOfReach) {
  const Machine machine = robot();
  std::mt19937_64 random(kSeed);
  const States start = random_states(machine, 1, random);
  Poses target = forward(machine, start);
  target.position.col(0) = Eigen::Vector3d(2000, 500, 300);  // the arm is 1.4 m long
  const InverseResult found = solve_anywhere(machine, target, start, {}, 20);
  EXPECT_FALSE(found.each[0].converged);
  EXPECT_NE(found.each[0].fault, InverseFault::kNone);
  EXPECT_GT(found.each[0].residual_mm + found.each[0].residual_deg, 100);
}

TEST(Inverse, TargetBeyondTheTravelNamesTheAxis) {
  std::mt19937_64 random(kSeed);
  const Machine machine = column_machine(random);
  States states = random_states(machine, 1, random);
  states.axis[1][0] = 300.5;
  const Poses target = forward(machine, states);
  InverseOptions options;
  options.match = Match::kPosition;
  InverseResult found = solve(machine, target, random_states(machine, 1, random), options);
  EXPECT_EQ(found.each[0].fault, InverseFault::kBeyondRange);
  EXPECT_EQ(machine.axes[found.each[0].axis].name, "Y");
  EXPECT_LE(found.each[0].residual_mm, 1e-9);
  options.keep_ranges = false;
  found = solve(machine, target, random_states(machine, 1, random), options);
  EXPECT_TRUE(found.each[0].converged);
  EXPECT_NEAR(found.states.axis[1][0], 300.5, 1e-8);
}

/// Robots turn further than a turn: what is returned is the position that was turned back, and proved there.
TEST(Inverse, AnswersAreWithinTheRangesThatTheyWereTurnedInto) {
  const Machine machine = read_machine(VERNIER_SOURCE_DIR "/tables/machines/ur10e.xml");
  std::mt19937_64 random(kSeed);
  std::size_t solved = 0;
  for (int i = 0; i < 44; ++i) {
    const States there = random_states(machine, 1, random);
    const Poses target = forward(machine, there);
    InverseOptions options;
    const InverseResult found =
        solve_anywhere(machine, target, random_states(machine, 1, random), options, 48);
    if (!found.each[0].converged) continue;
    ++solved;
    for (std::size_t a = 0; a < machine.axes.size(); ++a) {
      EXPECT_GE(found.states.axis[a][0], *machine.axes[a].min - 1e-9) << "pose " << i << " J" << a + 1;
      EXPECT_LE(found.states.axis[a][0], *machine.axes[a].max + 1e-9) << "pose " << i << " J" << a + 1;
    }
    const Poses again = forward(machine, found.states);
    EXPECT_LE((again.position.col(0) - target.position.col(0)).norm(), 2e-9);
  }
  EXPECT_GE(solved, 40u);
}

/// A start whole turns away, and an error that grows with the turns (a cable that winds up).
TEST(Inverse, WholeTurnsThatTheChainKnowsAreSolvedAnew) {
  const Machine machine = parse_machine(
      R"(<machine name="winder"><variables><static><k value="0.001" nominal="0"/></static><machineaxes>
      <X min="0" max="500"/><C rotary="true" min="-180" max="180"/></machineaxes></variables>
      <transforms branch="tool"><sixdof n="1" rZ="C"/><sixdof n="2" X="X+k*C"/></transforms></machine>)",
      "winder.xml");
  States states = make_states(1, machine);
  states.axis[0][0] = 200;
  states.axis[1][0] = 30;
  const Poses target = forward(machine, states);
  InverseOptions options;
  options.match = Match::kPosition;
  options.only_reachable = true;
  states.axis[1][0] = 760;
  const InverseResult found = solve(machine, target, states, options);
  ASSERT_TRUE(found.each[0].converged) << name_of(found.each[0].fault);
  EXPECT_NEAR(found.states.axis[1][0], 30, 1e-7);
  EXPECT_NEAR(found.states.axis[0][0], 200, 1e-7);
  EXPECT_LE((forward(machine, found.states).position - target.position).norm(), 2e-9);
}

TEST(Inverse, OppositeDirectionIsNoSolution) {
  // A tool that can only tilt by 30 deg shall point the other way: the residual is an angle, never a sine.
  const Machine machine = parse_machine(
      R"XML(<machine><variables><machineaxes><X/><Y/><Z/><A rotary="true" min="-30" max="30"/>
      <B rotary="true" min="-30" max="30"/></machineaxes></variables><transforms branch="tool">
      <sixdof n="1" X="X" Y="Y" Z="Z"/><sixdof n="2" rX="A" rY="B"/></transforms></machine>)XML",
      "tilt.xml");
  const States start = make_states(1, 5, {});
  Poses target = forward(machine, start);
  target.rotation[0] = rotation_of({180, 0, 0});
  InverseOptions options;
  options.match = Match::kDirection;
  const InverseResult found = solve(machine, target, start, options);
  EXPECT_FALSE(found.each[0].converged);
}

TEST(Inverse, StepsAreQuadraticNearTheSolution) {
  const Machine machine = robot();
  std::mt19937_64 random(kSeed);
  const States states = random_states(machine, 50, random);
  const Poses target = forward(machine, states);
  States start = states;
  for (Column& axis : start.axis) axis += 1;  // deg
  const InverseResult found = solve(machine, target, start, {});
  int most = 0;
  for (const Inverse& proof : found.each)
    if (proof.condition < 100) most = std::max(most, proof.iterations);
  EXPECT_GT(most, 1);
  // 1 deg -> 1e-2 -> 1e-4 -> 1e-8 … of the lever, less what the damping of 1e-6 holds back.
  EXPECT_LE(most, 8);
}

TEST(RotationVector, IsTheInverseOfTheRotation) {
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const double angle : {0.0, 1e-9, 1e-3, 20.0, 179.0, 179.9999}) {
    const Eigen::Vector3d v = angle * Eigen::Vector3d(part(random), part(random), part(random)).normalized();
    const Eigen::Vector3d back = rotation_vector(rotation_of(v)) * 180 / std::acos(-1.0);
    EXPECT_LE((back - v).norm(), 1e-10) << angle;
  }
}

}  // namespace
}  // namespace vernier::solve_test
