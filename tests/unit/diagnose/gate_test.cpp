// SPDX-License-Identifier: GPL-3.0-or-later
// What rows that nothing was fitted to must say before something is named.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/proof.h"
#include "tools/diagnose/refit.h"
#include "tools/diagnose/sentences.h"
#include "tools/fit/fit.h"
#include "tools/model/machine_reader.h"

namespace vernier::gate_test {

using namespace vernier::diagnose;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 16;

const char* const kAxis = R"(<machine name="m"><variables><static><c value="0" unit="mm"/></static>
  <machineaxes><X rotary="false" min="0" max="500"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X+c" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>)";

/// Four runs of 120 rows along an axis, u 1 um, every `check_every`th a check row; reversal (mm) and noise
/// (u) of fit rows and of check rows.
struct Rows {
  double reversal = 0, check_reversal = 0, check_noise = 1;
  int check_every = 4;
  double noise = 1;
  int check_u = 1;  // um
};

std::string survey(const Rows& rows) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::uniform_real_distribution<double> place(0, 500);
  std::string text = "X[mm],dirX,x[mm],u[um],run,role\n";
  for (int row = 0; row < 480; ++row) {
    const bool check = row % rows.check_every == rows.check_every - 1;
    const double x = place(random), dir = (row / 3) % 2 == 0 ? 1 : -1;
    const double off = dir * (check ? rows.check_reversal : rows.reversal) +
                       (check ? rows.check_noise : rows.noise) * noise(random);
    text += fmt::format("{:.3f},{},{:.6f},{},r{},{}\n", x, dir, x + off, check ? rows.check_u : 1, row / 120,
                        check ? "check" : "fit");
  }
  return text;
}

Diagnosis diagnosed(const Rows& rows) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  return diagnose::diagnose(kAxis, machine, parse_measurement(survey(rows), "m.csv", machine));
}

// Check rows of a tracker that hardly sees what a laser shows: half a u of the tracker.
TEST(Gate, CheckRowsThatHardlySeeAStepDecideTogetherWithHeldOutRuns) {
  const Diagnosis few =
      diagnosed({.reversal = 0.003, .check_reversal = 0, .check_noise = 0, .check_every = 24, .check_u = 6});
  ASSERT_GE(few.ladder.size(), 2u);
  EXPECT_EQ(few.ladder[1].effect, "backlash") << "evidence of 20 check rows -2.5, the runs more than 1000";
  EXPECT_FALSE(few.ladder[1].of_check_rows);
  EXPECT_GT(few.ladder[1].evidence.value_or(0), 1000);
  // Enough of them to refute it: an evidence of 10 in the mean.
  const Diagnosis many =
      diagnosed({.reversal = 0.003, .check_reversal = 0, .check_noise = 0, .check_every = 6, .check_u = 6});
  EXPECT_EQ(many.ladder.size(), 1u);
  EXPECT_NE(many.verdict, Verdict::kMissingEffect);
}

/// One axis, read at 300 places without u and without repeats: a reversal, a drift (mm per hour) and noise,
/// mm.
Diagnosis without_u(double reversal, double drift, double noise_mm) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, noise_mm);
  std::uniform_real_distribution<double> place(0, 500);
  std::string text = "X[mm],dirX,t[s],x[mm]\n";
  for (int row = 0; row < 300; ++row) {
    const double x = place(random), dir = (row / 3) % 2 == 0 ? 1 : -1, hours = row / 300.0;
    text += fmt::format("{:.3f},{},{},{:.6f}\n", x, dir, 12 * row,
                        x + dir * reversal + hours * drift + noise(random));
  }
  const Machine machine = parse_machine(kAxis, "m.xml");
  return diagnose::diagnose(kAxis, machine, parse_measurement(text, "m.csv", machine));
}

