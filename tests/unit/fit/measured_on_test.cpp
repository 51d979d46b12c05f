// SPDX-License-Identifier: GPL-3.0-or-later
// Rows that a board had corrected are rows of the machine without it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/machines.h"
#include "tools/fit/fit.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"

namespace vernier::measured_on_test {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr double kU_mm = 1e-3;

/// The bridge of the convention's tests: 400 poses, each read with the same noise whether the correction is
/// on or not.
struct Survey {
  Machine model = parse_machine(support::bridge_text(4), "bridge.xml"), truth = model;
  std::string off, mixed;  // the same poses, all without and every other one with a correction

  Survey() {
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> share(0, 1);
    for (Table& table : truth.tables)
      for (std::size_t c = 0; c < 6; ++c)
        for (Station& station : table.stations)
          if (table.free[c]) station.value[c] = (c < 3 ? 2e-2 : 1e-3) * normal(random);
    std::string rows = "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm],u[mm],run", on = rows;
    on += ",correctionX[um],correctionY[um],correctionZ[um]\n";
    rows += "\n";
    std::vector<std::string> poses;
    std::vector<std::array<double, 3>> added_um;
    for (int i = 0; i < 400; ++i) {
      std::string pose;
      for (const Axis& axis : model.axes)
        pose += std::to_string(*axis.min + (*axis.max - *axis.min) * share(random)) + ",";
      poses.push_back(pose);
      added_um.push_back({30 * normal(random), 30 * normal(random), 30 * normal(random)});
    }
    const auto line = [&](std::size_t i, const std::array<double, 3>& reading) {
      const auto& run = model.base_shifts[i % model.base_shifts.size()].run;
      std::string text = poses[i];
      for (const double value : reading) text += fmt_number(value) + ",";
      return text + fmt_number(kU_mm) + "," + run.value_or("");
    };
    for (const bool with : {false, true})
      for (std::size_t i = 0; i < poses.size(); ++i) {
        std::string& text = with ? on : rows;
        text += line(i, {0, 0, 0});
        if (with && i % 2 == 0)
          for (const double um : added_um[i]) text += "," + fmt_number(um);
        else if (with)
          text += ",,,";
        text += "\n";
      }
    noise_ = Eigen::VectorXd(static_cast<Eigen::Index>(3 * poses.size()));
    for (double& value : noise_) value = kU_mm * normal(random);
    off = rows;
    mixed = on;
  }

  Measurement read(const std::string& text) const {
    Measurement m = parse_measurement(text, "survey.csv", model);
    const Eigen::VectorXd exact = predict(truth, m);
    for (std::size_t i = 0; i < m.observations.size(); ++i)
      m.observations[i].value = exact[static_cast<Eigen::Index>(i)] + noise_[static_cast<Eigen::Index>(i)];
    return m;
  }

 private:
  static std::string fmt_number(double value) { return std::to_string(value); }
  Eigen::VectorXd noise_;
};

/// Largest difference of two fits over the first one's standard uncertainties.
double difference(const FitResult& a, const FitResult& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.estimates.size(); ++i)
    largest = std::max(largest, std::abs(a.estimates[i].value - b.estimates[i].value) / a.estimates[i].std);
  return largest;
}

TEST(MeasuredOn, MixedRowsGiveTheFitOfUncorrectedOnes) {
  const Survey survey;
  const FitResult off = fit::fit(survey.model, survey.read(survey.off));
  const Measurement mixed = survey.read(survey.mixed);
  ASSERT_TRUE(mixed.candidates.empty());
  const FitResult on = fit::fit(survey.model, mixed);
  // 30 um to the side, the slope of an error is 1e-4: the same readings to nanometres.
  EXPECT_LT(difference(off, on), 0.02);
  EXPECT_NEAR(*on.after.rms_um, *off.after.rms_um, 1e-3);
  // Without what was added the same readings are far from any such machine.
  Measurement ignored = mixed;
  for (std::size_t i = 0; i < 3; ++i) ignored.states.axis[i] = commanded(mixed, i);
  ignored.correction.clear();
  EXPECT_GT(*fit::fit(survey.model, ignored).after.rms_um, 10);
}

TEST(MeasuredOn, ReadingsOfOnePoseRepeatWhereTheCorrectionsAgree) {
  const Machine machine = parse_machine(support::bridge_text(4), "bridge.xml");
  // 2 um apart at each pose; 20 um between a correction that was on and off. Nanometres are no other pose.
  std::string text = "X[mm],Y[mm],Z[mm],x[mm],correctionX[um]\n";
  for (int i = 0; i < 8; ++i) {
    const std::string pose = std::to_string(10 * i + 0.1) + ",20,-30,";
    text += pose + "1,\n" + pose + "1.002,\n" + pose + "1.020,20.001\n" + pose + "1.022,20.004\n";
  }
  const Measurement m = parse_measurement(text, "repeats.csv", machine);
  ASSERT_TRUE(noise_um(m));
  EXPECT_NEAR(*noise_um(m), std::sqrt(2.0), 1e-9);
  // A residual is beside what the board added: one pose, whatever was on.
  EXPECT_EQ(row_conditions(m, 0), row_conditions(m, 3));
  EXPECT_NE(row_conditions(m, 0), row_conditions(m, 4));
}

// Each row has its own number: with it no reading would be a repeat.
TEST(MeasuredOn, TheNumberOfARowIsNoConditionOfItsReading) {
  const Machine machine = parse_machine(support::bridge_text(4), "bridge.xml");
  for (const std::string heading : {"Nr", "Lfd_Nr", "cycles"}) {
    std::string text = heading + ",X[mm],Y[mm],Z[mm],x[mm]\n";
    for (int i = 0; i < 16; ++i) text += fmt::format("{},{},20,-30,1.00{}\n", i + 1, 10 * (i % 8), i / 8 * 2);
    const Measurement m = parse_measurement(text, "repeats.csv", machine);
    ASSERT_EQ(noise_um(m).has_value(), heading != "cycles") << heading;
    EXPECT_NEAR(noise_um(m).value_or(std::sqrt(2.0)), std::sqrt(2.0), 1e-9) << heading;
  }
}

}  // namespace
}  // namespace vernier::measured_on_test
