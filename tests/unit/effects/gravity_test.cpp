// SPDX-License-Identifier: GPL-3.0-or-later
// What gravity does along a chain, against the chain itself: the forward solution cut off at each transform.
#include "tools/effects/gravity.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/effects/candidates.h"
#include "tools/effects/add_string.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::gravity_test {

using namespace vernier::effects;
using namespace vernier::model;
namespace {

using diagnose_test::machine_path;

// An arm of four joints, none parallel to the next, on a base that leans; a slide carries the last link out.
const char* const kArm = R"(<machine name="arm" gravity="0 0 -1">
  <variables><static><k value="0" nominal="0" unit="deg"/></static>
  <machineaxes><A rotary="true" min="-90" max="90"/><B rotary="true" min="-90" max="90"/>
    <C rotary="true" min="-90" max="90"/><D rotary="true" min="-90" max="90"/><S min="0" max="200"/></machineaxes>
  </variables>
  <transforms branch="tool"><sixdof n="1" Z="400" rY="30" rX="12"/><sixdof n="2" rY="A"/><sixdof n="3" rX="-B"/>
    <sixdof n="4" rZ="2*C+10"/><sixdof n="5" Z="-300" rY="D"/><sixdof n="6" X="S+250" rZ="33"/></transforms>
  </machine>)";

Machine machine_of(const std::string& name) {
  return name == "arm" ? parse_machine(kArm, "arm.xml") : read_machine(machine_path(name));
}

/// Random positions within the ranges (a turn where there is none).
States random_states(const Machine& machine, std::size_t rows) {
  std::mt19937_64 random(20260401);
  std::uniform_real_distribution<double> unit(0, 1);
  States states = make_states(rows, machine);
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    for (double& q : states.axis[a]) {
      const double low = machine.axes[a].min.value_or(-180), high = machine.axes[a].max.value_or(180);
      q = low + (high - low) * unit(random);
    }
  return states;
}

/// The tool branch up to a degree of freedom, as a machine of its own.
Machine cut_off(Machine machine, const DofPlace& place) {
  machine.workpiece.clear();
  machine.tool.resize(place.transform + 1);
  Transform& last = machine.tool.back();
  const bool dh = last.kind != TransformKind::kSixDof;
  // DH acts as d, theta, a, alpha.
  const std::array<std::size_t, 6> order =
      dh ? std::array<std::size_t, 6>{1, 0, 2, 3, 4, 5} : std::array<std::size_t, 6>{0, 1, 2, 3, 4, 5};
  for (std::size_t d = 0; d < last.dof_count(); ++d)
    if (order[d] > order[place.dof]) last.dof[d] = make_number(0);
  return machine;
}

Column values(const Machine& machine, const Wave& wave, const States& states) {
  return evaluate(machine, *parse_expression_for(machine, to_text(*wave.expression(machine))), states);
}

class GravityAlong : public ::testing::TestWithParam<const char*> {};

TEST_P(GravityAlong, HasTheDirectionThatTheChainTurnsItTo) {
  const Machine nominal = nominal_machine(machine_of(GetParam()));
  const GravityChain gravity(nominal);
  const States states = random_states(nominal, 20);
  const Eigen::Vector3d down(nominal.gravity[0], nominal.gravity[1], nominal.gravity[2]);
  for (const DofPlace& place : all_places(nominal)) {
    if (place.workpiece) continue;
    const auto direction = gravity.direction(place);
    ASSERT_TRUE(direction) << place.transform << " " << place.dof;
    const Poses poses = forward(cut_off(nominal, place), states);
    for (std::size_t i = 0; i < 3; ++i) {
      const Column value = values(nominal, (*direction).at(i), states);
      for (std::size_t row = 0; row < poses.rotation.size(); ++row)
        // Six digits a number in an expression, of up to ten terms.
        EXPECT_NEAR(value[static_cast<Eigen::Index>(row)],
                    poses.rotation[row].col(static_cast<Eigen::Index>(i)).dot(down), 1e-5);
    }
  }
}

