// SPDX-License-Identifier: GPL-3.0-or-later
// Structures that warm through: growth and bending that follow their thermometers with several delays.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "tools/diagnose/diagnosis.h"
#include "tools/effects/add.h"
#include "tools/effects/add_string.h"
#include "tools/model/machine_reader.h"

namespace vernier::responses_test {

using namespace vernier::diagnose;
using namespace vernier::model;
namespace {

const char* const kColumn = R"(<machine name="column"><variables><static>
    <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/></static>
  <machineaxes><X min="0" max="600"/><Z min="0" max="500"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X"/><sixdof n="2" Z="Z"/></transforms></machine>)";

/// A wall of layers between the front, which a spindle heats, and the back in the air of the hall: heat
/// conduction by explicit differences.
class Wall {
 public:
  /// One step of 10 s with the spindle at `load` (0 to 1).
  void step(double load) {
    motor_ += 10.0 / 900 * (20 + 25 * load - motor_);
    std::array<double, kLayers> next = layer_;
    for (std::size_t i = 0; i < kLayers; ++i) {
      const double left = i == 0 ? motor_ : layer_[i - 1];
      const double right = i + 1 == kLayers ? 20 : layer_[i + 1];
      next[i] += 0.03 * (left - layer_[i]) + (i + 1 == kLayers ? 0.01 : 0.03) * (right - layer_[i]);
    }
    layer_ = next;
  }
  double front() const { return layer_[1]; }
  double back() const { return layer_[kLayers - 2]; }
  double mean() const {
    double sum = 0;
    for (const double t : layer_) sum += t;
    return sum / kLayers;
  }
  /// Difference of the halves, which bends the column.
  double gradient() const {
    double sum = 0;
    for (std::size_t i = 0; i < kLayers; ++i) sum += (i < kLayers / 2 ? 1 : -1) * layer_[i];
    return 2 * sum / kLayers;
  }

 private:
  static constexpr std::size_t kLayers = 12;
  std::array<double, kLayers> layer_ = [] {
    std::array<double, kLayers> cold;
    cold.fill(20);
    return cold;
  }();
  double motor_ = 20;
};

/// Days of 6 hours with duty cycles of their own, a reading each 200 s at two heights. um_per_degC 0: nothing
/// is hidden.
std::string days(std::uint64_t seed, double um_per_degC) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 0.0015);
  std::uniform_real_distribution<double> unit(0, 1);
  std::string text = "X[mm],Z[mm],x[mm],z[mm],T_front[degC],T_back[degC],t[s],u[um],run,role\n";
  for (int day = 0; day < 6; ++day) {
    Wall wall;
    double load = unit(random);
    for (int i = 0, change = 60; i < 2160; ++i) {
      if (i == change) {
        load = unit(random) < 0.4 ? 0 : unit(random);
        change += 60 + static_cast<int>(400 * unit(random));
      }
      wall.step(load);
      if (i % 20 != 0) continue;
      for (const double z : {100.0 + 300 * unit(random), 400 * unit(random)}) {
        const double x = 600 * unit(random), height = (z + 400) / 900;
        const double up = 1e-3 * um_per_degC * height * (wall.mean() - 20);
        const double over = 1e-3 * um_per_degC * height * height * wall.gradient();
        text += fmt::format("{:.3f},{:.3f},{:.6f},{:.6f},{:.2f},{:.2f},{},1.5,d{},{}\n", x, z,
                            x + over + noise(random), z + up + noise(random), wall.front(), wall.back(),
                            day * 86400 + i * 10, day, day < 4 ? "fit" : "check");
      }
    }
  }
  return text;
}

Diagnosis diagnosed(const std::string& rows) {
  static const DiagnoseOptions options;  // answers point into its effects
  const Machine machine = parse_machine(kColumn, "column.xml");
  return diagnose::diagnose(kColumn, machine, parse_measurement(rows, "days.csv", machine), options);
}

TEST(Responses, OfAColumnIsOneCauseAndHoldsOnFreshDays) {
  for (const std::uint64_t seed : {71U, 72U, 73U}) {
    SCOPED_TRACE(seed);
    const Diagnosis answer = diagnosed(days(seed, 9));
    EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << answer.explanation;
    ASSERT_GE(answer.ladder.size(), 2u);
    EXPECT_EQ(answer.ladder[1].effect, "thermal-response");
    EXPECT_TRUE(answer.ladder[1].confirmed.value_or(false));
    // The model error of days with another duty cycle, beside noise of 1.5 um.
    const double before = *answer.ladder.front().check_rms_um, after = *answer.ladder.back().check_rms_um;
    EXPECT_LT(std::sqrt(std::max(0.0, after * after - 1.5 * 1.5)), 0.2 * before) << before << " " << after;
  }
}

TEST(Responses, AddStringBuildsTheSameTerms) {
  const Diagnosis answer = diagnosed(days(74, 9));
  ASSERT_GE(answer.ladder.size(), 2u);
  ASSERT_EQ(answer.ladder[1].effect, "thermal-response");
  const Machine machine = parse_machine(kColumn, "column.xml");
  const auto choice = effects::parse_add_string(answer.ladder[1].add, machine, effects::built_in_effects());
  const effects::Candidate added = effects::make_candidate(machine, choice);
  const effects::Candidate& found = answer.candidates.front().candidate;
  ASSERT_EQ(added.terms.size(), found.terms.size());
  for (std::size_t i = 0; i < added.terms.size(); ++i) {
    EXPECT_EQ(added.terms[i].place, found.terms[i].place);
    EXPECT_EQ(added.terms[i].text, found.terms[i].text);
  }
}

TEST(Responses, NothingIsNamedInNoiseBesideATemperature) {
  for (const std::uint64_t seed : {81U, 82U, 83U})
    EXPECT_EQ(diagnosed(days(seed, 0)).verdict, Verdict::kConsistent);
}

/// BaseShift moves no reading of `d`: no parameter absorbs anything.
TEST(Responses, ReadingsThatNoParameterChangesAreSearched) {
  std::mt19937_64 random(91);
  std::normal_distribution<double> noise(0, 0.001);
  std::string rows = "X[mm],Z[mm],feed[mm/min],d[mm],nx,ny,nz,px[mm],py[mm],pz[mm],u[um]\n";
  for (int i = 0; i < 120; ++i) {
    const double x = 5.0 * i, feed = 500.0 * (1 + i % 3);
    rows += fmt::format("{0},{1},{2},{3:.6f},1,0,0,{0},0,{1},1\n", x, 4 * i, feed,
                        0.00002 * feed + noise(random));
  }
  const Diagnosis answer = diagnosed(rows);
  EXPECT_TRUE(std::isfinite(answer.remaining.chi_square_per_freedom));
  EXPECT_TRUE(std::isfinite(answer.noise.own));
  EXPECT_TRUE(answer.verdict == Verdict::kMissingEffect || answer.verdict == Verdict::kAmbiguous)
      << answer.explanation;
}

}  // namespace
}  // namespace vernier::responses_test
