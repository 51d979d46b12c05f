// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/touch/machines.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::touch_bench {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Random = std::mt19937_64;

double normal(Random& random, double std) { return std::normal_distribution<double>(0, std)(random); }
double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
Vector3d noise(Random& random, double std) {
  return {normal(random, std), normal(random, std), normal(random, std)};
}

/// A machine whose free statics differ from nominal: lengths by mm, angles by deg (one standard deviation).
model::Machine with_errors(const std::string& text, Random& random, double length_mm, double angle_deg) {
  model::Machine machine = model::parse_machine(text, "truth.xml");
  for (model::Static& item : machine.statics)
    if (!item.hidden) item.value += normal(random, item.unit == "deg" ? angle_deg : length_mm);
  return machine;
}

model::States one_state(const model::Machine& machine, const VectorXd& q, const VectorXd& input) {
  model::States state = model::make_states(1, machine);
  for (Index a = 0; a < q.size(); ++a) state.axis[static_cast<std::size_t>(a)][0] = q[a];
  for (Index a = 0; a < input.size(); ++a) state.input[static_cast<std::size_t>(a)][0] = input[a];
  return state;
}

Vector3d tool_point(const model::Machine& machine, const VectorXd& q, const VectorXd& input) {
  return model::forward(machine, one_state(machine, q, input)).position.col(0);
}

/// Moves the axes (the first `free` of them) until the tool point of the true machine is at `goal`. Returns
/// the positions; empty: not reached.
VectorXd reach(const model::Machine& machine, VectorXd q, const VectorXd& input, const Vector3d& goal,
               Index free) {
  constexpr double kStep = 1e-4;  // of a difference quotient, mm or deg
  for (int i = 0; i < 60; ++i) {
    const Vector3d now = tool_point(machine, q, input);
    const Vector3d off = goal - now;
    if (off.norm() < 1e-7) return q;
    Eigen::MatrixXd slope(3, free);
    for (Index a = 0; a < free; ++a) {
      VectorXd moved = q;
      moved[a] += kStep;
      slope.col(a) = (tool_point(machine, moved, input) - now) / kStep;
    }
    VectorXd step = maths::least_norm(slope, off);
    constexpr double kMost = 30;  // mm or deg in one step
    if (step.cwiseAbs().maxCoeff() > kMost) step *= kMost / step.cwiseAbs().maxCoeff();
    q.head(free) += step;
  }
  return {};
}

/// Lines of a measurement file.
class Survey {
 public:
  explicit Survey(std::string header) : text_(std::move(header) + "\n") {}
  void row(const VectorXd& q, const VectorXd& input, const std::string& rest) {
    for (Index a = 0; a < q.size(); ++a) text_ += text::number_text(q[a]) + ",";
    for (Index a = 0; a < input.size(); ++a) text_ += text::number_text(input[a]) + ",";
    text_ += rest + "\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string with_artefacts(std::string text, const std::string& artefacts) {
  text.insert(text.find("</variables>"), artefacts);
  return text;
}

/// Directions of `count` touches of the upper half of a ball: the pole, and a ring 30 degrees above its
/// equator.
Vector3d touch_direction(int touch, int count) {
  if (touch == 0) return Vector3d::UnitZ();
  const double turn = 2 * std::numbers::pi * touch / (count - 1);
  return {std::cos(turn) * std::sqrt(0.75), std::sin(turn) * std::sqrt(0.75), 0.5};
}

constexpr const char* kMill = R"(<machine name="mill">
  <variables>
    <static>
      <C0Y value="0" nominal="0" unit="deg"/>
      <B0Z value="0" nominal="0" unit="deg"/>
      <A0Z value="0" nominal="0" unit="deg"/>
      <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/>
    </static>
    <machineaxes>
      <X min="0" max="500"/>
      <Y min="0" max="400"/>
      <Z min="-300" max="0"/>
    </machineaxes>
    <inputs><L unit="mm" reference="100"/></inputs>
  </variables>
  <transforms branch="tool">
    <sixdof n="1" X="X-Y*C0Y*0.017453292519943295" Y="Y"/>
    <sixdof n="2" X="Z*B0Z*0.017453292519943295" Y="-Z*A0Z*0.017453292519943295" Z="Z"/>
    <sixdof n="3" Z="-L"/>
  </transforms>
</machine>
)";

