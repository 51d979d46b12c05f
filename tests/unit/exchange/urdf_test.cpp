// SPDX-License-Identifier: GPL-3.0-or-later
// URDF of a calibrated arm: its joints, multiplied together, are the chain.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <random>
#include <sstream>

#include "tools/create/machine_file.h"
#include "tools/create/urdf.h"
#include "tools/exchange/tip_link.h"
#include "tools/exchange/urdf_arm.h"
#include "tools/format/urdf_chain.h"
#include "tools/model/chain/chain.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::urdf_test {

using namespace vernier::model;
using Eigen::Isometry3d;
using Eigen::Vector3d;
namespace {

/// A shoulder, an elbow whose range has no zero, a slide and a wrist, with errors in every place; `droop`: an
/// error that changes with the elbow.
std::string arm(const std::string& droop = "0") {
  return R"xml(<machine name="arm"><variables><static><o value="0.4" nominal="0" unit="deg"/>
    <a value="0.3" nominal="0" unit="mm"/><k value="0.05" nominal="0" unit="mm"/></static>
    <machineaxes><J1 rotary="true" min="-170" max="170"/><J2 rotary="true" min="20" max="140"/>
    <S min="0" max="300"/><J4 rotary="true" min="-180" max="180"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" X="a" Z="300" rX="o" rZ="J1+o"/>
    <sixdof n="2" X="50" rY="J2" rX="o" Z="2*a"/><sixdof n="3" Z="400" rX="0.1+o" X=")xml" +
         droop + R"xml("/><dh n="4" theta="12+o" d="S" a="20+a" alpha="35"/>
    <sixdof n="5" rZ="J4" rX="90"/><sixdof n="6" X="3" Z="120+a"/></transforms></machine>)xml";
}

Vector3d numbers(const char* text) {
  std::istringstream in(text);
  Vector3d v;
  in >> v[0] >> v[1] >> v[2];
  return v;
}

/// Pose of the tool by the definitions of the URDF page: origin, then the motion about or along the axis.
Isometry3d by_urdf(const std::string& text, const std::vector<double>& positions) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(text.c_str()));
  Isometry3d pose = Isometry3d::Identity();
  std::size_t at = 0;
  for (const pugi::xml_node& joint : document.child("robot").children("joint")) {
    const Vector3d rpy = numbers(joint.child("origin").attribute("rpy").value());
    pose.translate(1000 * numbers(joint.child("origin").attribute("xyz").value()));
    pose.rotate(Eigen::AngleAxisd(rpy[2], Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy[1], Vector3d::UnitY()) *
                Eigen::AngleAxisd(rpy[0], Vector3d::UnitX()));
    const std::string type = joint.attribute("type").value();
    if (type == "fixed") continue;
    const Vector3d axis = numbers(joint.child("axis").attribute("xyz").value());
    const double by = positions[at++];
    if (type == "prismatic")
      pose.translate(by * axis);
    else
      pose.rotate(Eigen::AngleAxisd(by / 57.29577951308232, axis));
  }
  return pose;
}

TEST(Urdf, JointsKeepTheNamesOfTheFileThatTheMachineCameFrom) {
  std::string text = arm();
  text.replace(text.find("<J1 "), 4, "<J1 joint=\"a1\" ");
  const Machine machine = parse_machine(text, "arm.xml");
  const std::string file =
      exchange::urdf_arm(machine, make_states(1, machine), exchange::joint_names(machine, text)).text;
  EXPECT_NE(file.find("<joint name=\"a1\""), std::string::npos);
  EXPECT_EQ(file.find("<joint name=\"J1\""), std::string::npos);
  EXPECT_NE(file.find("<joint name=\"J2\""), std::string::npos);
}

