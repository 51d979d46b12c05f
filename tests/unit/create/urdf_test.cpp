// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/urdf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

#include "tools/create/machine_file.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/model/states.h"
#include "tools/text/error.h"

namespace vernier::urdf_test {

using namespace vernier::create;
using namespace vernier::model;
using namespace vernier::text;
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

struct Link {
  const char* type;
  Vector3d xyz, rpy, axis;
};

std::string words(const Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string urdf_of(const std::vector<Link>& chain) {
  std::string text = "<robot name=\"arm\">\n<link name=\"l0\"/>\n";
  for (std::size_t i = 0; i < chain.size(); ++i)
    text += fmt::format(
        "<link name=\"l{0}\"/><joint name=\"joint-{0}\" type=\"{1}\"><parent link=\"l{2}\"/><child "
        "link=\"l{0}\"/>"
        "<origin xyz=\"{3}\" rpy=\"{4}\"/><axis xyz=\"{5}\"/><limit lower=\"-2\" upper=\"2.5\"/></joint>\n",
        i + 1, chain[i].type, i, words(chain[i].xyz), words(chain[i].rpy), words(chain[i].axis));
  return text + "</robot>\n";
}

/// The tip by the product of the file's own transforms, mm; positions in rad and m.
Vector3d by_the_file(const std::vector<Link>& chain, const std::vector<double>& positions) {
  Isometry3d at = Isometry3d::Identity();
  std::size_t next = 0;
  for (const Link& link : chain) {
    at.translate(link.xyz);
    at.rotate(AngleAxisd(link.rpy.z(), Vector3d::UnitZ()) * AngleAxisd(link.rpy.y(), Vector3d::UnitY()) *
              AngleAxisd(link.rpy.x(), Vector3d::UnitX()));
    if (std::string(link.type) == "fixed") continue;
    if (std::string(link.type) == "prismatic")
      at.translate(positions[next++] * link.axis.normalized());
    else
      at.rotate(AngleAxisd(positions[next++], link.axis.normalized()));
  }
  return 1000 * at.translation();
}

/// The tip by the machine file that comes of it, in the root's frame.
Vector3d by_the_machine(const UrdfArm& arm, const std::vector<double>& positions) {
  MachinePlan plan = plan_robot(arm.axes, arm.rows);
  plan.tool = arm.tool({});
  plan.base = arm.base;
  const Machine machine = nominal_machine(parse_machine(machine_file(plan), "m.xml"));
  States states = make_states(1, machine.axes.size(), {});
  for (std::size_t i = 0; i < positions.size(); ++i)
    states.axis[i][0] = positions[i] * (arm.rows[i].prismatic ? 1000 : 180 / kPi);
  const auto& b = machine.base_shifts.front().value;
  Isometry3d base = Isometry3d::Identity();
  base.translate(Vector3d(b[0], b[1], b[2]));
  for (int k = 0; k < 3; ++k)
    base.rotate(AngleAxisd(b[static_cast<std::size_t>(3 + k)] * kPi / 180, Vector3d::Unit(k)));
  return base * Vector3d(forward(machine, states).position.col(0));
}

void expect_same(const std::vector<Link>& chain, std::mt19937& random, const std::string& what) {
  const UrdfArm arm = parse_urdf(urdf_of(chain), "arm.urdf", "");
  std::uniform_real_distribution<double> place(-1.9, 1.9);
  for (int pose = 0; pose < 5; ++pose) {
    std::vector<double> positions(arm.rows.size());
    for (double& one : positions) one = place(random);
    EXPECT_LT((by_the_file(chain, positions) - by_the_machine(arm, positions)).norm(), 1e-6) << what;
  }
}

TEST(Urdf, TipIsWhereTheFileHasItWhateverTheChain) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto any = [&](double size) -> Vector3d {
    return size * Vector3d(normal(random), normal(random), normal(random));
  };
  for (int arm = 0; arm < 60; ++arm) {
    std::vector<Link> chain;
    const int joints = 2 + arm % 6;
    for (int i = 0; i < joints; ++i) {
      // Skew, parallel, opposite, on one line, nearly parallel as rounded files and calibrated ones have it.
      const int kind = (arm / 6 + i) % 5;
      Link link{i == 1 && arm % 4 == 0 ? "prismatic" : "revolute", any(0.4), any(1), any(1)};
      if (kind != 0) {
        link.axis = Vector3d::UnitZ();
        link.rpy = kind == 1 ? Vector3d::Zero() : kind == 2 ? Vector3d(3.14159, 0, 0) : any(1e-3);
        if (kind == 4) link.xyz = Vector3d(0, 0, 0.3), link.rpy = Vector3d::Zero();
      }
      chain.push_back(link);
      if (arm % 3 == 0) chain.push_back({"fixed", any(0.1), any(0.5), Vector3d::UnitX()});
    }
    expect_same(chain, random, fmt::format("chain {}:\n{}", arm, urdf_of(chain)));
  }
}

// The joints of a UR10e as its maker's description has them (ur_description, default kinematics).
TEST(Urdf, KnownArmHasItsPublishedLengths) {
  const Vector3d z = Vector3d::UnitZ(), none = Vector3d::Zero();
  const std::vector<Link> chain = {{"revolute", {0, 0, 0.1807}, none, z},
                                   {"revolute", none, {kPi / 2, 0, 0}, z},
                                   {"revolute", {-0.6127, 0, 0}, none, z},
                                   {"revolute", {-0.57155, 0, 0.17415}, none, z},
                                   {"revolute", {0, -0.11985, 0}, {kPi / 2, 0, 0}, z},
                                   {"revolute", {0, 0.11655, 0}, {kPi / 2, kPi, kPi}, z}};
  const UrdfArm arm = parse_urdf(urdf_of(chain), "ur10e.urdf", "l6");
  const std::vector<DhRow>& known = default_arm();
  ASSERT_EQ(arm.rows.size(), known.size());
  double heights = 0, known_heights = 0;  // of three parallel joints only the sum is told
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_NEAR(std::abs(arm.rows[i].a), std::abs(known[i].a), 1e-9) << i;
    EXPECT_NEAR(std::abs(std::sin(arm.rows[i].alpha * kPi / 180)),
                std::abs(std::sin(known[i].alpha * kPi / 180)), 1e-12);
    heights += std::abs(arm.rows[i].d);
    known_heights += std::abs(known[i].d);
  }
  EXPECT_NEAR(heights, known_heights, 1e-9);
  EXPECT_EQ(arm.base, (std::array<double, 6>{}));
  EXPECT_EQ(arm.axes.front().name, "joint_1");
  EXPECT_NEAR(arm.axes.front().max, 2.5 * 180 / kPi, 1e-5);
  std::mt19937 random(3);
  expect_same(chain, random, "UR10e");
}

