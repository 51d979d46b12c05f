// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/structure.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <set>

#include <Eigen/QR>

#include "tests/support/machines.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/parameters.h"
#include "tools/residual/sentence.h"
#include "tools/results/structure_json.h"

namespace vernier::structure_test {

using namespace vernier::model;
using namespace vernier::residual;
using namespace vernier::results;
namespace {

constexpr unsigned kSeed = 20;

unsigned from_environment(const char* name, unsigned fallback) {
  const char* text = std::getenv(name);
  return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : fallback;
}

constexpr const char* kMachine = R"(<machine name="m"><variables><machineaxes>
<X rotary="false" min="0" max="600"/><Y rotary="false" min="0" max="400"/><Z rotary="false" min="-300" max="0"/>
</machineaxes><inputs><T unit="degC" reference="20"/></inputs></variables>
<transforms branch="tool"><sixdof n="1" X="X" Y="Y" Z="Z"/></transforms></machine>)";

/// Readings of x, y and z at random poses: motion, a temperature that wanders, decoys, `runs` runs.
Measurement survey(const Machine& machine, std::size_t rows, std::size_t runs, std::mt19937_64& random,
                   std::size_t decoys = 4, bool with_u = false) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::string text = "X[mm],Y[mm],Z[mm],dirX,dirY,dirZ,feed[mm/min],t[s],T[degC],x[mm],y[mm],z[mm],run";
  if (with_u) text += ",u[mm]";
  for (std::size_t k = 0; k < decoys; ++k) text += ",decoy" + std::to_string(k) + "[degC]";
  text += "\n";
  double temperature = 20;
  for (std::size_t i = 0; i < rows; ++i) {
    temperature += 0.2 * (unit(random) - 0.5);
    const auto sense = [&] { return unit(random) < 0.5 ? "-1" : "1"; };
    text += std::to_string(600 * unit(random)) + "," + std::to_string(400 * unit(random)) + "," +
            std::to_string(-300 * unit(random)) + "," + sense() + "," + sense() + "," + sense() + "," +
            std::to_string(500 + 500 * std::floor(4 * unit(random))) + "," + std::to_string(10 * i) + "," +
            std::to_string(temperature) + ",0,0,0,r" + std::to_string(i * runs / rows);
    if (with_u) text += ",0.001";
    for (std::size_t k = 0; k < decoys; ++k) text += "," + std::to_string(unit(random));
    text += "\n";
  }
  return parse_measurement(text, "survey", machine);
}

Eigen::VectorXd white(const Measurement& m, double mm, std::mt19937_64& random) {
  std::normal_distribution<double> noise(0, mm);
  Eigen::VectorXd r(static_cast<Eigen::Index>(m.observations.size()));
  for (double& value : r) value = noise(random);
  return r;
}

/// Adds an error in mm to one kind's readings.
void plant(Eigen::VectorXd& residual, const Measurement& m, ObservationKind kind,
           const std::function<double(Eigen::Index)>& error) {
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (m.observations[i].kind == kind)
      residual[static_cast<Eigen::Index>(i)] += error(static_cast<Eigen::Index>(m.observations[i].row));
}

/// The first finding; an empty one where there is none, so that a test fails and does not stop.
Finding first(const FailurePicture& picture) {
  return picture.findings.empty() ? Finding{} : picture.findings.front();
}

struct Planted {
  Machine machine = parse_machine(kMachine, "m.xml");
  std::mt19937_64 random{kSeed};
  Measurement m = survey(machine, 300, 4, random);
  Eigen::VectorXd residual = white(m, 1e-3, random);
  const Column& axis(std::size_t i) const { return m.states.axis[i]; }
  FailurePicture picture() const { return failure_picture(machine, m, residual); }
};