TEST(Urdf, JointsMultipliedTogetherAreTheChain) {
  const Machine machine = parse_machine(arm(), "arm.xml");
  const exchange::UrdfFile file = exchange::urdf_arm(machine, make_states(1, machine));
  EXPECT_LT(file.worst_um, 0.001);
  std::mt19937_64 random(3);
  double worst = 0, turned = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> at;
    States states = make_states(1, machine);
    for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
      at.push_back(
          std::uniform_real_distribution<double>(*machine.axes[axis].min, *machine.axes[axis].max)(random));
      states.axis[axis][0] = at.back();
    }
    const Poses real = forward(machine, states);
    const Isometry3d pose = by_urdf(file.text, at);
    worst = std::max(worst, (pose.translation() - real.position.col(0)).norm());
    turned = std::max(turned, (pose.rotation() - real.rotation[0]).norm());
  }
  EXPECT_LT(worst, 1e-6);  // twelve digits of 0.5 m
  EXPECT_LT(turned, 1e-9);
}

TEST(Urdf, NamesTheJointsThatTheFitDidNotDetermine) {
  Machine machine = parse_machine(arm(), "arm.xml");
  EXPECT_EQ(exchange::urdf_arm(machine, make_states(1, machine)).text.find("do not determine"),
            std::string::npos);
  auto fitted = std::make_shared<FitRecord>();
  fitted->parameters = {"o", "a", "k"};
  fitted->origins = {"data", "convention", "prior"};
  machine.fitted = fitted;
  const exchange::UrdfFile file = exchange::urdf_arm(machine, make_states(1, machine));
  // `a` is in the transforms of J1, J2, S and of the tool.
  EXPECT_EQ(exchange::joints_text(file.undetermined), "J1 (a), J2 (a), S (a), tool (a)");
  EXPECT_NE(file.text.find("<!-- The readings of the fit do not determine these joints completely"),
            std::string::npos);
  EXPECT_NE(file.text.find("J1 (a), J2 (a), S (a), tool (a)."), std::string::npos);
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(file.text.c_str()));
}

TEST(Urdf, IsReadAsTheArmOfItsAxes) {
  const Machine machine = parse_machine(arm(), "arm.xml");
  const std::string text = exchange::urdf_arm(machine, make_states(1, machine)).text;
  const create::UrdfArm read = create::parse_urdf(text, "robot.urdf", "tool");
  ASSERT_EQ(read.axes.size(), 4U);
  EXPECT_EQ(read.axes[1].name, "J2");
  EXPECT_NEAR(read.axes[1].min, 20, 1e-9);
  EXPECT_EQ(read.tip, "tool");
}

TEST(Urdf, StatesWhatIdealJointsLeave) {
  const Machine machine = parse_machine(arm("k*sin(J2)"), "arm.xml");
  const exchange::UrdfFile file = exchange::urdf_arm(machine, make_states(1, machine));
  // 50 um times the range of sin from 20 to 140 deg, 0.34 to 1: up to 33 um, and a part of it turns the axis.
  EXPECT_GT(file.worst_um, 5);
  EXPECT_LT(file.worst_um, 60);
}

// The joints at the reference pose alone left more than the joints of a machine without the compliance.
TEST(Urdf, JointsAreFittedToTheMachineInTheMeasuredRanges) {
  Machine machine = parse_machine(arm("k*sin(J2)"), "arm.xml");
  const exchange::UrdfFile whole = exchange::urdf_arm(machine, make_states(1, machine));
  // A constant offset alone leaves the standard deviation of 50 um sin(J2) over 20 to 140 deg: 8.8 um. The
  // joints at the reference pose have the value at 80 deg: at least 12 um.
  EXPECT_LT(whole.rms_um, 8.9);
  EXPECT_GT(whole.rms_nominal_um, 1000);  // 0.4 deg over 0.5 m
  EXPECT_FALSE(whole.measured);
  auto fitted = std::make_shared<FitRecord>();
  fitted->measured = {{"J1", -90, 90}, {"J2", 60, 80}, {"S", 0, 300}, {"J4", -90, 90}};
  machine.fitted = fitted;
  const exchange::UrdfFile part = exchange::urdf_arm(machine, make_states(1, machine));
  EXPECT_TRUE(part.measured);
  // 50 um sin(J2) over 60 to 80 deg: a standard deviation of 1.8 um.
  EXPECT_LT(part.rms_um, 1.9);
}

