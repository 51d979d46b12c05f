// SPDX-License-Identifier: GPL-3.0-or-later
// The published feature-based equations, in each of their unequal readings.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/compile/agreement.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"

namespace vernier::learned_test {

using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr unsigned kSeed = 20260;
const std::string kFolder = VERNIER_SOURCE_DIR "/tables/machines/learned/";

/// Deviation along X, mm, at the reference value of every input: F1 0.4, F2 0.02, F3 0.12, F4 3 for the
/// robot.
double deviation_x_mm(const std::string& name) {
  const Machine machine = read_machine(kFolder + name);
  const Measurement one = parse_measurement("X[mm],Y[mm],Z[mm],x[mm]\n0,0,0,0\n", "m.csv", machine);
  return deviation(machine, one.states)(0, 0);
}

TEST(LearnedEquation, ReadingsOfTheRobotsAreAsUnequalAsPublished) {
  EXPECT_NEAR(deviation_x_mm("radial_robot_printed.xml"), -363.7, 0.05);
  EXPECT_NEAR(deviation_x_mm("radial_robot_printed_term.xml"), -0.020, 0.0005);
  EXPECT_NEAR(deviation_x_mm("radial_robot_code.xml"), 0.421, 0.0005);
}

TEST(LearnedEquation, RunsInTheTickWithinItsProvedBound) {
  std::size_t machines = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    const std::string text = read_file(entry.path().string());
    const TestMachine test(parse_machine(text, entry.path().filename().string()), text);
    const Agreement seen = compare(test, 1, 4000, kSeed);
    std::printf("%s: seed %u, %zu operations, deviation up to %.1f um, %.6f um seen, %.6f um proved\n",
                entry.path().filename().c_str(), kSeed, test.compiled.program.instructions.size(),
                seen.largest_um, seen.worst_um, largest_bound_um(test.compiled));
    EXPECT_LE(seen.worst_share, 1.0);
    EXPECT_GT(seen.largest_um, 10.0);
    EXPECT_GT(seen.poses, 1000u);
    ++machines;
  }
  EXPECT_EQ(machines, 6u);
}

TEST(LearnedEquation, ABellFarOutIsNoGiant) {
  // Integers do not know that a square is not negative; exp of its opposite must not be taken for a giant.
  for (const char* bell : {"exp(-2000*(0.121-u)^2)", "exp(-900*(u-0.2)^4-30*(0.1-u)^2)"}) {
    const std::string text =
        std::string(
            "<machine name=\"m\"><variables><static><k value=\"0.05\" nominal=\"0\"/></static>"
            "<machineaxes><X min=\"0\" max=\"100\"/></machineaxes><inputs><u unit=\"\" "
            "reference=\"0\" min=\"0\" max=\"0.5\"/></inputs></variables><transforms>"
            "<sixdof n=\"1\" X=\"X+k*") +
        bell + "\"/></transforms></machine>";
    const TestMachine test(parse_machine(text, "m.xml"), text);
    const Agreement seen = compare(test, 1, 4000, kSeed);
    EXPECT_LE(seen.worst_share, 1.0) << bell;
    EXPECT_GT(seen.largest_um, 40) << bell;
    EXPECT_LT(largest_bound_um(test.compiled), 0.01) << bell;
  }
}

}  // namespace
}  // namespace vernier::learned_test