TEST(FailurePicture, WhiteResidualRaisesNoAlarm) {
  // 2000 surveys of 120 x 3 readings, 12 columns. The number of p < 0.001 is binomial with at most 0.001: 8
  // or more would have a chance of 1e-3. p < 0.05: at most 5 % + 4 standard deviations.
#ifdef VERNIER_SANITIZED
  constexpr unsigned kSurveys = 200;  // the sanitizers look for other mistakes
#else
  constexpr unsigned kSurveys = 2000;
#endif
  const unsigned count = from_environment("VERNIER_WHITE_SURVEYS", kSurveys),
                 seed = from_environment("VERNIER_SEED", kSeed);
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937_64 random(seed);
  const Machine machine = parse_machine(kMachine, "m.xml");
  unsigned far = 0, near = 0, with_findings = 0;
  for (unsigned i = 0; i < count; ++i) {
    const Measurement m = survey(machine, 120, 3, random, 4, true);
    const FailurePicture picture = failure_picture(machine, m, white(m, 1e-3, random));
    far += picture.omnibus_p < 1e-3 ? 1U : 0U;
    near += picture.omnibus_p < 0.05 ? 1U : 0U;
    with_findings += picture.findings.empty() ? 0U : 1U;
  }
  std::cout << "seed " << seed << ": " << far << " below 0.001, " << near << " below 0.05, " << with_findings
            << " with a finding, of " << count << "\n";
  EXPECT_LE(far, 2 + 4e-3 * count * 0.75);
  EXPECT_LE(near, count * 0.05 + 4 * std::sqrt(count * 0.05));
  EXPECT_LE(with_findings, count * 0.03 + 4 * std::sqrt(count * 0.03));
}

TEST(FailurePicture, NoFindingIsLargerThanTheResidual) {
  // The temperature follows the direction within a tenth, and their errors of 0.1 mm cancel each other.
  const Machine machine = parse_machine(kMachine, "m.xml");
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  std::string text = "X[mm],Y[mm],Z[mm],dirX,T[degC],x[mm],y[mm],z[mm]\n";
  constexpr int kRows = 200;
  Eigen::VectorXd error(kRows);
  for (int i = 0; i < kRows; ++i) {
    const double sense = i % 2 == 0 ? 1 : -1, like = sense + 0.1 * normal(random);
    text += std::to_string(i) + ",0,0," + std::to_string(static_cast<int>(sense)) + "," +
            std::to_string(20 + 5 * like) + ",0,0,0\n";
    error[i] = 0.1 * (sense - 0.9 * like);
  }
  const Measurement m = parse_measurement(text, "survey", machine);
  Eigen::VectorXd residual = white(m, 1e-3, random);
  plant(residual, m, ObservationKind::kX, [&](Eigen::Index row) { return error[row]; });
  const FailurePicture picture = failure_picture(machine, m, residual);
  ASSERT_FALSE(picture.findings.empty());
  const double reach = 1e3 * (error.maxCoeff() - error.minCoeff());
  for (const Finding& one : picture.findings)
    EXPECT_LE(one.high_um - one.low_um, 1.2 * reach) << one.sentence;
}

TEST(FailurePicture, ResidualOfAFitWithManyParametersRaisesNoAlarm) {
  // Noise from which a bridge's tables (about 100 parameters) have been fitted, with and without its
  // Jacobian.
  std::mt19937_64 random(kSeed);
  const Machine machine = parse_machine(support::bridge_text(6), "bridge.xml");
  std::string text = "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm],run\n";
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> low, span;
  for (const Axis& axis : machine.axes) {
    low.push_back(axis.min.value_or(0));
    span.push_back(axis.max.value_or(100) - low.back());
  }
  for (int i = 0; i < 150; ++i) {
    for (std::size_t k = 0; k < 3; ++k) text += std::to_string(low[k] + span[k] * unit(random)) + ",";
    text += "0,0,0,s" + std::to_string(i / 50 + 1) + "\n";
  }
  const Measurement m = parse_measurement(text, "bridge", machine);
  const ParameterSet parameters(machine, m.states.run_names);
  const Linearisation linear = linearise(machine, m, parameters);
  Eigen::MatrixXd scaled = linear.jacobian;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k) scaled.col(k) /= std::max(1e-300, scaled.col(k).norm());
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  qr.setThreshold(1e-5);
  ASSERT_GT(qr.rank(), 60);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(scaled.rows(), qr.rank());
  StructureOptions by_number, by_jacobian;
  by_number.fitted_parameters = by_jacobian.fitted_parameters = static_cast<std::size_t>(qr.rank());
  by_jacobian.jacobian = &linear.jacobian;
  int far_number = 0, far_jacobian = 0, near_jacobian = 0;
  constexpr int kCount = 400;
  for (int i = 0; i < kCount; ++i) {
    Eigen::VectorXd r = white(m, 1e-3, random);
    r -= q * (q.transpose() * r);
    far_number += failure_picture(machine, m, r, by_number).omnibus_p < 1e-3;
    const double p = failure_picture(machine, m, r, by_jacobian).omnibus_p;
    far_jacobian += p < 1e-3;
    near_jacobian += p < 0.05;
  }
  std::cout << "rank " << qr.rank() << ": " << far_number << " by number, " << far_jacobian
            << " by Jacobian below 0.001, " << near_jacobian << " below 0.05, of " << kCount << "\n";
  EXPECT_LE(far_number, 3);
  EXPECT_LE(far_jacobian, 3);
  EXPECT_LE(near_jacobian, 40);
}