TEST(Gate, WithoutUMostOfTheResidualIsNotPassedAsNoiseWithoutAWord) {
  const Diagnosis small = without_u(0.001, 0, 0.002), large = without_u(0.005, 0, 0.002);
  ASSERT_EQ(small.verdict, Verdict::kMissingEffect) << small.explanation;
  EXPECT_NE(small.explanation.find("Most of the residual remains"), std::string::npos) << small.explanation;
  EXPECT_EQ(large.verdict, Verdict::kMissingEffect);
  EXPECT_EQ(large.explanation.find("Most of the residual remains"), std::string::npos) << large.explanation;
}

TEST(Gate, AShiftInTimeMayBeThatOfTheInstrument) {
  const Diagnosis drift = without_u(0, 0.03, 0.002), none = without_u(0.005, 0, 0.002);
  ASSERT_EQ(drift.verdict, Verdict::kMissingEffect) << drift.explanation;
  EXPECT_NE(drift.explanation.find("stand that drifts gives the same readings"), std::string::npos)
      << drift.explanation;
  EXPECT_EQ(none.explanation.find("stand that drifts"), std::string::npos) << none.explanation;
}

TEST(Gate, AStepThatTheCheckRowsRefuseMakesRoomForAnother) {
  // The reason is stated beside the refused candidate.
  const Diagnosis many =
      diagnosed({.reversal = 0.003, .check_reversal = 0, .check_noise = 0, .check_every = 6, .check_u = 6});
  const auto refused = std::ranges::find_if(many.candidates, [](const CandidateFinding& one) {
    return one.why_not.find("the sum of squares of the check rows") != std::string::npos;
  });
  EXPECT_NE(refused, many.candidates.end());
}

TEST(Gate, AsksWhatATrueStepBringsAndNeverLessThanNothing) {
  const ProofThresholds limits;
  EXPECT_DOUBLE_EQ((Proof{-5, limits.evidence - 0.1}.asked(limits)), -0.5);
  EXPECT_DOUBLE_EQ((Proof{0, limits.evidence}.asked(limits)), 0);
  EXPECT_DOUBLE_EQ((Proof{0, 8}.asked(limits)), 0);
  // One true step in a hundred falls that far below its mean.
  EXPECT_NEAR((Proof{0, 14}.asked(limits)), 14 - 2.326348 * std::sqrt(28.0), 1e-5);
  EXPECT_DOUBLE_EQ((Proof{0, 100}.asked(limits)), limits.evidence);
}

// A laser run with many exact readings hid that the rows of a tracker became worse.
TEST(Gate, TheCheckRowsOfOneFileAloneContradictAStep) {
  Measurement rows = parse_measurement(survey({0.001, 0.001}), "m.csv", parse_machine(kAxis, "m.xml"));
  const auto count = static_cast<Eigen::Index>(rows.observations.size());
  Eigen::VectorXd before = Eigen::VectorXd::Constant(count, 0.002), after = before / 2;
  const Proof one = proof_on_check_rows(rows, before, after, {}, 1);
  EXPECT_GT(one.evidence, 0);
  EXPECT_TRUE(one.files.empty()) << "one file has no other beside it";

  rows.files.push_back("tracker.csv");
  std::size_t last = 0;
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    if (rows.check[rows.observations[i].row] != 0) last = i;
  rows.file[rows.observations[last].row] = 1;
  after[static_cast<Eigen::Index>(last)] = 0.006;
  const Proof two = proof_on_check_rows(rows, before, after, {}, 1);
  const double u = uncertainty_of(rows, rows.observations[last]);
  ASSERT_EQ(two.files.size(), 2U);
  EXPECT_EQ(two.files[1].file, 1U);
  EXPECT_NEAR(two.files[1].evidence, (0.002 * 0.002 - 0.006 * 0.006) / 2 / (u * u), 1e-9);
  EXPECT_NEAR(two.files[1].expected, 0.004 * 0.004 / 2 / (u * u), 1e-9);

  fit::FitResult with = fit::fit(parse_machine(kAxis, "m.xml"), rows), without = with;
  without.residual = before;
  with.residual = after;
  const ProofThresholds limits;
  const Eigen::VectorXd term = before - after;
  const auto contradicted = contradicting_file(two, limits, rows, without, with, term, {}, 1);
  ASSERT_TRUE(contradicted);
  EXPECT_EQ(contradicted->file, 1U);
  // A backlash, and a tracker whose rows state no direction: other parameters changed its residual.
  Eigen::VectorXd elsewhere = term;
  elsewhere[static_cast<Eigen::Index>(last)] = 0;
  EXPECT_FALSE(contradicting_file(two, limits, rows, without, with, elsewhere, {}, 1));
  // With parameters that are as uncertain, this row is no surprise.
  with.covariance = Eigen::MatrixXd::Constant(with.covariance.rows(), with.covariance.cols(), 10 * u * u);
  EXPECT_FALSE(contradicting_file(two, limits, rows, without, with, term, {}, 1));
}