constexpr const char* kTable = R"(<machine name="table">
  <variables>
    <static>
      <EY0A value="0" nominal="0" unit="mm"/>
      <EZ0A value="0" nominal="0" unit="mm"/>
      <EB0A value="0" nominal="0" unit="deg"/>
      <EC0A value="0" nominal="0" unit="deg"/>
      <EX0C value="0" nominal="0" unit="mm"/>
      <EY0C value="0" nominal="0" unit="mm"/>
      <EA0C value="0" nominal="0" unit="deg"/>
      <EB0C value="0" nominal="0" unit="deg"/>
    </static>
    <machineaxes>
      <X min="-250" max="250"/>
      <Y min="-250" max="250"/>
      <Z min="-50" max="400"/>
      <A rotary="true" min="-90" max="90"/>
      <C rotary="true" min="-180" max="180"/>
    </machineaxes>
  </variables>
  <transforms branch="tool">
    <sixdof n="1" X="X" Y="Y" Z="Z"/>
  </transforms>
  <transforms branch="workpiece">
    <sixdof n="1" Y="EY0A" Z="EZ0A" rY="EB0A" rZ="EC0A"/>
    <sixdof n="2" rX="A"/>
    <sixdof n="3" X="EX0C" Y="EY0C" rX="EA0C" rY="EB0C"/>
    <sixdof n="4" rZ="C"/>
  </transforms>
</machine>
)";

}  // namespace

Case robot(Random& random, Size known) {
  constexpr double kU_mm = 0.02;
  std::string text = text::read_file(VERNIER_SOURCE_DIR "/tables/machines/ur10e.xml");
  const Vector3d first(600, -200, 100), second(600, 100, 250);
  if (known == Size::kPlaces) {
    const Vector3d between = second - first;
    text = with_artefacts(
        text, fmt::format("<artefact name=\"A\" type=\"point\" x=\"0\" y=\"0\" z=\"0\"/>\n"
                          "<artefact name=\"B\" type=\"point\" x=\"{}\" y=\"0\" z=\"0\" u=\"2um\"/>\n",
                          between.norm()));
  }
  Case one{.name = known == Size::kNothing    ? "robot, nothing known"
                   : known == Size::kDistance ? "robot, known distance"
                                              : "robot, known places",
           .machine = text,
           .survey = {},
           .truth = with_errors(text, random, 0.3, 0.05),
           .fresh = {},
           .parameters = {},
           .unit = 1,
           .goal = known == Size::kNothing ? 1e9 : 0.1};
  const bool named = known == Size::kPlaces;
  Survey survey(std::string("J1[deg],J2[deg],J3[deg],J4[deg],J5[deg],J6[deg],") +
                (named ? "on," : "same,distance[mm],from,name,") + "u[mm]");
  constexpr int kPoses = 20;
  // The calibrated distance has the uncertainty that its rows state; all rows state the same value.
  const double distance_mm = (second - first).norm() + normal(random, kU_mm);
  for (int point = 0; point < 2; ++point)
    for (int i = 0; i < kPoses;) {
      VectorXd q(6);
      q << uniform(random, -40, 40), uniform(random, -110, -40), uniform(random, 40, 120),
          uniform(random, -140, -20), uniform(random, -130, -50), uniform(random, -180, 180);
      q = reach(one.truth, q, {}, (point == 0 ? first : second) + noise(random, kU_mm), 6);
      if (q.size() == 0) continue;
      const std::string label = point == 0 ? "A" : "B";
      std::string rest = label + ",";
      if (!named) {
        rest += point == 1 && known == Size::kDistance
                    ? fmt::format("{},A{},", text::number_text(distance_mm), i)
                    : ",,";
        rest += fmt::format("{}{},", label, i);
      }
      survey.row(q, {}, rest + text::number_text(kU_mm));
      ++i;
    }
  one.survey = survey.text();
  one.fresh = model::make_states(40, one.truth);
  for (Index i = 0; i < 40; ++i) {
    const std::array<double, 6> q = {uniform(random, -40, 40),   uniform(random, -110, -40),
                                     uniform(random, 40, 120),   uniform(random, -140, -20),
                                     uniform(random, -130, -50), uniform(random, -180, 180)};
    for (std::size_t a = 0; a < 6; ++a) one.fresh.axis[a][i] = q[a];
  }
  return one;
}

namespace {

/// Touches of one ball with the mill, at its true place in workpiece coordinates.
void touch_ball(Survey& survey, const model::Machine& truth, const Vector3d& ball, double radius_mm,
                double tool_mm, const std::string& name, int touches, double u_mm, Random& random) {
  VectorXd input(1);
  input << tool_mm;
  for (int k = 0; k < touches; ++k) {
    const Vector3d at = ball + (radius_mm + normal(random, u_mm)) * touch_direction(k, touches);
    VectorXd q(3);
    q << at.x(), at.y(), at.z() + tool_mm;
    q = reach(truth, q, input, at, 3);
    survey.row(q, input, name + "," + text::number_text(1e3 * u_mm));
  }
}

}  // namespace