TEST(FailurePicture, OutliersAreNoStructure) {
  Planted p;
  int alarms = 0;
  for (int i = 0; i < 100; ++i) {
    p.residual = white(p.m, 1e-3, p.random);
    for (int k = 0; k < 6; ++k) p.residual[static_cast<Eigen::Index>(p.random() % 900)] += 0.05;
    alarms += p.picture().omnibus_p < 1e-3;
  }
  EXPECT_LE(alarms, 2);
  EXPECT_GE(p.picture().outliers, 4U);
}

TEST(FailurePicture, LargeErrorOnFewRowsKeepsItsSize) {
  // Proportional to a feed that is small on most rows: no outliers, and a line of full size.
  Planted p;
  for (Eigen::Index i = 0; i < p.m.states.feed.size(); ++i)
    p.m.states.feed[i] = i % 5 == 0 ? 2500.0 : 20.0 + static_cast<double>(i % 3);
  plant(p.residual, p.m, ObservationKind::kZ, [&](Eigen::Index i) { return -1e-4 * p.m.states.feed[i]; });
  const FailurePicture picture = p.picture();
  const Finding f = first(picture);
  EXPECT_EQ(f.column, "feed");
  EXPECT_EQ(f.shape, Shape::kLinear);
  EXPECT_NEAR(f.high_um - f.low_um, 248, 1);
  EXPECT_EQ(picture.outliers, 0U);
}

TEST(FailurePicture, SquareIsNamed) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kY,
        [&](Eigen::Index i) { return 4e-8 * p.axis(2)[i] * p.axis(2)[i]; });
  const FailurePicture picture = p.picture();
  ASSERT_EQ(picture.findings.size(), 1U);
  const Finding f = picture.findings[0];
  EXPECT_EQ(f.observation, "y");
  EXPECT_EQ(f.column, "Z");
  EXPECT_EQ(f.shape, Shape::kSquare);
  EXPECT_TRUE(f.in_all_runs);
  EXPECT_NEAR(f.high_um - f.low_um, 3.6, 0.6);  // 4e-8 * 300^2 mm; noise 1 um over 300 rows
  EXPECT_NE(f.sentence.find("Y error grows with Z, in proportion to its square"), std::string::npos)
      << f.sentence;
  EXPECT_NE(f.sentence.find("in all runs"), std::string::npos) << f.sentence;
  EXPECT_LT(picture.omnibus_p, 1e-6);
}

TEST(FailurePicture, LineIsNamedWithItsSlope) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kX, [&](Eigen::Index i) { return -5e-6 * p.axis(0)[i]; });
  const Finding f = first(p.picture());
  EXPECT_EQ(f.shape, Shape::kLinear);
  EXPECT_EQ(f.column, "X");
  EXPECT_NE(f.sentence.find("X error falls with X, in proportion (0."), std::string::npos) << f.sentence;
}

TEST(FailurePicture, ReversalIsNamed) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kZ,
        [&](Eigen::Index i) { return 1e-3 * p.m.states.direction[2][i]; });
  const Finding f = first(p.picture());
  EXPECT_EQ(f.shape, Shape::kReverses);
  EXPECT_EQ(f.column, "dirZ");
  EXPECT_NEAR(f.high_um - f.low_um, 2, 0.4);
  // Half of the variance: 1 um beside 1 um of noise.
  EXPECT_NEAR(f.share_alone, 0.5, 0.1);
  EXPECT_NEAR(f.share_after, 0.5, 0.1);
}

