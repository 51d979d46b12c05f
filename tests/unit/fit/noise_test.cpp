// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/noise/noise.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <random>

#include "tools/fit/fit.h"
#include "tools/fit/noise/noise_estimate.h"
#include "tools/model/machine_reader.h"

namespace vernier::noise_test {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

constexpr unsigned kSeed = 20261122;

const Machine& machine() {
  static const Machine kMachine = parse_machine(
      "<machine><variables><static><k value=\"0\" nominal=\"0\"/></static><machineaxes>"
      "<X min=\"0\" max=\"100\"/></machineaxes></variables>"
      "<transforms><sixdof X=\"X+k*X\"/></transforms></machine>",
      "one.xml");
  return kMachine;
}

/// `rows` rows of `runs` runs in order of time, each pose read `repeats` times in a row within 2 um.
Measurement survey(std::size_t rows, std::size_t runs, std::size_t repeats, std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(0, 100), little(-0.001, 0.001);
  std::string csv = "t[s],X[mm],x[mm],u[mm],run\n";
  double at = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    if (row % repeats == 0) at = place(random);
    const double read = at + (repeats > 1 ? little(random) : 0);
    csv += std::to_string(10 * row) + "," + std::to_string(read) + "," + std::to_string(read) + ",0.001,r" +
           std::to_string(row * runs / rows) + "\n";
  }
  return parse_measurement(csv, "survey.csv", machine());
}

