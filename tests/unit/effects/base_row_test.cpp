// SPDX-License-Identifier: GPL-3.0-or-later
// A place for rigid motions of the whole machine where the row at its base turns.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/unit/effects/candidates.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/effects/add.h"
#include "tools/effects/add_string.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"

namespace vernier::base_row_test {

using namespace vernier::diagnose;
using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
namespace {

using diagnose_test::machine_path;

constexpr std::uint64_t kSeed = 41;

const char* const kArm = R"xml(<machine name="arm">
  <variables>
    <static><a1 value="300" nominal="300"/><BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/></static>
    <machineaxes>
      <J1 rotary="true" min="-170" max="170"/><J2 rotary="true" min="-90" max="90"/>
      <J3 rotary="true" min="-90" max="90"/>
    </machineaxes>
  </variables>
  <transforms branch="tool">
    <!-- the <DH> rows -->
    <DH n="1" theta="J1" d="400" a="25" alpha="-90"/>
    <DH n="2" theta="J2" a="a1"/>
    <DH n="3" theta="J3" a="250"/>
  </transforms>
</machine>
)xml";

std::size_t rows_of(const Machine& machine) { return machine.tool.size() + machine.workpiece.size(); }

std::string with_added(const std::string& text, const std::string& add) {
  const Machine machine = with_base_row(parse_machine(text, "m.xml"));
  const Candidate candidate = make_candidate(machine, parse_add_string(add, machine, built_in_effects()));
  return add_to_machine_text(text, machine, candidate);
}

TEST(BaseRow, StandsInOnlyWhereTheBaseTurns) {
  for (const std::string& name : diagnose_test::reference_machines()) {
    const Machine machine = read_machine(machine_path(name));
    const bool turns = base_places(machine).empty();
    const bool expected = name == "ur10e" || name == "fibre_placement_dh" || name == "five_axis_bhead_ctable";
    EXPECT_EQ(turns, expected) << name;
    EXPECT_EQ(rows_of(with_base_row(machine)), rows_of(machine) + (turns ? 1 : 0)) << name;
  }
}

/// Its lengths shift every point alike and its angles turn them about the origin of the measuring frame, in
/// the sense that the branch has: whatever the pose.
TEST(BaseRow, MovesAllPointsRigidly) {
  for (const char* name : {"ur10e", "fibre_placement_dh", "five_axis_bhead_ctable"}) {
    const Machine machine = with_base_row(nominal_machine(read_machine(machine_path(name))));
    const std::vector<DofPlace> base = base_places(machine);
    ASSERT_EQ(base.size(), 3U) << name;
    std::mt19937_64 random(kSeed);
    const States states = diagnose_test::random_rows(machine, 20, random).states;
    const Eigen::Matrix3Xd before = forward(machine, states).position;
    const double sense = base[0].workpiece ? -1 : 1, step_deg = 1e-3;
    for (std::size_t d = 0; d < 6; ++d) {
      Machine moved = machine;
      auto& branch = base[0].workpiece ? moved.workpiece : moved.tool;
      branch[base[0].transform].dof[d] = parse_expression(d < 3 ? "1" : "0.001");
      const Eigen::Matrix3Xd change = sense * (forward(moved, states).position - before);
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(d % 3));
      for (Eigen::Index i = 0; i < change.cols(); ++i) {
        const Eigen::Vector3d turned = axis.cross(before.col(i)) * step_deg * 3.14159265358979 / 180;
        const Eigen::Vector3d expected = d < 3 ? axis : turned;
        // The square of the angle, 3e-10, over some metres.
        EXPECT_LT((change.col(i) - expected).norm(), 1e-5) << name << " " << d << " seed " << kSeed;
      }
    }
  }
}

TEST(BaseRow, IsWrittenOnceATermIsPutIntoIt) {
  const std::string first = with_added(kArm, "base-drift:dof=X");
  EXPECT_NE(
      first.find("    <!-- the <DH> rows -->\n    <sixdof n=\"0\" X=\"base_drift_X0*t\"/>\n    <DH n=\"1\""),
      std::string::npos)
      << first;
  const std::string second = with_added(first, "base-drift:branch=tool,transform=0,dof=X,form=step,runs=b");
  EXPECT_NE(second.find("<sixdof n=\"0\" X=\"base_drift_X0*t+base_drift_X0_2*run(&quot;b&quot;)\"/>"),
            std::string::npos)
      << second;
  EXPECT_EQ(with_added(kArm, "backlash:axis=J1").find("sixdof"), std::string::npos);
}