TEST(FailurePicture, JumpBetweenRunsIsNamed) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kX,
        [&](Eigen::Index i) { return p.m.states.run[static_cast<std::size_t>(i)] == 2 ? 2e-3 : 0; });
  const FailurePicture picture = p.picture();
  bool jumps = false;
  for (const Finding& f : picture.findings) jumps = jumps || f.shape == Shape::kJumps;
  EXPECT_TRUE(jumps) << first(picture).sentence;
}

TEST(FailurePicture, PeriodIsFound) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kX,
        [&](Eigen::Index i) { return 1.5e-3 * std::sin(2 * 3.14159265358979 * p.axis(0)[i] / 12.5 + 0.4); });
  const Finding f = first(p.picture());
  EXPECT_EQ(f.shape, Shape::kPeriodic);
  EXPECT_EQ(f.column, "X");
  ASSERT_TRUE(f.period.has_value());
  // A step of the scan: a quarter of a cycle over 600 mm, 48 cycles.
  EXPECT_NEAR(*f.period, 12.5, 12.5 / 48 / 4);
}

/// Findings of a period along X.
std::vector<Finding> periods(const FailurePicture& picture) {
  std::vector<Finding> list;
  for (const Finding& f : picture.findings)
    if (f.shape == Shape::kPeriodic && f.column == "X") list.push_back(f);
  return list;
}

/// A saw tooth of X with a period of 36.7 mm.
void plant_saw(Planted& saw, double height_mm) {
  plant(saw.residual, saw.m, ObservationKind::kX, [&](Eigen::Index i) {
    const double turns = saw.axis(0)[i] / 36.7;
    return height_mm * (turns - std::floor(turns) - 0.5);
  });
}

// A strong sine between two steps of the scan, and a pattern that is no sine: each is one finding.
TEST(FailurePicture, OnePatternIsOnePeriod) {
  Planted sine;
  plant(sine.residual, sine.m, ObservationKind::kX,
        [&](Eigen::Index i) { return 20e-3 * std::sin(2 * 3.14159265358979 * sine.axis(0)[i] / 20.37); });
  const std::vector<Finding> of_sine = periods(sine.picture());
  ASSERT_EQ(of_sine.size(), 1U);
  EXPECT_NEAR(*of_sine[0].period, 20.37, 0.02);  // 20 um beside 1 um of noise: a hundredth of a cycle of 29
  EXPECT_TRUE(of_sine[0].parts.empty());
  EXPECT_TRUE(of_sine[0].aliases.empty());  // the positions are scattered
  Planted saw;
  plant_saw(saw, 10e-3);
  const std::vector<Finding> of_saw = periods(saw.picture());
  ASSERT_EQ(of_saw.size(), 1U);
  // The overtones of the saw tooth are a noise for its period: a tenth of a cycle of the 16 in 600 mm.
  EXPECT_NEAR(*of_saw[0].period, 36.7, 36.7 / 16 / 10);
  ASSERT_GE(of_saw[0].parts.size(), 2U);
  EXPECT_NEAR(of_saw[0].parts[0], 36.7 / 2, 0.1);
  EXPECT_NE(of_saw[0].sentence.find("belong to this pattern"), std::string::npos);
}

// At even positions the multiples beyond half a period of the step appear at their aliases.
TEST(FailurePicture, AliasesOfOnePatternAreOneFinding) {
  Planted saw;
  for (double& x : saw.m.states.axis[0]) x = 5 * std::round(x / 5);
  plant_saw(saw, 20e-3);
  const std::vector<Finding> found = periods(saw.picture());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(*found[0].period, 36.7, 0.1);
  EXPECT_GE(found[0].parts.size(), 3U);
  ASSERT_EQ(found[0].aliases.size(), 2U);
  EXPECT_NEAR(found[0].aliases[1], 1 / (1 / 5.0 + 1 / 36.7), 0.02);
  EXPECT_NE(found[0].sentence.find("at positions 5 mm apart"), std::string::npos);
}

