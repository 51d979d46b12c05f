// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/closed.h"

#include <gtest/gtest.h>

#include "tests/support/machines.h"
#include "tests/unit/kinematics/machines.h"
#include "tools/kinematics/at.h"
#include "tools/model/machine_reader.h"

namespace vernier::closed_test {

using namespace vernier::kinematics;
using namespace vernier::model;
using namespace vernier::text;
namespace {

TEST(ClosedSolution, IsThatOfTheNewtonIteration) {
  std::mt19937_64 random(22);
  const Machine machine = nominal_machine(column_machine(random));
  const States states = random_states(machine, 50, random);
  const auto closed = closed_solution(machine, select_states(states, {0}));
  ASSERT_TRUE(closed);
  EXPECT_NEAR(closed->condition, 1, 1e-12);
  const Eigen::MatrixXd q = solve_closed(*closed, forward(machine, states).position);
  for (Eigen::Index i = 0; i < 50; ++i)
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(q(static_cast<Eigen::Index>(a), i), states.axis[a][i], 1e-10);
  // The table's axes move the tool point backwards.
  EXPECT_NEAR(closed->jacobian(0, 0), -1, 1e-15);
  EXPECT_NEAR(closed->jacobian(2, 2), 1, 1e-15);
}

TEST(ClosedSolution, ExistsForSkewAxesAndRotaryAxesAtRest) {
  const Machine machine = parse_machine(
      R"XML(<machine><variables><static><s value="0.1"/></static><machineaxes><X/><Y/><Z/><C rotary="true"/>
      </machineaxes></variables><transforms branch="workpiece"><sixdof n="1" Y="Y" rZ="C"/></transforms>
      <transforms branch="tool"><sixdof n="1" X="X" Z="2*Z+s*X" rX="20"/><DH n="2" d="5" a="3"/></transforms>
      </machine>)XML",
      "skew.xml");
  std::mt19937_64 random(23);
  States states = random_states(machine, 10, random);
  states.axis[3].setConstant(30);
  const auto closed = closed_solution(machine, select_states(states, {0}));
  ASSERT_TRUE(closed);
  const Eigen::MatrixXd q = solve_closed(*closed, forward(machine, states).position);
  for (Eigen::Index i = 0; i < 10; ++i) EXPECT_NEAR(q(2, i), states.axis[2][i], 1e-10);
}

TEST(ClosedSolution, IsDeniedWhereAnAxisTurnsOrBendsTheChain) {
  const auto denied = [](const std::string& chain) {
    const Machine machine = parse_machine(
        "<machine><variables><machineaxes><X/><Y/></machineaxes></variables>"
        "<transforms branch=\"tool\">" +
            chain + "</transforms></machine>",
        "x.xml");
    return !closed_solution(machine, make_states(1, 2, {}));
  };
  EXPECT_FALSE(denied(R"X(<sixdof n="1" X="X" Y="Y"/>)X"));
  EXPECT_TRUE(denied(R"X(<sixdof n="1" X="X" Y="Y" rZ="0.001*X"/>)X"));
  EXPECT_TRUE(denied(R"X(<sixdof n="1" X="X+1e-6*X*Y" Y="Y"/>)X"));
  EXPECT_TRUE(denied(R"X(<sixdof n="1" X="X+sin(X)" Y="Y"/>)X"));
  EXPECT_TRUE(denied(R"X(<sixdof n="1" X="X+Y" Y="X+Y"/>)X"));  // the axes are one
  EXPECT_TRUE(closed_solution(support::full_machine(), make_states(1, 5, {20})) == std::nullopt);
}

TEST(StateAt, ReadsWordsAndRefusesOthers) {
  const Machine machine = support::full_machine();
  const States states = state_at(machine, "X=12.5, dirX=-1,T=25,vY=3,run=b");
  EXPECT_EQ(states.axis[0][0], 12.5);
  EXPECT_EQ(states.direction[0][0], -1);
  EXPECT_EQ(states.input[0][0], 25);
  EXPECT_EQ(states.velocity[1][0], 3);
  EXPECT_EQ(states.run_names[0], "b");
  EXPECT_EQ(state_at(machine, "").input[0][0], 20);
  for (const char* wrong : {"Q=1", "X", "X=", "X=1x", "X=1,,Y=2", "sq=1", "lXx=1"})
    EXPECT_THROW(state_at(machine, wrong), InputError) << wrong;
}

}  // namespace
}  // namespace vernier::closed_test
