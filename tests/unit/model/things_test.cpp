// SPDX-License-Identifier: GPL-3.0-or-later
// Things that a tool point meets: the columns `same` and `on`, artefacts, and derivatives with things that
// follow the parameters.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/support/machines.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/thing_shape.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"

namespace vernier::things_test {

using namespace vernier::model;
namespace {

std::string xml(const std::string& artefacts) {
  return R"XML(<machine name="m"><variables>
  <static><sq value="0.05" nominal="0" unit="deg"/><len value="120.2" nominal="120" unit="mm"/>
    <tip value="2" unit="mm"/><BaseShift X="0.3" Y="-0.2" Z="0.1" rX="0.2" rY="0.3" rZ="-4"/></static>
  <machineaxes><X min="0" max="400"/><Y min="0" max="300"/><B rotary="true" min="-90" max="90"/></machineaxes>
  )XML" + artefacts +
         R"XML(</variables>
  <transforms branch="tool"><sixdof n="1" X="X" rZ="sq"/><sixdof n="2" Y="Y"/>
    <sixdof n="3" rY="B"/><sixdof n="4" Z="-len" rX="2"/></transforms></machine>)XML";
}
std::string error_of(const std::string& artefacts, const std::string& rows = "") {
  try {
    const Machine machine = parse_machine(xml(artefacts), "m.xml");
    if (!rows.empty()) parse_measurement("X[mm],Y[mm],B[deg]," + rows, "m.csv", machine);
  } catch (const text::InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Rows around one pose, by a fixed seed: touches of a thing of a few hundred mm.
std::string touches(const std::string& header, int count, const std::string& cell) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  std::string text = "X[mm],Y[mm],B[deg]," + header + "\n";
  for (int i = 0; i < count; ++i)
    text += fmt::format("{:.2f},{:.2f},{:.1f},{}\n", 150 + 80 * share(random), 100 + 80 * share(random),
                        -40 + 80 * share(random), cell);
  return text;
}

TEST(Artefacts, AreReadWithWhatIsKnown) {
  const Machine machine = parse_machine(
      xml(R"(<artefact name="S" type="sphere" radius="12.5mm" uradius="0.5um" tip="tip" side="inside"/>)"
          R"(<artefact name="P" type="point" x="1" y="2mm" z="3000um" u="2um" setup="left"/>)"),
      "m.xml");
  ASSERT_EQ(machine.artefacts.size(), 2u);
  EXPECT_EQ(*machine.artefacts[0].radius, 12.5);
  EXPECT_DOUBLE_EQ(machine.artefacts[0].u_radius, 0.5e-3);
  EXPECT_TRUE(machine.artefacts[0].inside);
  EXPECT_DOUBLE_EQ(machine.artefacts[1].place->at(2), 3);
  EXPECT_EQ(unknowns_of(machine.artefacts[0]), 4) << "three of the centre, and a radius that has a u";
  EXPECT_EQ(machine.artefacts[1].dimension(), 3u);
}

TEST(Artefacts, ThatAreWrongAreNamedWithTheirLine) {
  for (const auto& [artefact, word] : std::map<std::string, std::string>{
           {R"(<artefact type="point"/>)", "the artefact has no name"},
           {R"(<artefact name="A" type="cube"/>)", "cube"},
           {R"(<artefact name="A" type="point" radius="3"/>)", "only a sphere or a cylinder"},
           {R"(<artefact name="A" type="sphere" radius="3s"/>)", "3s"},
           {R"(<artefact name="A" type="sphere" radius="-3"/>)", "greater than 0"},
           {R"(<artefact name="A" type="point" x="1" y="2"/>)", "together"},
           {R"(<artefact name="A" type="plane" nx="1" ny="1" nz="0"/>)", "unit vector"},
           {R"(<artefact name="A" type="plane" tip="none"/>)", "none"},
           {R"(<artefact name="A" type="plane" tip="sq"/>)", "sq"},
           {R"(<artefact name="A" type="point"/><artefact name="A" type="line"/>)", "two artefacts"}}) {
    const std::string error = error_of(artefact);
    EXPECT_NE(error.find(word), std::string::npos) << error;
    EXPECT_NE(error.find("m.xml:"), std::string::npos) << error;
  }
}

TEST(Things, ThatARowCannotMeetAreNamed) {
  const std::string point = R"(<artefact name="A" type="point" setup="left"/>)";
  EXPECT_NE(error_of(point, "on\n0,0,0,B\n").find("no artefact of this name"), std::string::npos);
  EXPECT_NE(error_of(point, "on,setup\n0,0,0,A,right\n").find("\"left\""), std::string::npos);
  EXPECT_NE(error_of(point, "on,same,setup\n0,0,0,A,Q,left\n").find("empty one of the two cells"),
            std::string::npos);
  EXPECT_NE(error_of("", "same,distance[mm],from\n0,0,0,P,,\n9,0,0,,9,1\n").find("one end"),
            std::string::npos);
  EXPECT_EQ(error_of("", "x[mm],on\n0,0,0,1,word\n"), "accepted") << "a column of words of an older file";
}

TEST(Things, OfEveryTypeGiveTheirNumberOfReadingsAndTheirDerivatives) {
  const std::map<std::string, std::size_t> types = {
      {R"(type="point")", 3},
      {R"(type="point" x="90" y="80" z="-100" u="3mm")", 3},
      {R"(type="line" nx="0" ny="0.6" nz="0.8")", 2},
      {R"(type="plane" x="0" y="0" z="-90" nx="0.6" ny="0" nz="0.8" tip="tip")", 1},
      {R"(type="sphere" radius="60" x="190" y="140" z="-60" tip="tip")", 1},
      {R"(type="cylinder" radius="60" x="190" y="140" z="0" nx="0" ny="0" nz="1" tip="tip" side="inside")",
       1}};
  for (const auto& [type, readings] : types) {
    SCOPED_TRACE(type);
    const Machine machine = parse_machine(xml("<artefact name=\"A\" " + type + "/>"), "m.xml");
    const Measurement m = parse_measurement(touches("on", 9, "A"), "m.csv", machine);
    EXPECT_EQ(m.observations.size(), 9 * readings);
    // A thing with residuals follows to first order only where its own equations are linear (Kaufman): those
    // of points, of a direction that is known, and of places that are exact.
    support::expect_derivatives(machine, m, ParameterSet(machine, m.states.names(m.states.setup)));
  }
}

// With the point held each row follows the parameters alone; the rest is the point that follows them.
TEST(Things, HeldDerivativesAndTheUnknownsMakeTheWhole) {
  const Machine machine = parse_machine(xml(""), "m.xml");
  const Measurement m = parse_measurement(touches("same", 9, "A"), "m.csv", machine);
  const ParameterSet parameters(machine, m.states.names(m.states.setup));
  const Eigen::MatrixXd whole(linearise(machine, m, parameters).jacobian);
  const HeldLinearisation held = linearise_held(machine, m, parameters);
  const std::vector<EstimatedThing> things = estimate_things(machine, m, parameters);
  ASSERT_EQ(things.size(), 1u);
  ASSERT_EQ(held.by_unknown.cols(), 3);
  EXPECT_EQ(held.precision, Eigen::Vector3d::Zero());
  const Eigen::MatrixXd made =
      Eigen::MatrixXd(held.linear.jacobian) + held.by_unknown * things.front().follows;
  EXPECT_LT((made - whole).norm(), 1e-9 * whole.norm());
  EXPECT_GT((Eigen::MatrixXd(held.linear.jacobian) - whole).norm(), 0.1 * whole.norm());
}

TEST(Things, ASphereIsFoundWithItsRadius) {
  Artefact ball;
  ball.name = "S";
  ball.type = ArtefactType::kSphere;
  const Eigen::Vector3d centre(10, -20, 30);
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& n :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
        Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, -0.6, 0.8)})
    points.push_back(centre + 14.5 * n);
  const ThingShape shape = thing_starts(ball, points, 2, {0, 0, -1}).front();
  EXPECT_LT((shape.point - centre).norm(), 1e-9);
  EXPECT_NEAR(shape.radius, 12.5, 1e-9) << "without the tip of 2 mm";
}