TEST(FailurePicture, InteractionIsNamed) {
  Planted p;
  const Column& t = p.m.states.input[0];
  const double mean = t.mean(), spread = std::sqrt((t - mean).square().mean());
  plant(p.residual, p.m, ObservationKind::kX,
        [&](Eigen::Index i) { return 1.5e-3 * (t[i] - mean) / spread * (p.axis(0)[i] - 300) / 173; });
  const FailurePicture picture = p.picture();
  bool found = false;
  for (const Finding& f : picture.findings)
    found = found || (f.shape == Shape::kProduct && f.observation == "x" && f.column == "X");
  EXPECT_TRUE(found) << first(picture).sentence;
}

TEST(FailurePicture, TwoEffectsAreBothNamed) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kX, [&](Eigen::Index i) {
    return 1e-3 * p.m.states.direction[0][i] + 1e-8 * std::pow(p.axis(1)[i] - 200, 2) * 10;
  });
  const FailurePicture picture = p.picture();
  std::set<std::string> columns;
  for (const Finding& f : picture.findings)
    if (f.shape != Shape::kConstant) columns.insert(f.observation + ":" + f.column);
  EXPECT_EQ(columns, (std::set<std::string>{"x:dirX", "x:Y"}));
}

TEST(FailurePicture, DoubleOfAColumnIsMentioned) {
  Planted p;
  CandidateInput twin{"X_scale", "mm", p.axis(0) * 1.001 + 0.5};
  p.m.candidates.push_back(twin);
  plant(p.residual, p.m, ObservationKind::kY, [&](Eigen::Index i) { return 8e-6 * p.axis(0)[i]; });
  const Finding f = first(p.picture());
  ASSERT_EQ(f.alike.size(), 1U);
  EXPECT_NE(f.sentence.find("along with it"), std::string::npos) << f.sentence;
}

TEST(FailurePicture, EffectInHalfOfTheRunsIsNotInAll) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kY, [&](Eigen::Index i) {
    return p.m.states.run[static_cast<std::size_t>(i)] < 2 ? 2e-5 * p.axis(0)[i] : 0;
  });
  const FailurePicture picture = p.picture();
  bool said = false;
  for (const Finding& f : picture.findings) {
    said = said || f.sentence.find("differently from run to run") != std::string::npos;
    EXPECT_FALSE(f.column == "X" && f.second_column.empty() && f.in_all_runs) << f.sentence;
  }
  EXPECT_TRUE(said);
}

TEST(FailurePicture, PowerAgainstSmoothErrors) {
  // Half as large as the noise, in one kind of three: seen with p < 0.001 in nearly every survey of 300 rows.
  Planted p;
  std::uniform_real_distribution<double> phase(0, 6.28);
  const std::vector<std::function<double(Eigen::Index, double)>> shapes = {
      [&](Eigen::Index i, double) { return (p.axis(0)[i] - 300) / 173; },
      [&](Eigen::Index i, double f) { return 1.414 * std::sin(p.axis(1)[i] / 90 + f); },
      [&](Eigen::Index i, double f) { return 1.414 * std::sin(p.axis(2)[i] / 1.6 + f); },
      [&](Eigen::Index i, double) { return (p.axis(0)[i] - 300) * (p.axis(2)[i] + 150) / 173 / 87; },
      [&](Eigen::Index i, double) { return p.m.states.direction[0][i] * (p.axis(0)[i] - 300) / 173; },
      [&](Eigen::Index i, double f) { return 1.414 * std::sin(static_cast<double>(i) / 12 + f); }};
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    int seen = 0;
    for (int n = 0; n < 50; ++n) {
      p.residual = white(p.m, 1e-3, p.random);
      const double f = phase(p.random);
      plant(p.residual, p.m, ObservationKind::kX, [&](Eigen::Index i) { return 0.5e-3 * shapes[k](i, f); });
      seen += p.picture().omnibus_p < 1e-3;
    }
    std::cout << "shape " << k << ": " << seen << " of 50\n";
    EXPECT_GE(seen, 45) << k;
  }
}

