// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/correction.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "tests/support/machines.h"
#include "tests/unit/kinematics/machines.h"
#include "tools/model/machine_reader.h"

namespace vernier::correction_test {

using namespace vernier::kinematics;
using namespace vernier::model;
namespace {

constexpr unsigned long kSeed = 21;
/// What a correction may leave, mm.
constexpr double kLeft_mm = 1e-6;

TEST(Correction, TableAxesOfTheColumnMachineGetTheDeviationItself) {
  std::printf("seed %lu\n", kSeed);
  std::mt19937_64 random(kSeed);
  for (int machines = 0; machines < 10; ++machines) {
    const Machine machine = column_machine(random);
    const States states = random_states(machine, 20, random);
    const CorrectionResult result = correct(machine, states);
    for (Eigen::Index i = 0; i < 20; ++i) {
      const Eigen::Vector3d d = result.before.col(i);
      // Second order: deviation (0.1 mm at most) times slope of the deviation (3e-4 at most).
      EXPECT_NEAR(result.offset[0][i], d.x(), 3e-5);
      EXPECT_NEAR(result.offset[1][i], d.y(), 3e-5);
      EXPECT_NEAR(result.offset[2][i], -d.z(), 3e-5);
      EXPECT_LE(result.after.col(i).norm(), kLeft_mm);
      EXPECT_GT(d.norm(), 1e-3);
      EXPECT_TRUE(result.each[static_cast<std::size_t>(i)].converged);
    }
  }
}

/// A true machine: every free static off its nominal, as far as the chain takes it.
Machine spoiled(const Machine& machine, std::mt19937_64& random) {
  Machine result = machine;
  std::uniform_real_distribution<double> off(-1e-3, 1e-3);
  for (Static& item : result.statics) {
    if (item.hidden) continue;
    if (!item.nominal) item.nominal = item.value;
    item.value = *item.nominal + off(random);
  }
  return result;
}

TEST(Correction, EveryReferenceMachineIsPutRight) {
  std::printf("seed %lu\n", kSeed);
  for (const auto& entry : std::filesystem::directory_iterator(VERNIER_SOURCE_DIR "/tables/machines")) {
    if (entry.path().extension() != ".xml") continue;
    std::mt19937_64 random(kSeed);
    const Machine machine = spoiled(read_machine(entry.path().string()), random);
    const States states = random_states(machine, 40, random);
    const std::size_t linear = linear_axes(machine).size(), rotary = machine.axes.size() - linear;
    const CorrectionResult result = correct(machine, states, {.with_rotary = linear < 3 && rotary > 0});
    for (std::size_t i = 0; i < states.count; ++i) {
      const Eigen::Vector3d left = result.after.col(static_cast<Eigen::Index>(i));
      EXPECT_TRUE(result.each[i].converged) << entry.path();
      EXPECT_LE(result.each[i].reducible_mm, kLeft_mm) << entry.path();
      if (linear + rotary >= 3) {
        EXPECT_LE(left.norm(), kLeft_mm) << entry.path();
      }
    }
  }
}

TEST(Correction, RotaryAxesPutPointAndDirectionRight) {
  std::printf("seed %lu\n", kSeed);
  std::mt19937_64 random(kSeed);
  const Machine machine = support::full_machine();
  const States states = random_states(machine, 60, random);
  const CorrectionResult linear = correct(machine, states),
                         all = correct(machine, states, {.with_rotary = true});
  int better = 0;
  for (Eigen::Index i = 0; i < 60; ++i) {
    EXPECT_LE(linear.after.col(i).norm(), kLeft_mm);
    if (!all.each[static_cast<std::size_t>(i)].converged) continue;
    EXPECT_LE(all.each[static_cast<std::size_t>(i)].reducible_mm, kLeft_mm);
    // B and C can tilt the tool every way unless C stands along it.
    if (all.each[static_cast<std::size_t>(i)].condition > 1e3) continue;
    EXPECT_LE(all.after.col(i).norm(), kLeft_mm);
    EXPECT_LE(all.tilt_after[i], 1e-6);
    EXPECT_GT(all.tilt_before[i], 1e-5);
    ++better;
  }
  EXPECT_GT(better, 40);
}

TEST(Correction, PlaneMachineLeavesItsHeightAlone) {
  const Machine machine = parse_machine(
      R"XML(<machine><variables><static><h value="0.02" nominal="0"/><k value="1e-4" nominal="0"/></static>
      <machineaxes><X/><Y/></machineaxes></variables><transforms branch="tool">
      <sixdof n="1" X="X*(1+k)" Y="Y" Z="h"/></transforms></machine>)XML",
      "plane.xml");
  States states = make_states(1, 2, {});
  states.axis[0][0] = 100;
  const CorrectionResult result = correct(machine, states);
  EXPECT_TRUE(result.each[0].converged);
  EXPECT_NEAR(result.offset[0][0], 100 / 1.0001 - 100, 2e-9);
  EXPECT_NEAR(result.after(2, 0), 0.02, 1e-12);
  EXPECT_LE(result.after.col(0).head<2>().norm(), kLeft_mm);
}

TEST(Correction, MotionStaysAsItIs) {
  const Machine machine = parse_machine(
      R"XML(<machine><variables><static><rev value="0.005" nominal="0"/></static><machineaxes><X/></machineaxes>
      </variables><transforms branch="tool"><sixdof n="1" X="X+rev*dirX"/></transforms></machine>)XML",
      "reversal.xml");
  States states = make_states(2, 1, {});
  states.direction[0] << 1, -1;
  const CorrectionResult result = correct(machine, states);
  EXPECT_NEAR(result.offset[0][0], -0.005, 2e-9);
  EXPECT_NEAR(result.offset[0][1], +0.005, 2e-9);
}

}  // namespace
}  // namespace vernier::correction_test