std::vector<std::size_t> all_of(const Measurement& m) {
  std::vector<std::size_t> all(m.observations.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

/// Draws readings with the model's covariance: V x by its own product, taken apart by Cholesky.
Eigen::VectorXd draw(const NoiseLayout& layout, const NoiseModel& model, Eigen::Index n,
                     std::mt19937_64& random) {
  const Eigen::MatrixXd covariance = covariance_times(layout, model, Eigen::MatrixXd::Identity(n, n));
  std::normal_distribution<double> normal;
  const Eigen::VectorXd white = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
  return Eigen::LLT<Eigen::MatrixXd>(covariance).matrixL() * white;
}

NoiseModel model_of(double own, double pose, double run, double drift, double time_constant) {
  NoiseModel model;
  model.own = own;
  model.pose = pose;
  model.run = run;
  model.drift = drift;
  model.time_constant = time_constant;
  model.in_time = true;
  return model;
}

TEST(NoiseModel, WhiteningInvertsTheCovariance) {
  std::mt19937_64 random(kSeed);
  const Measurement m = survey(60, 3, 3, random);
  const NoiseLayout layout = noise_layout(m, all_of(m));
  EXPECT_TRUE(layout.in_time);
  EXPECT_TRUE(layout.has_runs);
  EXPECT_TRUE(layout.has_poses);
  const Eigen::Index n = 60;
  for (const NoiseModel& model : {model_of(1, 0, 0, 0, 0), model_of(2, 0.7, 0, 0, 0), model_of(1, 0, 3, 0, 0),
                                  model_of(0.5, 0, 0, 2, 70), model_of(1.5, 0.7, 3, 2, 300)}) {
    const Eigen::MatrixXd covariance = covariance_times(layout, model, Eigen::MatrixXd::Identity(n, n));
    EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-12 * covariance.norm());
    Eigen::MatrixXd whitened = covariance;
    const double log_det = whiten(layout, model, whitened);
    // W V W' = 1: whitening V and then its transpose.
    Eigen::MatrixXd unit = whitened.transpose();
    whiten(layout, model, unit);
    EXPECT_LT((unit - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-10);
    EXPECT_NEAR(log_det,
                2 * Eigen::LLT<Eigen::MatrixXd>(covariance).matrixLLT().diagonal().array().log().sum(), 1e-9);
    // The transposed matrix, and the matrix itself, of the columns of the identity.
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n), transposed = matrix;
    whiten(layout, model, matrix);
    whiten_transposed(layout, model, transposed);
    EXPECT_LT((transposed - matrix.transpose()).norm(), 1e-12 * matrix.norm());
  }
}

/// 120 rows of x, y and z, one each 10 s.
Measurement survey_of_points() {
  std::string csv = "t[s],X[mm],x[mm],y[mm],z[mm],u[mm]\n";
  for (int row = 0; row < 120; ++row)
    csv += std::to_string(10 * row) + "," + std::to_string(37 * row % 100) + ",0,0,0,0.001\n";
  return parse_measurement(csv, "points.csv", machine());
}

constexpr std::uint32_t kX = 1U << 0, kY = 1U << 1, kZ = 1U << 2;  // of ReadingKind

TEST(NoiseModel, OneKindMayDriftAlone) {
  std::mt19937_64 random(kSeed);
  const Measurement m = survey_of_points();
  const NoiseLayout layout = noise_layout(m, all_of(m));
  const auto n = static_cast<Eigen::Index>(m.observations.size());
  NoiseModel truth = model_of(1, 0, 0, 4, 3000);
  truth.drifts = kZ;
  const Eigen::MatrixXd covariance = covariance_times(layout, truth, Eigen::MatrixXd::Identity(n, n));
  Eigen::MatrixXd whitened = covariance;
  whiten(layout, truth, whitened);
  Eigen::MatrixXd unit = whitened.transpose();
  whiten(layout, truth, unit);
  EXPECT_LT((unit - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-10);
  const Eigen::MatrixXd none(n, 0);
  for (const std::uint32_t drifts : {kZ, kY, kX | kZ, 0U}) {
    truth.drifts = drifts;
    const NoiseModel found = estimate_noise(layout, draw(layout, truth, n, random), none, false, {});
    EXPECT_EQ(found.drifts, drifts);
    EXPECT_NEAR(found.own, 1, 0.2);
    EXPECT_GT(found.drift, 1.5);
  }
  truth.drifts = kZ;
  EXPECT_NE(in_words(truth, {}).find("that lasts 3e+03 s in z"), std::string::npos) << in_words(truth, {});
  truth.drifts = 0;
  EXPECT_TRUE(drifting_kinds(truth).empty());
}

// An instrument drifts on between two runs. Runs whose times begin at zero anew, or with clocks of their own,
// are not in one time.
TEST(NoiseLayout, DriftContinuesWhereTheTimesOfTheRunsContinue) {
  const auto clocks = [](const std::string& csv) {
    const Measurement m = parse_measurement(csv, "runs.csv", machine());
    return noise_layout(m, all_of(m)).series.at(0).clock;
  };
  const std::string head = "t[s],X[mm],x[mm],run";
  EXPECT_EQ(clocks(head + "\n0,1,1,a\n9,2,2,a\n30,1,1,b\n39,2,2,b\n"), (std::vector<int>{0, 0, 0, 0}));
  EXPECT_EQ(clocks(head + "\n0,1,1,a\n9,2,2,a\n0,1,1,b\n9,2,2,b\n"), (std::vector<int>{0, 0, 1, 1}));
  EXPECT_EQ(clocks(head + "\n0,1,1,a\n9,2,2,a\n9,1,1,b\n18,2,2,b\n"), (std::vector<int>{0, 0, 1, 1}));
  EXPECT_EQ(clocks(head + ",clock\n0,1,1,a,p\n9,2,2,a,p\n30,1,1,b,q\n39,2,2,b,q\n"),
            (std::vector<int>{0, 0, 1, 1}));
}

TEST(NoiseModel, IsFoundAgain) {
  std::mt19937_64 random(kSeed);
  const Measurement m = survey(600, 12, 3, random);
  const NoiseLayout layout = noise_layout(m, all_of(m));
  const Eigen::MatrixXd nothing(600, 0);
  const NoiseModel pose =
      estimate_noise(layout, draw(layout, model_of(1, 2, 0, 0, 0), 600, random), nothing, true);
  EXPECT_NEAR(pose.pose, 2, 0.5);
  EXPECT_EQ(pose.run, 0);
  EXPECT_EQ(pose.drift, 0);
  const NoiseModel run =
      estimate_noise(layout, draw(layout, model_of(1, 0, 3, 0, 0), 600, random), nothing, true);
  EXPECT_NEAR(run.run, 3, 1.8);  // of 12 runs: a fifth of it is one standard deviation
  EXPECT_NEAR(run.own, 1, 0.1);
  const NoiseModel drift =
      estimate_noise(layout, draw(layout, model_of(1, 0, 0, 3, 200), 600, random), nothing, true);
  EXPECT_NEAR(drift.drift, 3, 1.2);
  EXPECT_NEAR(std::log(drift.time_constant / 200), 0, std::log(3.0));
  EXPECT_GT(drift.support, 100);
  const NoiseModel twice =
      estimate_noise(layout, draw(layout, model_of(2, 0, 0, 0, 0), 600, random), nothing, true);
  EXPECT_TRUE(twice.independent());
  EXPECT_NEAR(twice.own, 2, 0.2);
}

/// A slow scatter below u is no drift of the instrument, however long the drift that would describe it.
TEST(NoiseModel, SlowScatterBelowTheStatedUncertaintyIsNoDrift) {
  std::mt19937_64 random(kSeed);
  const Measurement m = survey(90, 1, 1, random);
  const NoiseLayout layout = noise_layout(m, all_of(m));
  Eigen::VectorXd residual(90);
  for (Eigen::Index i = 0; i < 90; ++i) residual[i] = 0.5 * std::sin(4e-2 * static_cast<double>(i));
  const NoiseModel found = estimate_noise(layout, residual, Eigen::MatrixXd(90, 0), true);
  EXPECT_EQ(found.drift, 0);
  EXPECT_GE(found.own, 1);
  EXPECT_GT(estimate_noise(layout, 4 * residual, Eigen::MatrixXd(90, 0), true).drift, 0);
}

// Moves take between a second and minutes; what goes from one reading to the next does not ask how long.
TEST(NoiseModel, DriftGoesByRowsWhereTimeDoesNotTellIt) {
  std::mt19937_64 random(kSeed);
  Measurement m = survey(600, 2, 1, random);
  std::uniform_real_distribution<double> log_pause(0, std::log(600.0));
  double time = 0;
  for (Eigen::Index row = 0; row < 600; ++row) m.states.time[row] = time += std::exp(log_pause(random));
  const NoiseLayout layout = noise_layout(m, all_of(m));
  NoiseModel by_rows = model_of(0.3, 0, 0, 1, 20);
  by_rows.in_time = false;
  const NoiseModel found =
      estimate_noise(layout, draw(layout, by_rows, 600, random), Eigen::MatrixXd(600, 0), true);
  EXPECT_FALSE(found.in_time);
  EXPECT_NEAR(std::log(found.time_constant / 20), 0, std::log(2.0));
}

// u states the whole of a reading, and nearly all of it hangs together here.
TEST(NoiseModel, TheOwnPartMayBeBelowUWhereTheWholeIsNot) {
  std::mt19937_64 random(kSeed);
  const Measurement m = survey(600, 2, 1, random);
  const NoiseLayout layout = noise_layout(m, all_of(m));
  const NoiseModel found = estimate_noise(layout, draw(layout, model_of(0.1, 0, 0, 1, 200), 600, random),
                                          Eigen::MatrixXd(600, 0), true);
  EXPECT_LT(found.own, 0.3);
  EXPECT_NEAR(found.total(), 1, 0.35);  // some thirty stretches of it
  EXPECT_GE(found.total(), 1 - 1e-9);
}

TEST(NoiseModel, IndependentReadingsAreLeftAlone) {
  std::mt19937_64 random(kSeed);
  const Measurement m = survey(300, 3, 2, random);
  const NoiseLayout layout = noise_layout(m, all_of(m));
  int hanging = 0;
  for (int survey = 0; survey < 100; ++survey)
    hanging +=
        estimate_noise(layout, draw(layout, {}, 300, random), Eigen::MatrixXd(300, 0), true).independent()
            ? 0
            : 1;
  EXPECT_LE(hanging, 3);
}

TEST(NoiseModel, AStepOfTheInstrumentIsFoundWhereItIs) {
  std::mt19937_64 random(kSeed);
  const Measurement m = survey(300, 1, 1, random);
  const NoiseLayout layout = noise_layout(m, all_of(m));
  Eigen::VectorXd residual = draw(layout, {}, 300, random);
  residual.tail(120).array() += 2;
  const NoiseModel found = estimate_noise(layout, residual, Eigen::MatrixXd(300, 0), true);
  ASSERT_EQ(found.steps.size(), 1u);
  EXPECT_NEAR(static_cast<double>(found.steps[0].row), 180, 5);
  EXPECT_NEAR(found.steps[0].height, 2, 4 * found.steps[0].std);
  EXPECT_EQ(found.drift, 0);
  // Its size is in the u of its own row, not in the rms of u over files with other instruments.
  const double u_um = 1e3 * m.uncertainty[static_cast<Eigen::Index>(found.steps[0].row)];
  EXPECT_DOUBLE_EQ(found.steps[0].unit, u_um);
  const NoiseUnit of_all{8 * u_um, 1, false};
  EXPECT_NEAR(std::stod(step_in_words(found.steps[0], of_all)), found.steps[0].height * u_um, 0.01 * u_um);
}

// Three of six before, and the rest a drift.
TEST(NoiseModel, AJumpInAllDirectionsIsTwoStepsInEach) {
  std::mt19937_64 random(kSeed);
  std::string csv = "X[mm],x[mm],y[mm],z[mm],u[mm],run\n";
  for (int row = 0; row < 240; ++row) csv += std::to_string(row % 100) + ",0,0,0,0.001,r\n";
  const Measurement m = parse_measurement(csv, "survey.csv", machine());
  const NoiseLayout layout = noise_layout(m, all_of(m));
  Eigen::VectorXd residual = draw(layout, {}, 720, random);
  const std::array<double, 3> height = {2, -1.5, 2.5};
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (m.observations[i].row >= 80 && m.observations[i].row < 160)
      residual[static_cast<Eigen::Index>(i)] += height[static_cast<std::size_t>(m.observations[i].kind)];
  const NoiseModel found = estimate_noise(layout, residual, Eigen::MatrixXd(720, 0), true);
  ASSERT_EQ(found.steps.size(), 6u);
  EXPECT_EQ(found.drift, 0);
  for (const NoiseStep& step : found.steps)
    EXPECT_LT(
        std::min(std::abs(static_cast<double>(step.row) - 80), std::abs(static_cast<double>(step.row) - 160)),
        4)
        << step.row;
  // Two places, six heights.
  EXPECT_DOUBLE_EQ(found.price(), 2 * 2 + 6);
}

TEST(NoiseModel, UncertaintyOfAParameterHasItIn) {
  std::mt19937_64 random(kSeed);
  double squares = 0, alone = 0;
  constexpr int kSurveys = 60;
  for (int i = 0; i < kSurveys; ++i) {
    Measurement m = survey(300, 1, 1, random);
    // A slow axis: position follows time, so that a drift looks like its scale.
    for (std::size_t row = 0; row < m.rows(); ++row)
      m.states.axis[0][static_cast<Eigen::Index>(row)] = 100 * static_cast<double>(row) / 300;
    const NoiseLayout layout = noise_layout(m, all_of(m));
    const Eigen::VectorXd error = draw(layout, model_of(1, 0, 0, 2, 400), 300, random);
    for (std::size_t k = 0; k < m.observations.size(); ++k)
      m.observations[k].value = m.states.axis[0][static_cast<Eigen::Index>(m.observations[k].row)] +
                                0.001 * error[static_cast<Eigen::Index>(k)];
    FitOptions independent;
    independent.noise = NoiseModel{};
    const FitResult told = fit::fit(machine(), m), white = fit::fit(machine(), m, independent);
    EXPECT_EQ(told.estimates[0].value, white.estimates[0].value);
    squares += std::pow(told.estimates[0].value / told.estimates[0].std, 2) / kSurveys;
    alone += std::pow(white.estimates[0].value / white.estimates[0].std, 2) / kSurveys;
  }
  // Rms of z: 1 give or take a tenth from 60 surveys, and the estimated drift is a little small; taken for
  // independent, 3 and more.
  EXPECT_LT(std::sqrt(squares), 1.5);
  EXPECT_GT(std::sqrt(squares), 0.6);
  EXPECT_GT(std::sqrt(alone), 2.0);
}

}  // namespace
}  // namespace vernier::noise_test