// A bed that is probed row by row: its shape is no drift.
TEST(FailurePicture, AShapeInSpaceIsNotCalledADrift) {
  const Machine machine = parse_machine(kMachine, "m");
  std::string text = "X[mm],Y[mm],Z[mm],t[s],z[mm],u[mm]\n";
  constexpr int kAcross = 12;
  for (int row = 0; row < kAcross * kAcross; ++row) {
    const int line = row / kAcross, at = row % kAcross;
    text += std::to_string(30 * (line % 2 == 0 ? at : kAcross - 1 - at)) + "," + std::to_string(30 * line) +
            ",0," + std::to_string(2 * row) + ",0,0.001\n";
  }
  const Measurement m = parse_measurement(text, "bed", machine);
  std::mt19937_64 random(20261130);
  Eigen::VectorXd residual = white(m, 0.001, random);
  plant(residual, m, ObservationKind::kZ, [&](Eigen::Index row) {
    const double x = m.states.axis[0][row], y = m.states.axis[1][row];
    return 0.02 * std::sin(x / 45) * std::sin(y / 40);
  });
  const FailurePicture picture = failure_picture(machine, m, residual, {});
  bool space = false;
  for (const Finding& f : picture.findings) {
    EXPECT_EQ(f.sentence.find("drifts slowly"), std::string::npos) << f.sentence;
    space = space || f.sentence.find("successive rows are neighbours in position") != std::string::npos;
  }
  EXPECT_TRUE(space);
}

TEST(FailurePicture, SmoothNoiseInTimeDoesNotAccuseColumns) {
  // First-order correlated noise (0.9) beside columns that wander as slowly: what comes of it may be called
  // drift, but no input may be accused in more than a few of 100 surveys.
  Planted p;
  int accused = 0, seen = 0;
  for (int i = 0; i < 100; ++i) {
    std::normal_distribution<double> noise(0, 1e-3);
    for (std::size_t kind = 0; kind < 3; ++kind) {
      double value = 0;
      for (std::size_t k = kind; k < p.m.observations.size(); k += 3) {
        value = 0.9 * value + noise(p.random);
        p.residual[static_cast<Eigen::Index>(k)] = value;
      }
    }
    for (CandidateInput& candidate : p.m.candidates) {
      double value = 0;
      for (double& at : candidate.value) at = value = 0.97 * value + noise(p.random);
    }
    bool input = false;
    const FailurePicture picture = p.picture();
    for (const Finding& f : picture.findings)
      input = input || f.column.starts_with("decoy") || f.column == "T" ||
              f.second_column.starts_with("decoy") || f.second_column == "T";
    accused += input;
    seen += picture.omnibus_p < 1e-3;
  }
  std::cout << accused << " surveys accuse an input, " << seen << " see structure, of 100\n";
  EXPECT_LE(accused, 10);
  EXPECT_GE(seen, 95);
}

TEST(FailurePicture, RepeatsTellNoiseFromLackOfFit) {
  std::mt19937_64 random(kSeed);
  const Machine machine = parse_machine(kMachine, "m.xml");
  std::string text = "X[mm],Y[mm],Z[mm],x[mm]\n";
  for (int i = 0; i < 200; ++i) text += std::to_string(30 * (i % 20)) + ",0,0,0\n";
  const Measurement m = parse_measurement(text, "repeats", machine);
  Eigen::VectorXd r = white(m, 1e-3, random);
  plant(r, m, ObservationKind::kX, [&](Eigen::Index i) { return i % 20 % 2 == 0 ? 2e-3 : -2e-3; });
  const FailurePicture picture = failure_picture(machine, m, r);
  ASSERT_TRUE(picture.pure_error_um && picture.lack_of_fit_um && picture.lack_of_fit_p);
  EXPECT_EQ(picture.repeat_freedom, 180U);
  EXPECT_NEAR(*picture.pure_error_um, 1, 0.2);  // 180 degrees of freedom: 5 %
  EXPECT_NEAR(*picture.lack_of_fit_um, 2, 0.25);
  EXPECT_LT(*picture.lack_of_fit_p, 1e-10);
}

TEST(FailurePicture, RepeatsOfOneInstrumentSayNothingOfAnother) {
  // GIVEN a right model, a laser of 0.5 um with repeats and a tracker of 5 um without
  std::mt19937_64 random(kSeed);
  const Machine machine = parse_machine(kMachine, "m.xml");
  std::string text = "X[mm],Y[mm],Z[mm],x[mm],u[um]\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(30 * (i % 20)) + ",0,0,0,0.5\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(5 * i + 1) + ",200,-100,0,5\n";
  Measurement m = parse_measurement(text, "both", machine);
  m.files = {"laser.csv", "tracker.csv"};
  std::normal_distribution<double> normal;
  Eigen::VectorXd r(200);
  for (std::size_t i = 0; i < 200; ++i) {
    m.file[i] = i < 100 ? 0 : 1;
    r[static_cast<Eigen::Index>(i)] = (i < 100 ? 0.5e-3 : 5e-3) * normal(random);
  }
  const FailurePicture picture = failure_picture(machine, m, r);
  // THEN the laser's repeats are compared with the laser's readings alone
  ASSERT_TRUE(picture.pure_error_um && picture.lack_of_fit_um);
  EXPECT_NEAR(*picture.pure_error_um, 0.5, 0.15);
  EXPECT_LT(*picture.lack_of_fit_um, 0.3);
}