/// An arm as its maker describes it: frames at angles, an axis that is no axis of the frame, a range without
/// zero, a slide, a fixed joint between, a joint without origin, meshes, a sensor beside the arm.
std::string maker(const std::string& flange) {
  return R"xml(<?xml version="1.0"?>
<!-- <robot> of the maker -->
<robot name="maker">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="world"/><link name="base"/>
  <joint name="stand" type="fixed"><parent link="world"/><child link="base"/>
    <origin xyz="0.1 -0.2 0.05" rpy="0 0 0.3"/></joint>
  <link name="shoulder"><visual><geometry><mesh filename="package://maker/shoulder.stl"/></geometry></visual></link>
  <joint name="shoulder_pan" type="revolute"><parent link="base"/><child link="shoulder"/>
    <origin rpy="0.2 0 0.7" xyz="0 0 0.4"/><axis xyz="0 0.1 1"/>
    <limit lower="-2.9" upper="2.9" effort="120" velocity="2.1"/></joint>
  <link name="upper"/>
  <joint name="lift" type="revolute"><parent link="shoulder"/><child link="upper"/>
    <origin xyz="0.05 0.1 0.02" rpy="1.2 0.4 -0.6"/><axis xyz="0 0 -1"/>
    <limit lower="0.4" upper="2.4" effort="110" velocity="2"/></joint>
  <link name="bracket"/>
  <joint name="bracket_fix" type="fixed"><parent link="upper"/><child link="bracket"/><origin xyz="0.3 0 0.01"/></joint>
  <link name="carriage"/>
  <joint name="slide" type="prismatic"><parent link="bracket"/><child link="carriage"/>
    <origin xyz="0 0.02 0" rpy="0 0.1 0"/><axis xyz="1 0 0"/><limit lower="0" upper="0.3" effort="9" velocity="1"/></joint>
  <link name="wrist"/>
  <joint name="wrist_roll" type="continuous"><parent link="carriage"/><child link="wrist"/><axis xyz="0 1 0"/></joint>
  <link name="camera"/>
  <joint name="camera_fix" type="fixed"><parent link="carriage"/><child link="camera"/><origin xyz="0 0 0.1"/></joint>
)xml" + flange +
         "</robot>\n";
}

const char* const kFlange = R"xml(  <link name="flange"/>
  <joint name="flange_fix" type="fixed"><parent link="wrist"/><child link="flange"/><origin xyz="0.02 0.09 0"/></joint>
  <link name="tool0"/>
  <joint name="tool_fix" type="fixed"><parent link="flange"/><child link="tool0"/>
    <origin xyz="0 0 0.03" rpy="0 1.5 0"/></joint>
)xml";

/// The machine file of `vernier new` for that arm, with errors of all its statics.
std::string calibrated(const std::string& urdf, const std::string& tip) {
  const create::UrdfArm arm = create::parse_urdf(urdf, "maker.urdf", tip);
  create::MachinePlan plan = create::plan_robot(arm.axes, arm.rows);
  plan.name = arm.name;
  plan.base = arm.base;
  plan.link = arm.tip;
  plan.link_frame = arm.tip_frame;
  plan.tool = arm.tool({12, -7, 80});
  return create::machine_file(plan);
}

/// Draws an error of each static that has a nominal value: 0.4 mm, 0.1 deg; `tool`: of the tool point, mm.
void disturb(Machine& machine, double tool) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal(0, 1);
  for (Static& one : machine.statics) {
    if (one.name.starts_with("TP"))
      one.nominal = one.value, one.value += tool;
    else if (one.nominal)
      one.value = *one.nominal + normal(random) * (one.unit == "mm" ? 0.4 : one.unit == "deg" ? 0.1 : 0);
  }
}

/// Frame of a link in the root by the definitions of the URDF page, with the joints by their names.
Isometry3d frame_of(const std::string& text, const std::string& link,
                    const std::map<std::string, double>& at) {
  Isometry3d pose = Isometry3d::Identity();
  for (const format::UrdfJoint& joint : format::UrdfTree(text, "robot.urdf").way_to(link)) {
    pose = pose * joint.origin;
    if (joint.slides())
      pose.translate(at.at(joint.name) * joint.axis);
    else if (joint.moves())
      pose.rotate(Eigen::AngleAxisd(at.at(joint.name) / 57.29577951308232, joint.axis));
  }
  return pose;
}