TEST_P(GravityAlong, HasTheMomentOfAMassAboutEveryJoint) {
  const Machine nominal = nominal_machine(machine_of(GetParam()));
  const GravityChain gravity(nominal);
  const AxisPlaces axes(nominal);
  const States states = random_states(nominal, 20);
  const Eigen::Vector3d down(nominal.gravity[0], nominal.gravity[1], nominal.gravity[2]);
  std::size_t told = 0;
  for (std::size_t a = 0; a < nominal.axes.size(); ++a) {
    const auto& own = axes.own(a);
    if (!own || !nominal.axes[a].rotary || own->workpiece) continue;
    const Poses at = forward(cut_off(nominal, *own), states);
    const auto local = static_cast<Eigen::Index>(local_axis(nominal, *own));
    for (std::size_t end = own->transform; end < nominal.tool.size(); ++end) {
      const auto wave = gravity.moment(*own, end);
      if (!wave) continue;
      Machine cut = nominal;
      cut.workpiece.clear();
      cut.tool.resize(end + 1);
      const Eigen::Matrix3Xd mass = forward(cut, states).position;
      Eigen::VectorXd expected(mass.cols());
      for (Eigen::Index row = 0; row < mass.cols(); ++row)
        expected[row] = at.rotation[static_cast<std::size_t>(row)].col(local).dot(
            (mass.col(row) - at.position.col(row)).cross(down));
      const Eigen::VectorXd value = values(nominal, *wave, states).matrix();
      EXPECT_LE(value.cwiseAbs().maxCoeff(), 1 + 1e-5);
      // In parts of the reach, a length that no pose changes.
      const double reach = expected.dot(value) / std::max(value.squaredNorm(), 1e-30);
      EXPECT_LE((expected - reach * value).norm(), 1e-5 * expected.norm() + 1e-3)
          << nominal.axes[a].name << end;
      told += expected.norm() > 1 ? 1 : 0;
    }
  }
  EXPECT_GE(told, 3U);
}

INSTANTIATE_TEST_SUITE_P(Chains, GravityAlong, ::testing::Values("arm", "ur10e", "fibre_placement_dh"),
                         [](const auto& chain) { return std::string(chain.param); });

TEST(Gravity, OfParallelJointsIsASineOfTheirSum) {
  const Machine machine = machine_of("ur10e");
  Choice choice = parse_add_string("joint-compliance:axis=J2,form=mass,mass=9", machine, built_in_effects());
  const Candidate candidate = make_candidate(machine, choice);
  EXPECT_NE(candidate.terms.at(0).text.find("cos(J2+J3)"), std::string::npos) << candidate.terms[0].text;
  EXPECT_EQ(add_string(machine, choice),
            add_string(machine, parse_add_string(add_string(machine, choice), machine, built_in_effects())));
}

// TPOINT's TF, by hand: towards the horizon by the sine of the zenith distance, on both axes.
TEST(Gravity, BendsATubeByItsDirectionAcross) {
  const Machine machine =
      parse_machine(R"(<machine name="t"><variables><static><c value="0"/></static><machineaxes>
    <H rotary="true" min="-80" max="80"/><D rotary="true" min="-25" max="80"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" rY="40"/><sixdof n="2" rZ="-H"/><sixdof n="3" rY="D-90"/>
    <sixdof n="4" Z="1000+c"/></transforms></machine>)",
                    "t.xml");
  const Candidate tube = make_candidate(
      machine,
      parse_add_string("gravity-sag:transform=4,dof=rX,form=tube,toward=Z", machine, built_in_effects()));
  ASSERT_EQ(tube.terms.size(), 2U);
  EXPECT_EQ(tube.unknowns.size(), 1U);
  States states = random_states(machine, 10);
  Machine known = machine;
  known.statics.at(add_unknowns(known, tube, {}).at(0)).value = 1;
  constexpr double kDeg = 3.14159265358979323846 / 180;
  for (std::size_t i = 0; i < 2; ++i) {
    const Column bend = evaluate(known, *parse_expression_for(known, tube.terms[i].text), states);
    for (Eigen::Index row = 0; row < bend.size(); ++row) {
      const double h = states.axis[0][row] * kDeg, d = states.axis[1][row] * kDeg, c = 40 * kDeg;
      const double expected = i == 0 ? -std::sin(h) * std::sin(c)
                                     : std::cos(h) * std::sin(c) * std::sin(d) - std::cos(c) * std::cos(d);
      EXPECT_NEAR(bend[row], expected, 3e-6);  // six digits a number
    }
  }
}

TEST(Gravity, IsRefusedWhereTheChainIsNoProductOfTurns) {
  const Machine machine =
      parse_machine(R"(<machine name="m"><variables><static><c value="0"/></static><machineaxes>
    <A rotary="true" min="-80" max="80"/><B rotary="true" min="-25" max="80"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" rY="A+0.001*A^2"/><sixdof n="2" rX="B" Z="100+c"/>
    <sixdof n="3" Z="100"/></transforms></machine>)",
                    "m.xml");
  const GravityChain gravity(machine);
  EXPECT_FALSE(gravity.direction({false, 1, 3}));
  EXPECT_FALSE(gravity.moment({false, 1, 3}, 2));
  EXPECT_THROW(make_candidate(machine, parse_add_string("joint-compliance:axis=B,form=bothways", machine,
                                                        built_in_effects())),
               text::InputError);
  for (const char* wrong :
       {"joint-compliance:axis=B,form=across,toward=Q", "joint-compliance:axis=B,form=mass,mass=17"})
    EXPECT_THROW(parse_add_string(wrong, machine, built_in_effects()), text::InputError) << wrong;
}

}  // namespace
}  // namespace vernier::gravity_test
