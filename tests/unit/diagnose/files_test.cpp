// SPDX-License-Identifier: GPL-3.0-or-later
// Surveys of several instruments, and noise beside a stated u.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/files.h"

namespace vernier::files_test {

using namespace vernier::diagnose;
using testing::HasSubstr;
using testing::SizeIs;
namespace {

const std::string kHidden = std::string(VERNIER_SOURCE_DIR) + "/tests/data/hidden/";

Diagnosis diagnosed(const std::string& folder, const std::vector<std::string>& files) {
  const std::string text = text::read_file(kHidden + folder + "/model.xml");
  const model::Machine machine = model::parse_machine(text, "model.xml");
  std::vector<std::string> paths;
  for (const std::string& file : files) paths.push_back(kHidden + folder + "/" + file);
  return diagnose::diagnose(text, machine, model::read_measurement(paths, machine));
}

std::vector<std::string> names_of(const Diagnosis& answer) {
  std::vector<std::string> names;
  for (const Cause& cause : answer.causes)
    names.push_back(cause.candidate ? cause.candidate->choice.effect->id : cause.kind);
  return names;
}

TEST(Files, ADriftOfOneInstrumentIsACauseBesideHeat) {
  const Diagnosis answer = diagnosed("laser_drifts_as_it_warms", {"laser.csv", "tracker.csv"});

  EXPECT_EQ(answer.verdict, Verdict::kAmbiguous) << answer.explanation;
  EXPECT_THAT(names_of(answer), testing::Contains("drift"));
  EXPECT_THAT(answer.explanation, HasSubstr("laser.csv alone is a further possible cause"));
}

// The same machine and instruments, and X grows with the temperature: both instruments see it.
TEST(Files, HeatOfTheMachineIsNoDriftOfOneInstrument) {
  const std::string text = text::read_file(kHidden + "laser_drifts_as_it_warms/model.xml");
  const model::Machine machine = model::parse_machine(text, "model.xml");
  constexpr std::uint64_t kSeed = 7;
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> place(0, 1);
  const auto growth = [](double x, double t_degC) { return x * 25e-6 * (t_degC - 20); };  // 25 um/m/K
  std::string rows = "X[mm],Y[mm],Z[mm],t[s],T_a[degC],x[mm],y[mm],z[mm],u[mm],run,setup,role\n";
  for (int i = 0; i < 80; ++i) {
    const double x = 30 + 540 * (i % 2 == 0 ? i : 80 - i) / 80.0, t = 11.0 * i, warm = 20 + 3.0 * i / 80;
    rows += fmt::format("{:.3f},200,-150,{},{:.2f},{:.6f},,,0.0008,L,LS,{}\n", x, t, warm,
                        x + growth(x, warm) + 0.0008 * noise(random), i % 5 == 4 ? "check" : "fit");
  }
  for (int i = 0; i < 80; ++i) {
    const double x = 600 * place(random), y = 400 * place(random), z = -300 * place(random), t = 13.0 * i,
                 warm = 20 + 3.0 * i / 80;
    rows +=
        fmt::format("{:.3f},{:.3f},{:.3f},{},{:.2f},{:.6f},{:.6f},{:.6f},0.005,T,TR,{}\n", x, y, z, t, warm,
                    x + 30 + growth(x, warm) + 0.005 * noise(random), y - 45 + 0.005 * noise(random),
                    z - 130 + 0.005 * noise(random), i % 5 == 4 ? "check" : "fit");
  }
  model::Measurement measurement = model::parse_measurement(rows, "laser.csv", machine);
  measurement.files.push_back("tracker.csv");
  for (std::size_t row = measurement.rows() / 2; row < measurement.rows(); ++row) measurement.file[row] = 1;

  const Diagnosis answer = diagnose::diagnose(text, machine, measurement);

  EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << "seed " << kSeed << ": " << answer.explanation;
  EXPECT_THAT(names_of(answer), SizeIs(1));
}

// By chance the play of an angle is 4 better in chi^2: rows held out may not exclude the backlash that was
// there.
TEST(Files, ACauseThatFitsNearlyAsWellIsNotExcludedByRowsHeldOut) {
  const Diagnosis answer = diagnosed("play_or_backlash", {"laser.csv", "tracker.csv"});

  EXPECT_EQ(answer.verdict, Verdict::kAmbiguous) << answer.explanation;
  EXPECT_THAT(names_of(answer), testing::UnorderedElementsAre("lateral-play", "backlash"));
}

// The errors of single readings are 2.8 u, and a candidate stands out: this is no noise.
TEST(Files, ReadingsFarBeyondUAreNoNoiseBesideACandidateThatStandsOut) {
  const Diagnosis answer = diagnosed("wave_of_another_joint", {"survey.csv"});

  EXPECT_EQ(answer.verdict, Verdict::kUnexplained) << answer.explanation;
}

}  // namespace
}  // namespace vernier::files_test
