// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>
#include <random>

#include "tests/support/machines.h"
#include "tools/derive/numeric.h"
#include "tools/derive/second_order.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::chains_test {

using namespace vernier::compile;
using namespace vernier::derive;
using namespace vernier::model;
using namespace vernier::text;
namespace {

namespace fs = std::filesystem;
constexpr unsigned kSeed = 20260107;
const std::string kMachines = VERNIER_SOURCE_DIR "/tables/machines/";

std::vector<std::string> reference_files() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(kMachines))
    if (entry.path().extension() == ".xml") files.push_back(entry.path().filename());
  std::sort(files.begin(), files.end());
  return files;
}

/// A random pose: axes in their range, inputs at their reference or (hidden axes) 10, moving.
States random_state(const ErrorEquation& equation, std::mt19937_64& random) {
  const Machine& machine = equation.machine;
  std::vector<double> references;
  for (const Input& input : machine.inputs) references.push_back(input.hidden_axis ? 10 : input.reference);
  States states = make_states(1, machine.axes.size(), references);
  const Ranges ranges = nominal_ranges(equation);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (const NominalSymbol& n : equation.nominal) {
    if (n.key.kind != SymbolKind::kAxis) continue;
    const Interval range = ranges.at(n.symbol);
    states.axis[n.key.index][0] = uniform(range.low, range.high) * n.file_units;
  }
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    states.direction[a][0] = uniform(0, 1) < 0.5 ? -1 : 1;
    states.velocity[a][0] = uniform(-20, 20);
  }
  return states;
}

struct Pose {
  Eigen::Vector3d position;
  Eigen::Matrix3d rotation;
};
Pose pose_with(const ErrorEquation& equation, const States& states, std::size_t p, double error) {
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(equation.parameters.size()));
  errors[static_cast<Eigen::Index>(p)] = error;
  const Poses poses = forward(with_errors(equation, errors), states);
  return {poses.position.col(0), poses.rotation[0]};
}

Eigen::Vector3d skew_part(const Eigen::Matrix3d& m) {
  return {(m(2, 1) - m(1, 2)) / 2, (m(0, 2) - m(2, 0)) / 2, (m(1, 0) - m(0, 1)) / 2};
}

/// Five-point central difference of the forward solution by one error: dX dY dZ dA dB dC.
Eigen::Matrix<double, 6, 1> difference(const ErrorEquation& equation, const States& states, std::size_t p) {
  const double h = equation.parameters[p].unit == "mm" ? 1e-1 : 1e-3;
  const Eigen::Matrix3d back = pose_with(equation, states, p, 0).rotation.transpose();
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (const auto& [step, weight] : {std::pair{-2, 1.0}, {-1, -8.0}, {1, 8.0}, {2, -1.0}}) {
    const Pose pose = pose_with(equation, states, p, step * h);
    sum.head<3>() += weight / (12 * h) * pose.position;
    sum.tail<3>() += weight / (12 * h) * skew_part(pose.rotation * back);
  }
  return sum;
}

double worst_difference(const ErrorEquation& equation, std::size_t poses, std::mt19937_64& random) {
  double worst = 0;
  for (std::size_t i = 0; i < poses; ++i) {
    const States states = random_state(equation, random);
    const Eigen::MatrixXd derived = sensitivity_at(equation, states, 0);
    for (std::size_t p = 0; p < equation.parameters.size(); ++p)
      worst = std::max(worst, (derived.col(static_cast<Eigen::Index>(p)) - difference(equation, states, p))
                                  .cwiseAbs()
                                  .maxCoeff());
  }
  return worst;
}

TEST(DerivedChain, FiveAxisJacobianAgreesWithDifferencesTo1e8) {
  std::mt19937_64 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  const ErrorEquation equation = derive::derive(read_machine(kMachines + "five_axis_bhead_ctable.xml"));
  const double worst = worst_difference(equation, 200, random);
  // Truncation h^4/30 * 1 m = 3e-11, rounding 1e-13 * 1.5 / h = 2e-10.
  EXPECT_LE(worst, 1e-8);
  std::printf("five axes, 200 poses, seed %u: largest difference %.2e mm/rad\n", kSeed, worst);
}

TEST(DerivedChain, EveryReferenceMachineAgreesWithDifferences) {
  std::mt19937_64 random(kSeed);
  const auto files = reference_files();
  ASSERT_GE(files.size(), 14U);
  for (const std::string& file : files) {
    const ErrorEquation equation = derive::derive(read_machine(kMachines + file));
    ASSERT_FALSE(equation.parameters.empty()) << file;
    // Levers and positions up to 20 m: rounding 4e-12 mm * 1.5 / 1e-3 and truncation 1e-12 / 30 * 2e4.
    EXPECT_LT(worst_difference(equation, 10, random), 1e-7) << file;
  }
}

TEST(DerivedChain, EverythingThatTheFormatOffersAgreesWithDifferences) {
  std::mt19937_64 random(kSeed);
  // tau acts inside a lag whose factor has nominal 0: second order, no refusal.
  const ErrorEquation equation = derive::derive(support::full_machine());
  EXPECT_LT(worst_difference(equation, 10, random), 1e-7);
  bool second_order = false;
  for (const std::string& note : equation.notes)
    second_order = second_order || note.find("tau acts in second order only") != std::string::npos ||
                   note.find("d_tau acts in second order only") != std::string::npos;
  EXPECT_TRUE(second_order);
}