TEST(BaseRow, IsTheLastOfAWorkpieceBranchWhoseTableTurns) {
  const std::string text = read_file(machine_path("five_axis_bhead_ctable"));
  const Machine before = parse_machine(text, "five.xml");
  const Machine after = parse_machine(with_added(text, "tool-radius"), "five.xml");
  ASSERT_EQ(after.workpiece.size(), before.workpiece.size() + 1);
  EXPECT_EQ(after.workpiece.back().n, before.workpiece.back().n + 1);
  for (std::size_t d = 0; d < 3; ++d)
    EXPECT_EQ(after.workpiece.back().text[d], std::string("-tool_radius*n") + "xyz"[d]);
  EXPECT_EQ(after.workpiece.back().text[3], "0");
}

/// Readings of the arm with an error of its base, mm along `direction`, and noise of 20 um.
Measurement readings(const Machine& machine, const Eigen::Vector3d& direction) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> angle(-80, 80);
  std::string text = "J1[deg],J2[deg],J3[deg],t[s],x[mm],y[mm],z[mm],u[mm],run\n";
  std::string poses = "J1[deg],J2[deg],J3[deg],x[mm]\n";
  std::vector<std::string> cells;
  for (int i = 0; i < 200; ++i) {
    cells.push_back(fmt::format("{:.3f},{:.3f},{:.3f}", angle(random), angle(random), angle(random)));
    poses += cells.back() + ",0\n";
  }
  const Eigen::Matrix3Xd point = forward(machine, parse_measurement(poses, "p.csv", machine).states).position;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d at = point.col(i) + direction * i / 200;
    text += fmt::format("{},{},{:.5f},{:.5f},{:.5f},0.02,r{}\n", cells[static_cast<std::size_t>(i)], 10 * i,
                        at[0] + noise(random), at[1] + noise(random), at[2] + noise(random), i / 50);
  }
  return parse_measurement(text, "m.csv", machine);
}

TEST(BaseRow, LetsADriftOfARobotBeNamed) {
  const Machine machine = parse_machine(kArm, "arm.xml");

  const Diagnosis answer = diagnose::diagnose(kArm, machine, readings(machine, {0, 0.2, 0}));

  ASSERT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(answer.ladder.back().effect, "base-drift");
  EXPECT_NE(answer.ladder.back().add.find("branch=tool,transform=0,dof=Y"), std::string::npos)
      << answer.ladder.back().add;
  EXPECT_EQ(answer.ladder.front().text.find("sixdof"), std::string::npos);
  const Machine found = parse_machine(answer.machine_text, "found.xml");
  EXPECT_EQ(found.tool.front().n, 0);
  // 0.2 mm in 2000 s; of 600 readings of 20 um the slope is known to 3e-6 mm/s or better.
  const Static& slope = found.statics[*found.find_static("base_drift_Y0")];
  EXPECT_NEAR(slope.value, 1e-4, 1e-5);
  EXPECT_EQ(with_added(kArm, answer.ladder.back().add).find("<sixdof n=\"0\" Y="),
            with_added(kArm, "base-drift:dof=X").find("<sixdof n=\"0\" X="));
}

/// Where a row of the file does the same, it is the one that is named, and no row is written.
TEST(BaseRow, StandsBehindTheRowsOfTheFile) {
  const Machine machine = parse_machine(kArm, "arm.xml");

  const Diagnosis answer = diagnose::diagnose(kArm, machine, readings(machine, {0, 0, 0.2}));

  ASSERT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_NE(answer.ladder.back().add.find("branch=tool,transform=1,dof=d"), std::string::npos)
      << answer.ladder.back().add;
  EXPECT_EQ(answer.machine_text.find("sixdof"), std::string::npos);
}

}  // namespace
}  // namespace vernier::base_row_test