/// Largest distance of the tool point in the URDF from that of the machine, mm, at 200 poses.
double worst_of(const exchange::UrdfFile& file, const Machine& machine,
                const std::vector<std::string>& names) {
  std::mt19937_64 random(5);
  const std::array<double, 6>& shift = machine.base_shifts.at(0).value;
  Isometry3d base(Eigen::Translation3d(shift[0], shift[1], shift[2]));
  for (int k = 0; k < 3; ++k)
    base.rotate(
        Eigen::AngleAxisd(shift[3 + static_cast<std::size_t>(k)] / 57.29577951308232, Vector3d::Unit(k)));
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    std::map<std::string, double> at;
    States states = make_states(1, machine);
    for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
      states.axis[axis][0] = std::uniform_real_distribution<double>(
          machine.axes[axis].min.value_or(-180), machine.axes[axis].max.value_or(180))(random);
      at[names[axis]] = states.axis[axis][0];
    }
    const Vector3d real = base * Vector3d(forward(machine, states).position.col(0));
    const Vector3d held =
        frame_of(file.text, file.original->tip, at) * Vector3d(file.original->tool_mm.data());
    worst = std::max(worst, (real - held).norm());
  }
  return worst;
}

TEST(UrdfOriginal, KeepsEverythingButTheOriginsOfItsJoints) {
  const std::string urdf = maker(kFlange), text = calibrated(urdf, "tool0");
  const exchange::UrdfOriginal original{urdf, "maker.urdf", "tool0"};
  Machine machine = parse_machine(text, "maker.xml");
  const std::vector<std::string> names = exchange::joint_names(machine, text);
  // GIVEN the nominal arm THEN no origin changes
  const exchange::UrdfFile nominal = exchange::urdf_arm(machine, make_states(1, machine), names, &original);
  EXPECT_EQ(nominal.original->text, urdf);
  EXPECT_NEAR(nominal.original->tool_mm[2], 80, 1e-6);
  EXPECT_LT(worst_of(nominal, machine, names), 1e-6);
  // GIVEN errors of all joints and a tool 40 mm beside its nominal place
  disturb(machine, 40);
  const exchange::UrdfFile file = exchange::urdf_arm(machine, make_states(1, machine), names, &original);
  EXPECT_LT(worst_of(file, machine, names), 1e-6);
  EXPECT_EQ(file.original->tip, "tool0");
  EXPECT_FALSE(file.original->added_tip);
  // THEN the frames of the links are where they were, to the errors of the joints: the tool is no error of
  // them
  const format::UrdfTree before(urdf, "maker.urdf"), after(file.original->text, "robot.urdf");
  const std::vector<format::UrdfJoint> was = before.way_to("tool0"), is = after.way_to("tool0");
  ASSERT_EQ(is.size(), was.size());
  for (std::size_t i = 0; i < is.size(); ++i) {
    EXPECT_EQ(is[i].name, was[i].name);
    EXPECT_EQ(is[i].axis, was[i].axis);
    EXPECT_LT((is[i].origin.translation() - was[i].origin.translation()).norm(), 3) << is[i].name;
    EXPECT_LT((is[i].origin.linear() - was[i].origin.linear()).norm(), 0.01) << is[i].name;
    const bool fixed = is[i].name == "stand" || is[i].name == "bracket_fix" || is[i].name == "tool_fix";
    EXPECT_EQ(is[i].origin.isApprox(was[i].origin, 0), fixed) << is[i].name;
  }
  // AND the rest of the text is that of the maker
  const auto without_origins = [](std::string one) {
    for (std::size_t at = 0; (at = one.find("<origin", at)) != std::string::npos;)
      one.erase(at, one.find("/>", at) + 2 - at);
    return one;
  };
  EXPECT_EQ(without_origins(file.original->text), without_origins(urdf));
  EXPECT_NE(file.text.find("<!-- Calibrated origins of the joints"), std::string::npos);
}