TEST(DerivedChain, FibrePlacementSixDofEqualsDhOn200RandomPoses) {
  std::mt19937_64 random(kSeed);
  const Machine sixdof = read_machine(kMachines + "fibre_placement.xml");
  const Machine dh = read_machine(kMachines + "fibre_placement_dh.xml");
  ASSERT_EQ(sixdof.axes.size(), 7U);
  const ErrorEquation equation = derive::derive(sixdof);
  double position = 0, rotation = 0;
  for (int i = 0; i < 200; ++i) {
    States states = random_state(equation, random);
    constexpr std::array<double, 6> kToolPoints = {1, 2, 3, 4, 5, 10};
    states.input[0][0] = kToolPoints[random() % kToolPoints.size()];
    const Poses a = forward(sixdof, states), b = forward(dh, states);
    position = std::max(position, (a.position - b.position).cwiseAbs().maxCoeff());
    rotation = std::max(rotation, (a.rotation[0] - b.rotation[0]).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(position, 1e-9);  // mm; positions up to 2e4 mm have an ulp of 4e-12
  EXPECT_LE(rotation, 1e-12);
  std::printf("sixdof against DH, 200 poses, seed %u: %.2e mm, %.2e\n", kSeed, position, rotation);
}

TEST(DerivedChain, FibrePlacementFileIsThePublishedOneUnchanged) {
  EXPECT_EQ(read_file(kMachines + "fibre_placement.xml"),
            read_file(VERNIER_SOURCE_DIR "/tests/data/electroimpact/kinematic_before.xml"));
}

TEST(SecondOrder, BoundHoldsAndIsNotVacuous) {
  for (const std::string& file : reference_files()) {
    const ErrorEquation equation = derive::derive(read_machine(kMachines + file));
    const SecondOrderBound bound = bound_second_order(equation);
    if (file == "fibre_placement.xml") continue;  // 72 errors: the slow one, bounded below
    ASSERT_TRUE(bound.bound.has_value()) << file << ": " << bound.reason;
    const auto seen = sample_second_order(equation, 300, kSeed);
    ASSERT_TRUE(seen.has_value()) << file;
    EXPECT_LE(seen->position_mm, bound.bound->position_mm + 1e-10) << file;
    EXPECT_LE(seen->axis_rad, bound.bound->axis_rad + 1e-12) << file;
    // All errors at their worst together is rare among random signs; far more than that would be useless.
    EXPECT_GE(seen->position_mm, bound.bound->position_mm / 30) << file;
  }
  const SecondOrderBound fibre =
      bound_second_order(derive::derive(read_machine(kMachines + "fibre_placement.xml")));
  ASSERT_TRUE(fibre.bound.has_value()) << fibre.reason;
}

TEST(SecondOrder, GrowsWithTheSquareOfTheErrors) {
  const Machine machine = read_machine(kMachines + "moving_bridge.xml");
  const auto bound = [&](double k) {
    return bound_second_order(derive::derive(machine, {0.1 * k, 1e-3 * k, k}));
  };
  const double ratio = bound(1).bound->position_mm / bound(0.01).bound->position_mm;
  EXPECT_NEAR(ratio, 1e4, 200);  // levers grow by the errors themselves, 1e-3 relative
}

TEST(SecondOrder, AxisWithoutRangeIsNamed) {
  const SecondOrderBound bound = bound_second_order(derive::derive(
      parse_machine("<machine><variables><static><e value=\"0\" nominal=\"0\" unit=\"deg\"/></static>"
                    "<machineaxes><X/></machineaxes></variables>"
                    "<transforms><sixdof rZ=\"e\"/><sixdof X=\"X\"/></transforms></machine>",
                    "m.xml")));
  EXPECT_FALSE(bound.bound.has_value());
  EXPECT_NE(bound.reason.find("X has no range"), std::string::npos) << bound.reason;
}

Machine with_term(const std::string& term) {
  return parse_machine(
      "<machine><variables><static><k value=\"0\" nominal=\"0\"/><m value=\"2\" nominal=\"2\"/></static>"
      "<machineaxes><X min=\"0\" max=\"9\"/></machineaxes></variables>\n<transforms>\n<sixdof X=\"" +
          term + "\"/></transforms></machine>",
      "m.xml");
}

std::string refusal(const std::string& term) {
  try {
    derive::derive(with_term(term));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Derive, RefusesAnErrorInsideAComparisonNamingTheExpression) {
  for (const char* term : {"X*(m &gt; X)", "max(k,X)", "abs(k)", "sign(k-1)", "X+log(k)"}) {
    const std::string message = refusal(term);
    EXPECT_NE(message.find("m.xml:3"), std::string::npos) << term << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  EXPECT_NE(refusal("max(k,X)").find("k acts inside (max(k,X))"), std::string::npos) << refusal("max(k,X)");
  EXPECT_EQ(refusal("X*(X&gt;3)+k"), "");
}

TEST(Derive, AnErrorWhoseFactorIsZeroNominallyIsOfSecondOrder) {
  const ErrorEquation equation = derive::derive(with_term("X+k*sin(360*X/m)"));
  ASSERT_EQ(equation.parameters.size(), 2U);
  EXPECT_TRUE(equation.sensitivity[1][0].is_zero());
  EXPECT_FALSE(equation.sensitivity[0][0].is_zero());
}

}  // namespace
}  // namespace vernier::chains_test
