// SPDX-License-Identifier: GPL-3.0-or-later
// URDF of a calibrated arm: its joints, multiplied together, are the chain.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <memory>
#include <pugixml.hpp>
#include <random>
#include <sstream>

#include "tools/create/urdf.h"
#include "tools/exchange/urdf_arm.h"
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