// The offset of the point that a diagnosis added is a reflector, and no error of the arm.
TEST(UrdfOriginal, HasAnAddedOffsetOfThePointOutsideItsTip) {
  const std::string urdf = maker(kFlange);
  std::string text = calibrated(urdf, "tool0");
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  replace("X=\"TPX\"", "X=\"TPX+offset_X\"");
  replace("<static>", "<static><offset_X value=\"31\" unit=\"mm\"/>");
  const exchange::UrdfOriginal original{urdf, "maker.urdf", "tool0"};
  const Machine machine = parse_machine(text, "maker.xml");
  const exchange::UrdfFile file =
      exchange::urdf_arm(machine, make_states(1, machine), exchange::joint_names(machine, text), &original);
  EXPECT_LT(worst_of(file, machine, exchange::joint_names(machine, text)), 1e-6);
  const format::UrdfTree before(urdf, "maker.urdf"), after(file.original->text, "robot.urdf");
  const std::vector<format::UrdfJoint> was = before.way_to("tool0"), is = after.way_to("tool0");
  ASSERT_EQ(is.size(), was.size());
  for (std::size_t i = 0; i < is.size(); ++i)
    EXPECT_TRUE(is[i].origin.isApprox(was[i].origin, 1e-9)) << is[i].name;
  EXPECT_NEAR(Vector3d(file.original->tool_mm.data()).norm(), std::hypot(12 + 31, 7, 80), 1e-6);
}

// The parameters of ToolShift are in the frame of the last row, whose z is not that of every tip (KUKA:
// opposite).
TEST(TipLink, SaysWhereTheReflectorIsInTheFrameOfTheLink) {
  const std::string urdf = maker(kFlange), text = calibrated(urdf, "tool0");
  Machine machine = parse_machine(text, "maker.xml");
  const std::optional<exchange::TipLink> link = exchange::tip_link(text);
  ASSERT_TRUE(link);
  EXPECT_EQ(link->name, "tool0");
  // GIVEN a reflector that the fit put at (37, 21, -117) mm from the tool point
  machine.tool_shifts.emplace_back();
  machine.tool_shifts[0].value = {37, 21, -117, 0, 0, 0};
  const std::vector<std::string> places = exchange::tool_shift_places(machine, text);
  ASSERT_EQ(places.size(), 1U);
  Vector3d said;
  ASSERT_EQ(std::sscanf(places[0].c_str(), "ToolShift is at %lf, %lf, %lf mm in the frame of the link tool0",
                        &said[0], &said[1], &said[2]),
            3)
      << places[0];
  // THEN the place in the link, carried through the URDF, is the point that the chain of the machine carries
  States states = make_states(1, machine);
  std::map<std::string, double> at;
  const std::vector<std::string> names = exchange::joint_names(machine, text);
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis)
    at[names[axis]] = states.axis[axis][0] = 10.0 + 7 * static_cast<double>(axis);
  const Poses pose = forward(machine, states);
  Isometry3d base = Isometry3d::Identity();
  const std::array<double, 6>& shift = machine.base_shifts.at(0).value;
  base.translate(Vector3d(shift[0], shift[1], shift[2]));
  for (int k = 0; k < 3; ++k)
    base.rotate(
        Eigen::AngleAxisd(shift[3 + static_cast<std::size_t>(k)] / 57.29577951308232, Vector3d::Unit(k)));
  const Vector3d by_chain =
      base * (Vector3d(pose.position.col(0)) + pose.rotation[0] * Vector3d(37, 21, -117));
  EXPECT_LT((frame_of(urdf, "tool0", at) * said - by_chain).norm(), 2e-4);  // the sentence has 1e-4 mm
  // AND without the original URDF the place is in the link of the URDF that is written, which is another
  // frame.
  const std::string written = exchange::urdf_arm(machine, make_states(1, machine), names).text;
  const std::vector<std::string> in_written =
      exchange::tool_shift_places(machine, exchange::tool_link(machine, exchange::kToolLink), "robot.urdf");
  ASSERT_EQ(in_written.size(), 1U);
  Vector3d there;
  ASSERT_EQ(std::sscanf(in_written[0].c_str(),
                        "ToolShift is at %lf, %lf, %lf mm in the frame of the link tool of robot.urdf",
                        &there[0], &there[1], &there[2]),
            3)
      << in_written[0];
  EXPECT_GT((there - said).norm(), 1);
  const Vector3d in_rows = Vector3d(pose.position.col(0)) + pose.rotation[0] * Vector3d(37, 21, -117);
  EXPECT_LT((frame_of(written, exchange::kToolLink, at) * there - in_rows).norm(), 2e-4);
  // AND a machine file that was made from no URDF names the frame of the parameters.
  std::string plain = text;
  plain.erase(plain.find(" link=\"tool0\""),
              plain.find(">\n", plain.find(" link=\"tool0\"")) - plain.find(" link=\"tool0\""));
  EXPECT_NE(exchange::tool_shift_places(machine, plain).at(0).find("frame of the tool"), std::string::npos);
  machine.tool_shifts.clear();
  EXPECT_TRUE(exchange::tool_shift_places(machine, text).empty());
}