TEST(Gate, CheckRowsOfEachFileAreCountedInUnitsOfTheirU) {
  Measurement rows = parse_measurement(survey({0.001, 0.001}), "m.csv", parse_machine(kAxis, "m.xml"));
  const auto count = static_cast<Eigen::Index>(rows.observations.size());
  Eigen::VectorXd residual = Eigen::VectorXd::Constant(count, 0.002);
  EXPECT_TRUE(checks_of_files(rows, residual).empty()) << "one file has no other beside it";
  rows.files.push_back("tracker.csv");
  std::size_t last = 0;
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    if (rows.check[rows.observations[i].row] != 0) last = i;
  rows.file[rows.observations[last].row] = 1;
  residual[static_cast<Eigen::Index>(last)] = 0.006;
  const double u = uncertainty_of(rows, rows.observations[last]);
  const std::vector<CheckOfFile> files = checks_of_files(rows, residual);
  ASSERT_EQ(files.size(), 2U);
  EXPECT_NEAR(files[0].rms, 0.002 / u, 1e-9);
  EXPECT_EQ(files[1].file, "tracker.csv");
  EXPECT_NEAR(files[1].rms, 0.006 / u, 1e-9);
  LadderStep first, last_step;
  first.check_rms_um = 3.99, last_step.check_rms_um = 4.31;
  first.check_files = {{"z.csv", 3.07}, {"tracker.csv", 1.12}};
  last_step.said = "Z carriage: backlash";
  last_step.check_files = {{"z.csv", 0.76}, {"tracker.csv", 1.23}};
  EXPECT_NE(check_rows_in_words({first, last_step}, 1).find("in each file: z.csv 3.07 to 0.76, tracker.csv"),
            std::string::npos)
      << check_rows_in_words({first, last_step}, 1);
}

TEST(Gate, AStepThatCheckRowsBearOutIsConfirmedByThem) {
  const Diagnosis answer = diagnosed({0.001, 0.001});

  ASSERT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(answer.ladder.back().effect, "backlash");
  EXPECT_TRUE(answer.ladder.back().confirmed.value_or(false));
  EXPECT_GT(answer.ladder.back().evidence.value_or(0), ProofThresholds().evidence);
}

// Named and "confirmed" before: 24 check rows are too few to deny it at 100 to 1, and they get worse by it.
// Then "consistent": what check rows refuse stands out of the noise of the fit rows all the same.
TEST(Gate, AStepThatMakesFewCheckRowsWorseIsNotNamed) {
  const Diagnosis answer = diagnosed({0.0006, -0.0006, 1, 20});

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(answer.ladder.size(), 1U);
  EXPECT_NE(answer.explanation.find("do not confirm"), std::string::npos) << answer.explanation;
}

// Consistent, or named, before: the check rows entered no verdict as a whole.
TEST(Gate, AnAnswerThatDoesNotCarryToCheckRowsIsNone) {
  for (const double reversal : {0.0, 0.002}) {
    const Diagnosis answer = diagnosed({reversal, reversal, 2});

    EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << answer.explanation;
    EXPECT_NE(answer.explanation.find("not confirmed on held-out rows"), std::string::npos)
        << answer.explanation;
  }
  EXPECT_EQ(diagnosed({}).verdict, Verdict::kConsistent);
}