TEST(FailurePicture, StatedUncertaintyIsTested) {
  std::mt19937_64 random(kSeed);
  const Machine machine = parse_machine(kMachine, "m.xml");
  const Measurement m = survey(machine, 120, 3, random, 4, true);
  const Eigen::VectorXd r = white(m, 1e-3, random);
  ASSERT_TRUE(failure_picture(machine, m, r).chi_p.has_value());
  EXPECT_GT(*failure_picture(machine, m, r).chi_p, 1e-3);
  EXPECT_LT(*failure_picture(machine, m, 1.3 * r).chi_p, 1e-6);
  // The tests of structure do not depend on the scale.
  EXPECT_NEAR(failure_picture(machine, m, 1.3 * r).omnibus_p, failure_picture(machine, m, r).omnibus_p, 1e-6);
}

TEST(FailurePicture, CellsHoldTheMeanVectorWhereItIs) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kZ, [&](Eigen::Index i) { return p.axis(0)[i] > 300 ? 5e-3 : 0; });
  const FailurePicture picture = p.picture();
  ASSERT_GT(picture.cells.size(), 8U);
  std::size_t rows = 0;
  for (const FailureCell& cell : picture.cells) {
    rows += cell.count;
    const double x = cell.point_mm[0];
    if (x > 180 && x < 420) continue;
    EXPECT_NEAR(cell.mean_um[2], x > 300 ? 5 : 0, 4 * cell.noise_um + 0.5);
  }
  EXPECT_EQ(rows, p.m.rows());
}

// An instrument 2 m away that is turned by 90 deg, and one in machine coordinates: one picture of the
// machine.
TEST(FailurePicture, CellsAreInMachineCoordinates) {
  std::string text = kMachine;
  text.insert(text.find("<machineaxes>"),
              R"(<static><BaseShift run="r0" X="2000" Y="0" Z="0" rX="0" rY="0" rZ="90"/></static>)");
  Planted p;
  p.machine = parse_machine(text, "m.xml");
  p.m = survey(p.machine, 300, 2, p.random);
  p.residual = white(p.m, 1e-3, p.random);
  // y of the first instrument is X of the machine.
  for (std::size_t i = 0; i < p.m.observations.size(); ++i) {
    const bool turned = p.m.observations[i].row < 150;
    if (p.m.observations[i].kind == (turned ? ObservationKind::kY : ObservationKind::kX))
      p.residual[static_cast<Eigen::Index>(i)] += 5e-3;
  }
  const FailurePicture picture = p.picture();
  ASSERT_GT(picture.cells.size(), 8U);
  for (const FailureCell& cell : picture.cells) {
    EXPECT_LE(cell.point_mm.maxCoeff(), 600);
    EXPECT_GE(cell.point_mm.minCoeff(), -300);
    EXPECT_LT((cell.mean_um - Eigen::Vector3d(5, 0, 0)).norm(), 5 * cell.noise_um + 0.5);
  }
}

TEST(FailurePicture, JsonHoldsFindingsSharesAndCells) {
  Planted p;
  plant(p.residual, p.m, ObservationKind::kX, [&](Eigen::Index i) { return -5e-6 * p.axis(0)[i]; });
  nlohmann::ordered_json json;
  const FailurePicture picture = p.picture();
  add_failure(json, picture);
  ASSERT_FALSE(json["findings"].empty());
  EXPECT_EQ(json["findings"][0]["shape"], "linear");
  EXPECT_EQ(json["findings"][0]["column"], "X");
  EXPECT_TRUE(json["findings"][0]["second_column"].is_null());
  EXPECT_EQ(json["structure"]["omnibus_p"], picture.omnibus_p);
  EXPECT_EQ(json["structure"]["cells"].size(), picture.cells.size());
  // Three kinds against 3 axes, 3 senses, feed, t, visit, run, T and 4 decoys.
  EXPECT_EQ(json["structure"]["shares"].size(), 45U);
}