TEST(TipLink, AFrameThatIsNoSixNumbersIsRefused) {
  std::string text = calibrated(maker(kFlange), "tool0");
  text.replace(text.find(" frame=\""), 8, " frame=\"one ");
  EXPECT_THROW(parse_machine(text, "maker.xml"), text::InputError);
}

TEST(UrdfOriginal, HasOneMoreLinkWhereTheTipTurnsWithTheLastJoint) {
  const std::string urdf = maker(""), text = calibrated(urdf, "wrist");
  const exchange::UrdfOriginal original{urdf, "maker.urdf", "wrist"};
  Machine machine = parse_machine(text, "maker.xml");
  disturb(machine, 0);
  const std::vector<std::string> names = exchange::joint_names(machine, text);
  const exchange::UrdfFile file = exchange::urdf_arm(machine, make_states(1, machine), names, &original);
  EXPECT_TRUE(file.original->added_tip);
  EXPECT_EQ(file.original->tip, "wrist_calibrated");
  EXPECT_LT(worst_of(file, machine, names), 1e-6);
}

TEST(UrdfOriginal, IsRefusedForAnotherMachine) {
  const std::string urdf = maker(kFlange), text = calibrated(urdf, "tool0");
  const Machine machine = parse_machine(text, "maker.xml");
  const std::vector<std::string> names = exchange::joint_names(machine, text);
  const auto refusal = [&](const std::string& other, const std::string& tip) {
    const exchange::UrdfOriginal original{other, "other.urdf", tip};
    try {
      exchange::urdf_arm(machine, make_states(1, machine), names, &original);
    } catch (const text::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::string longer = urdf, renamed = urdf;
  longer.replace(longer.find("0.3 0 0.01"), 10, "0.3 0 0.02");
  renamed.replace(renamed.find("\"lift\""), 6, "\"hoist\"");
  EXPECT_NE(refusal(longer, "tool0").find("\"wrist_roll\": the axis of this joint is 10 mm and "),
            std::string::npos)
      << refusal(longer, "tool0");
  EXPECT_NE(refusal(renamed, "tool0").find("joint 2 of the machine file is lift"), std::string::npos);
  EXPECT_NE(refusal(urdf, "tool1").find("the URDF has no link of this name"), std::string::npos);
  EXPECT_NE(refusal("<machine/>", "tool0").find("this file is not a URDF"), std::string::npos);
}

TEST(Urdf, IsForArmsOnly) {
  const std::string table =
      R"(<machine name="m"><variables><static/><machineaxes><X min="0" max="9"/></machineaxes></variables>
      <transforms branch="tool"><sixdof n="1" Z="1"/></transforms>
      <transforms branch="workpiece"><sixdof n="1" X="X"/></transforms></machine>)";
  const Machine machine = parse_machine(table, "m.xml");
  EXPECT_THROW(exchange::urdf_arm(machine, make_states(1, machine)), text::InputError);
}

}  // namespace
}  // namespace vernier::urdf_test
