// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/machine_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tools/create/machine_file.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/model/states.h"

namespace vernier::machine_plan_test {

using namespace vernier::create;
using namespace vernier::model;
using namespace vernier::text;
namespace {

std::vector<PlannedAxis> axes(const std::vector<std::string>& words) {
  std::vector<PlannedAxis> list;
  for (const std::string& word : words) list.push_back(parse_planned_axis(word));
  return list;
}
MachinePlan plan(const std::string& type, const std::vector<std::string>& words) {
  return plan_machine(type, axes(words), std::nullopt, std::nullopt);
}
std::string refusal(const std::function<void()>& job) {
  try {
    job();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Nominal tool point of a plan at these positions.
Eigen::Vector3d point(const MachinePlan& plan, const std::vector<double>& positions) {
  const Machine machine = nominal_machine(parse_machine(machine_file(plan), "m.xml"));
  States states = make_states(1, machine.axes.size(), {});
  for (std::size_t i = 0; i < positions.size(); ++i) states.axis[i][0] = positions[i];
  return forward(machine, states).position.col(0);
}

TEST(MachinePlan, SaysWhoCarriesWhom) {
  const std::vector<std::string> three = {"X:0:600", "Y:0:400", "Z:-300:0"};
  EXPECT_EQ(drawing(plan("gantry", three)), "bed > Y (beam) > X (carriage) > Z (ram) > tool");
  EXPECT_EQ(drawing(plan("c-frame", three)),
            "bed > Z (head) > tool\nbed > Y (saddle) > X (table) > workpiece");
  EXPECT_EQ(drawing(plan("arm", three)), "bed > X (column) > Z (carriage) > Y (arm) > tool");
  const std::vector<std::string> five = {"X:0:6", "Y:0:4", "Z:-3:0", "A:-90:90", "C:0:360"};
  EXPECT_EQ(drawing(plan("head-head", five)),
            "bed > Y (beam) > X (carriage) > Z (ram) > C (turning head) > A (turning head) > tool");
  EXPECT_EQ(
      drawing(plan("head-table", five)),
      "bed > X (carriage) > Z (ram) > A (turning head) > tool\nbed > Y (table slide) > C (turning table) > "
      "workpiece");
  EXPECT_EQ(drawing(plan("table-table", five)),
            "bed > Y (beam) > X (carriage) > Z (ram) > tool\nbed > A (turning table) > C (turning table) > "
            "workpiece");
}

TEST(MachinePlan, OrderOfTheSidesCanBeSaid) {
  const auto list = axes({"X:0:600", "Y:0:400", "Z:-300:0"});
  const MachinePlan given = plan_machine("gantry", list, std::vector<std::string>{"X", "Z"}, std::nullopt);
  EXPECT_EQ(drawing(given), "bed > X (carriage) > Z (ram) > tool\nbed > Y (beam) > workpiece");
  EXPECT_EQ(refusal([&] { plan_machine("gantry", list, std::vector<std::string>{"Q"}, std::nullopt); }),
            "\"Q\": no option --axis declares an axis of this name");
  EXPECT_EQ(
      refusal([&] {
        plan_machine("gantry", list, std::vector<std::string>{"X", "Y"}, std::vector<std::string>{"Y", "Z"});
      }),
      "\"Y\": this axis is both on the tool side and on the workpiece side");
}

TEST(MachinePlan, PositionsAreTheToolsWhateverCarriesWhat) {
  for (const char* type : {"gantry", "bridge", "column", "c-frame", "arm", "head-table", "table-table"}) {
    const MachinePlan made = plan(type, {"X:0:600", "Y:0:400", "Z:-300:0"});
    EXPECT_TRUE(point(made, {120, 70, -30}).isApprox(Eigen::Vector3d(120, 70, -30), 1e-12)) << type;
  }
  // ISO 841: a positive C turns the tool against the workpiece like a screw along Z, whichever of the two
  // turns.
  const MachinePlan table = plan("table-table", {"X:-300:300", "C:0:360"});
  EXPECT_TRUE(point(table, {100, 90}).isApprox(Eigen::Vector3d(0, 100, 0), 1e-12));
}

TEST(MachinePlan, CentreOfATurningAxisStaysWhereItIs) {
  MachinePlan made = plan("table-table", {"X:-300:300", "Y:-300:300", "C:0:360"});
  made.axes[2].centre = {40, -25, 0};
  EXPECT_TRUE(point(made, {40, -25, 77}).isApprox(point(made, {40, -25, 200}), 1e-12));
}

TEST(MachinePlan, RobotIsItsTable) {
  const MachinePlan made = plan_robot({}, default_arm());
  // Stretched out at zero: a2 + a3 along -x, d4 + d6 along -y, d1 - d5 up (the maker's figure of the zero
  // position).
  EXPECT_TRUE(point(made, {0, 0, 0, 0, 0, 0}).isApprox(Eigen::Vector3d(-1184.25, -290.7, 60.85), 1e-9))
      << point(made, {0, 0, 0, 0, 0, 0});
  EXPECT_NE(machine_file(made).find("the lengths are those of a UR10e"), std::string::npos)
      << "nobody asked for them";
  const std::vector<DhRow> scara = parse_dh_table(
      "joint,type,d[mm],a[m],alpha[deg]\n1,R,400,0.3,0\n2,R,0,0.25,180\n3,P,0,0,0\n", "dh.csv");
  const MachinePlan slides = plan_robot({}, scara);
  EXPECT_EQ(machine_file(slides).find("UR10e"), std::string::npos);
  EXPECT_EQ(slides.axes[2].name, "J3");
  EXPECT_TRUE(point(slides, {90, -90, 120}).isApprox(Eigen::Vector3d(250, 300, 280), 1e-9));
}

TEST(MachinePlan, RefusalsSayWhatToDo) {
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(refusal([] { plan("delta", {"X:0:1"}); }), "has closed loops"));
  EXPECT_TRUE(has(refusal([] { plan("lathe", {"X:0:1"}); }), "known types are gantry bridge"));
  EXPECT_TRUE(has(refusal([] { plan("gantry", {}); }), "no axis"));
  EXPECT_TRUE(has(refusal([] { plan("gantry", {"X:0:1", "X:0:2"}); }), "given twice"));
  EXPECT_TRUE(has(refusal([] { plan("gantry", {"Q:0:1"}); }), "Q:MIN:MAX:X"));
  EXPECT_TRUE(has(refusal([] { parse_planned_axis("X:0"); }), "NAME:MIN:MAX"));
  EXPECT_TRUE(has(refusal([] { parse_planned_axis("X:0:12,5"); }), "decimal sign is a point"));
  EXPECT_TRUE(has(refusal([] { parse_planned_axis("X:600:0"); }), "MAX must be greater"));
  EXPECT_TRUE(has(refusal([] { parse_planned_axis("x:0:600"); }), "formats reserve this name"));
  EXPECT_TRUE(has(refusal([] { parse_planned_axis("C:0:270:wrap"); }), "one turn"));
  EXPECT_TRUE(has(refusal([] { plan_robot(axes({"C:0:1"}), default_arm()); }), "1 axes, but 6 rows"));
  EXPECT_TRUE(has(refusal([] { parse_dh_row("1,2,3"); }), "theta,d,a,alpha"));
}

TEST(MachinePlan, NamesOfMeasuredColumnsAreRefused) {
  for (const char* name :
       {"setup", "clock", "block", "distance", "ix", "from", "corrected", "run", "x", "ua"})
    EXPECT_NE(refusal([&] {
                parse_planned_axis(std::string(name) + ":0:600:X");
              }).find("formats reserve this name"),
              std::string::npos)
        << name;
  EXPECT_EQ(refusal([&] {
              plan("gantry", {"X:0:600", "Y:0:400", "correctionX:-300:0:Z"});
            }),
            "\"correctionX\": measurement files use this name for a measured column");
}

TEST(MachinePlan, StationsAreRoundAndFew) {
  EXPECT_EQ(round_stations(0, 600, false), (std::vector<double>{0, 100, 200, 300, 400, 500, 600}));
  EXPECT_EQ(round_stations(-12.5, 330, false),
            (std::vector<double>{-12.5, 50, 100, 150, 200, 250, 300, 330}));
  EXPECT_EQ(round_stations(0, 360, true), (std::vector<double>{0, 45, 90, 135, 180, 225, 270, 315, 360}));
  for (const double travel : {0.3, 7.0, 99.0, 1234.0, 20000.0}) {
    const std::vector<double> stations = round_stations(-travel / 3, travel, false);
    EXPECT_GE(stations.size(), 4u) << travel;
    EXPECT_LE(stations.size(), 8u) << travel;
    EXPECT_TRUE(std::is_sorted(stations.begin(), stations.end())) << travel;
    EXPECT_EQ(stations.front(), -travel / 3);
    EXPECT_EQ(stations.back(), travel);
  }
}

TEST(MachinePlan, StationsAreThoseOfTheUser) {
  MachinePlan made = plan("gantry", {"X:0:90", "Y:-10:100", "Z:0:300"});
  plan_stations(made.axes, "X=25");
  plan_stations(made.axes, "Y=0,33.5,50");
  EXPECT_EQ(stations_of(made.axes[0]), (std::vector<double>{0, 25, 50, 75, 90}));
  EXPECT_EQ(stations_of(made.axes[1]), (std::vector<double>{-10, 0, 33.5, 50, 100}));
  EXPECT_EQ(stations_of(made.axes[2]), round_stations(0, 300, false));
  const Machine machine = parse_machine(machine_file(made), "m.xml");
  ASSERT_EQ(machine.tables.at(0).stations.size(), 5u);
  EXPECT_EQ(machine.tables.at(0).stations.at(3).loc, 75);
}

TEST(MachinePlan, StationsThatCannotBeAreRefused) {
  std::vector<PlannedAxis> list = axes({"X:0:600"});
  const auto says = [&](const std::string& words) { return refusal([&] { plan_stations(list, words); }); };
  EXPECT_NE(says("X"), "accepted");
  EXPECT_NE(says("Q=25").find("the machine has no axis Q"), std::string::npos);
  EXPECT_NE(says("X=0").find("a step is greater than 0"), std::string::npos);
  EXPECT_NE(says("X=0.01").find("a table has at most 2000 stations"), std::string::npos);
  EXPECT_NE(says("X=0,50,20").find("the positions must increase"), std::string::npos);
  EXPECT_NE(says("X=0,700").find("700 is outside the travel 0 to 600"), std::string::npos);
  EXPECT_NE(says("X=0;50").find("is not a number"), std::string::npos);
}

TEST(MachinePlan, DeclaresWhatTheToolTouches) {
  MachinePlan made = plan("gantry", {"X:0:235", "Y:0:235", "Z:0:250"});
  made.artefacts = {parse_planned_artefact("bed:plane"), parse_planned_artefact("a<b:sphere")};
  const Machine machine = parse_machine(machine_file(made), "m.xml");
  ASSERT_EQ(machine.artefacts.size(), 2u);
  EXPECT_EQ(machine.artefacts[0].name, "bed");
  EXPECT_EQ(machine.artefacts[0].type, ArtefactType::kPlane);
  EXPECT_EQ(machine.artefacts[1].name, "a<b");
  for (const char* words : {"bed", "bed:", ":plane", "bed:table", ""})
    EXPECT_NE(refusal([&] { parse_planned_artefact(words); }).find("NAME:TYPE"), std::string::npos) << words;
}

}  // namespace
}  // namespace vernier::machine_plan_test