Case mill(Random& random) {
  constexpr double kU_mm = 1e-3, kRadius_mm = 12.5;
  const std::array<Vector3d, 4> plate = {Vector3d(0, 0, 0), Vector3d(300, 0, 0), Vector3d(300, 250, 0),
                                         Vector3d(0, 250, 0)};
  std::string artefacts;
  for (std::size_t i = 0; i < plate.size(); ++i)
    artefacts += fmt::format(
        "<artefact name=\"P{}\" type=\"sphere\" radius=\"12.5mm\" uradius=\"0.2um\" x=\"{}\" y=\"{}\" "
        "z=\"{}\" u=\"0.5um\"/>\n",
        i, plate[i].x(), plate[i].y(), plate[i].z());
  const std::string text = with_artefacts(kMill, artefacts);
  Case one{.name = "mill, ball plate",
           .machine = text,
           .survey = {},
           .truth = with_errors(text, random, 0, 50e-6 * maths::kDegPerRad),
           .fresh = {},
           .parameters = {"C0Y", "B0Z", "A0Z"},
           .unit = 1e6 * maths::kRadPerDeg,
           .goal = 3};
  Survey survey("X[mm],Y[mm],Z[mm],L[mm],on,u[um]");
  const double turn = uniform(random, -0.01, 0.01);
  for (const double tool : {60.0, 260.0})
    for (std::size_t i = 0; i < plate.size(); ++i) {
      Vector3d ball = plate[i] + noise(random, 0.5e-3);
      ball = Vector3d(100 + std::cos(turn) * ball.x() - std::sin(turn) * ball.y(),
                      80 + std::sin(turn) * ball.x() + std::cos(turn) * ball.y(), ball.z() - 350);
      touch_ball(survey, one.truth, ball, kRadius_mm, tool, fmt::format("P{}", i), 9, kU_mm, random);
    }
  one.survey = survey.text();
  return one;
}

Case table(Random& random) {
  constexpr double kU_mm = 1e-3, kRadius_mm = 12.5;
  const std::string text =
      with_artefacts(kTable, "<artefact name=\"S\" type=\"sphere\" radius=\"12.5mm\" uradius=\"0.2um\"/>\n");
  Case one{.name = "table, one ball",
           .machine = text,
           .survey = {},
           .truth = with_errors(text, random, 0.02, 30e-6 * maths::kDegPerRad),
           .fresh = {},
           .parameters = {"EY0A", "EZ0A", "EX0C", "EY0C"},
           .unit = 1e3,
           .goal = 2};
  Survey survey("X[mm],Y[mm],Z[mm],A[deg],C[deg],on,u[um]");
  const Vector3d ball(120, 30, 60);
  for (int pose = 0; pose < 12; ++pose) {
    const double a = pose < 6 ? 0 : -60 + 24.0 * (pose - 6), c = -180 + 60.0 * pose + (pose < 6 ? 0 : 15);
    for (int k = 0; k < 5; ++k) {
      VectorXd q(5);
      q << 0, 0, 0, a, c > 180 ? c - 360 * std::ceil((c - 180) / 360) : c;
      const Vector3d at = ball + (kRadius_mm + normal(random, kU_mm)) * touch_direction(k, 5);
      q = reach(one.truth, q, {}, at, 3);
      survey.row(q, {}, "S," + text::number_text(1e3 * kU_mm));
    }
  }
  one.survey = survey.text();
  return one;
}

Case many(Random& random, int things, int touches) {
  std::string artefacts;
  for (int i = 0; i < things; ++i) artefacts += fmt::format("<artefact name=\"S{}\" type=\"sphere\"/>\n", i);
  const std::string text = with_artefacts(kMill, artefacts);
  Case one{.name = fmt::format("{} touches of {} balls", touches, things),
           .machine = text,
           .survey = {},
           .truth = with_errors(text, random, 0, 50e-6 * maths::kDegPerRad),
           .fresh = {},
           .parameters = {"B0Z", "A0Z"},
           .unit = 1e6 * maths::kRadPerDeg,
           .goal = 3};
  Survey survey("X[mm],Y[mm],Z[mm],L[mm],on,u[um]");
  const int each = touches / things / 2;
  for (int i = 0; i < things; ++i) {
    const Vector3d ball(uniform(random, 50, 450), uniform(random, 50, 350), -350);
    for (const double tool : {60.0, 180.0})
      touch_ball(survey, one.truth, ball, 12.5, tool, fmt::format("S{}", i), each, 1e-3, random);
  }
  one.survey = survey.text();
  return one;
}

}  // namespace vernier::touch_bench