std::string refusal(const std::string& text, const std::string& tip = "") {
  try {
    parse_urdf(text, "arm.urdf", tip);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Urdf, SaysWhatItCannotTake) {
  const std::string good = urdf_of({{"revolute", {0, 0, 1}, {0, 0, 0}, Vector3d::UnitZ()},
                                    {"revolute", {1, 0, 0}, {0, 0, 0}, Vector3d::UnitY()}});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_NE(refusal("<machine/>").find("not a URDF"), std::string::npos);
  EXPECT_NE(refusal(good, "hand").find("\"hand\": the URDF has no link of this name"), std::string::npos);
  EXPECT_NE(refusal(with("<axis xyz=\"0 0 1\"", "<axis xyz=\"${a}\"")).find("xacro"), std::string::npos);
  EXPECT_NE(refusal(with("<axis xyz=\"0 0 1\"", "<axis xyz=\"0 0 0\"")).find("no direction"),
            std::string::npos);
  EXPECT_NE(refusal(with("type=\"revolute\"", "type=\"floating\"")).find("arm.urdf:3: \"floating\""),
            std::string::npos);
  EXPECT_NE(refusal(with("<limit lower=\"-2\" upper=\"2.5\"/>", "")).find("limit"), std::string::npos);
  EXPECT_NE(refusal(with("<limit lower=\"-2\" upper=\"2.5\"/>", "<limit lower=\"-120\" upper=\"150\"/>"))
                .find("probably in deg"),
            std::string::npos);
  EXPECT_NE(refusal(urdf_of({{"revolute", {0, 0, 1}, {0, 0, 0}, Vector3d::UnitZ()},
                             {"revolute", {400, 0, 0}, {0, 0, 0}, Vector3d::UnitY()}}))
                .find("probably in mm"),
            std::string::npos);
  EXPECT_NE(refusal(with("<parent link=\"l1\"/>", "<parent link=\"l7\"/>")).find("\"l7\""),
            std::string::npos);
  EXPECT_NE(refusal(with("<parent link=\"l0\"/>", "<parent link=\"l2\"/>")).find("loop"), std::string::npos);
  EXPECT_NE(refusal(with("</robot>",
                         "<link name=\"hand\"/><joint name=\"h\" type=\"fixed\"><parent link=\"l2\"/>"
                         "<child link=\"hand\"/></joint><link name=\"eye\"/><joint name=\"e\" type=\"fixed\">"
                         "<parent link=\"l2\"/><child link=\"eye\"/></joint></robot>"))
                .find("--tip: eye, hand"),
            std::string::npos);
}

}  // namespace
}  // namespace vernier::urdf_test