// The error of meeting a point is in the readings of the point alone: a distance is between the points.
TEST(Things, ADistanceBetweenPointsIsOneReadingAndOfNoToolPoint) {
  const Machine machine = parse_machine(xml(""), "m.xml");
  const std::string head = "X[mm],Y[mm],B[deg],same,distance[mm],from,name\n", end = "100,0,0,Q,";
  const Measurement m = parse_measurement(
      head + "0,0,0,P,,,a\n0.5,0,0,P,,,b\n" + end + "100,a,c\n" + end + "100,b,d\n" + end + "101,b,e\n",
      "m.csv", machine);
  std::size_t distances = 0;
  const Eigen::VectorXd predicted = predict(machine, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    if (m.observations[i].kind != ObservationKind::kDistance) continue;
    ++distances;
    EXPECT_NEAR(predicted[static_cast<Eigen::Index>(i)], 99.75, 0.8)
        << "between the means, moved by the lengths";
  }
  EXPECT_EQ(distances, 2u) << "100 twice counts once, 101 is another reading";
}

TEST(Things, OfTwoFilesAreOneThingAndRowsKeepTheirs) {
  const Machine machine = parse_machine(xml(""), "m.xml");
  Measurement all = parse_measurement("X[mm],Y[mm],B[deg],same\n0,0,0,P\n0,0,0,Q\n", "a.csv", machine);
  append_measurement(all, parse_measurement("X[mm],Y[mm],B[deg],same\n1,0,0,Q\n", "b.csv", machine));
  ASSERT_EQ(all.things.size(), 2u);
  const Measurement kept = select_rows(all, {2, 1});
  EXPECT_EQ(kept.things[kept.thing[0]].label, "Q");
  EXPECT_EQ(kept.thing[0], kept.thing[1]);
}

}  // namespace
}  // namespace vernier::things_test