// Unexplained before: copies of what was named stood out of a noise larger than stated, which it was not
// taken out of.
TEST(Gate, TwiceTheStatedNoiseDoesNotHideACause) {
  const Diagnosis answer = diagnosed({0.004, 0.004, 2, 4, 2});

  EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_EQ(answer.ladder.back().effect, "backlash");
  EXPECT_EQ(diagnosed({0, 0, 2, 4, 2}).verdict, Verdict::kConsistent);
}

/// An axis that grows with the temperature T, and with a quantity that changes as slowly and that no column
/// has: um per degC and m, um. u 1 um, four runs, every fourth row a check row.
std::string warm_survey(double growth, double unlogged) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> place(0, 500);
  std::string text = "X[mm],x[mm],T[degC],t[s],u[um],run,role\n";
  double warm = 0, hidden = 0;
  for (int row = 0; row < 480; ++row) {
    warm = 0.98 * warm + 0.2 * normal(random);
    hidden = 0.9 * hidden + 0.44 * normal(random);
    const double x = place(random), part = x / 500;
    const double off = 1e-3 * ((growth * warm + unlogged * hidden) * part + normal(random));
    text += fmt::format("{:.3f},{:.6f},{:.3f},{},1,r{},{}\n", x, x + off, 20 + warm, 40 * row, row / 120,
                        row % 4 == 3 ? "check" : "fit");
  }
  return text;
}

// Named before: the drift of the noise model took the unlogged quantity in, and whitened check rows
// confirmed.
TEST(Gate, ANameBesideADriftThatUDoesNotStateIsACandidateOnly) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const auto answer_of = [&](double unlogged, double plausible) {
    DiagnoseOptions options;
    options.thresholds.verdict.doubtful_uncertainty = plausible;
    options.thresholds.shape.course_share = 1;  // the rule of another course would withdraw it, too
    return diagnose::diagnose(kAxis, machine, parse_measurement(warm_survey(4, unlogged), "m.csv", machine),
                              options);
  };
  const double plausible = VerdictThresholds().doubtful_uncertainty;

  const Diagnosis alone = answer_of(0, plausible), beside = answer_of(3, plausible);

  EXPECT_EQ(alone.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << alone.explanation;
  ASSERT_GT(beside.noise.drift, 0) << beside.explanation;
  ASSERT_GT(beside.ladder.size(), 1U) << beside.explanation;
  EXPECT_EQ(beside.verdict, Verdict::kUnexplained) << "seed " << kSeed << ": " << beside.explanation;
  EXPECT_NE(beside.explanation.find("No cause is named"), std::string::npos) << beside.explanation;
  EXPECT_TRUE(beside.causes.empty());
  // If u may be three times too small, the name stands: the rule alone withdraws it. But a name that explains
  // less than the drift leaves does not stand.
  EXPECT_EQ(answer_of(3, 9).verdict, Verdict::kMissingEffect);
  EXPECT_EQ(answer_of(5, 9).verdict, Verdict::kUnexplained);
}

TEST(Gate, AnotherResponseIsNotRejectedIfItFitsAndPredictsBetter) {
  const Machine machine = parse_machine(kAxis, "m.xml");
  const Measurement rows = parse_measurement(survey({}), "m.csv", machine);
  const auto residual = [&](double fit_um, double check_um) {
    Eigen::VectorXd all(static_cast<Eigen::Index>(rows.observations.size()));
    for (Eigen::Index i = 0; i < all.size(); ++i)
      all[i] =
          1e-3 * (rows.check[rows.observations[static_cast<std::size_t>(i)].row] != 0 ? check_um : fit_um);
    return all;
  };
  const auto better = [&](double fit_um, double check_um) {
    return fits_and_predicts_better(rows, residual(1, 1), residual(fit_um, check_um), {});
  };

  EXPECT_TRUE(better(0.99, 0.99));
  EXPECT_FALSE(better(0.99, 1.01));
  EXPECT_FALSE(better(1.01, 0.99));
  EXPECT_FALSE(better(1, 1));
}

}  // namespace
}  // namespace vernier::gate_test