TEST(FailurePicture, SaysWhatAResidualWithoutFindingsMeans) {
  FailurePicture picture;
  picture.omnibus_p = 0.4;
  const auto words = [&](nlohmann::ordered_json json) {
    add_failure(json, picture);
    return json["structure"]["no_findings"].get<std::string>();
  };
  EXPECT_EQ(words({{"rms_um", 21.0}, {"noise_um", 20.0}}), "the residual has no structure beyond chance");
  EXPECT_TRUE(words({{"rms_um", 67800.0}, {"noise_um", 20.0}}).starts_with("the residual is 3.39e+03 times"));
  EXPECT_NE(words({{"rms_um", 67800.0}, {"noise_um", nullptr}}).find("u is not stated"), std::string::npos);
  // One gross reading makes a large rms too, and is named as an outlier.
  picture.outliers = 1;
  EXPECT_EQ(words({{"rms_um", 200.0}, {"noise_um", 20.0}}), "the residual has no structure beyond chance");
  picture.outliers = 0;
  picture.findings.emplace_back();
  nlohmann::ordered_json json = {{"rms_um", 67800.0}, {"noise_um", 20.0}};
  add_failure(json, picture);
  EXPECT_TRUE(json["structure"]["no_findings"].is_null());
}

TEST(FailurePicture, RowsWithoutARunHaveAName) {
  Finding finding;
  finding.observation = "y";
  finding.column = "Y";
  finding.runs = 6;
  finding.runs_agreeing = 5;
  SentenceFacts facts;
  facts.disagreeing = {""};
  EXPECT_NE(sentence_of(finding, facts).find("(not in the rows without a run)"), std::string::npos)
      << sentence_of(finding, facts);
}

TEST(FailurePicture, NothingToTestIsNoError) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  const Measurement m = parse_measurement("X[mm],Y[mm],Z[mm],x[mm]\n1,2,3,0\n2,2,3,0\n", "two", machine);
  EXPECT_EQ(failure_picture(machine, m, Eigen::VectorXd::Zero(2)).omnibus_p, 1);
  Planted p;
  EXPECT_TRUE(failure_picture(p.machine, p.m, 0 * p.residual).findings.empty());
  // Noise-free structure is no chance.
  p.residual.setZero();
  plant(p.residual, p.m, ObservationKind::kX, [&](Eigen::Index i) { return 1e-5 * p.axis(0)[i]; });
  EXPECT_LT(p.picture().omnibus_p, 1e-12);
}

/// Several files: each reads a direction of its own in a run of its own, and one has a thermometer that the
/// others lack.
TEST(FailurePicture, ColumnAndRunOfOneFileOnlyAreNoneOfTheOthers) {
  const Machine machine = parse_machine(kMachine, "m.xml");
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> unit(0, 1);
  Measurement all;
  for (const std::string name : {"x", "y"}) {
    std::string text = "X[mm],Y[mm],Z[mm]," + name + "[mm],run" + (name == "x" ? ",room[degC]" : "") + "\n";
    for (int i = 0; i < 60; ++i)
      text += std::to_string(600 * unit(random)) + "," + std::to_string(400 * unit(random)) + ",0,0," + name +
              (name == "x" ? "," + std::to_string(20 + unit(random)) : "") + "\n";
    Measurement one = parse_measurement(text, name + ".csv", machine);
    if (name == "x")
      all = std::move(one);
    else
      append_measurement(all, std::move(one));
  }
  Eigen::VectorXd residual = white(all, 1e-3, random);
  EXPECT_GT(failure_picture(machine, all, residual).omnibus_p, 1e-3);
  // What the thermometer does say of its own file is found.
  plant(residual, all, ObservationKind::kX,
        [&](Eigen::Index row) { return 0.01 * (all.candidates.at(0).value[row] - 20.5); });
  EXPECT_EQ(first(failure_picture(machine, all, residual)).column, "room");
}

}  // namespace
}  // namespace vernier::structure_test
