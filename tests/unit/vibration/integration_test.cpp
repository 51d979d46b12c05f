// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/integration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/text/error.h"

namespace vernier::integration_test {

using namespace vernier::text;
using namespace vernier::vibration;
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRate_Hz = 1000;

/// Acceleration, mm/s^2, of a 20 Hz vibration of 10 um beside white noise of 5e-4 g, over 4 s.
struct Vibration {
  explicit Vibration(unsigned seed, double noise_mm_s2 = 4.9) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, noise_mm_s2);
    const double w = 2 * kPi * 20;
    for (int i = 0; i < 4000; ++i) {
      const double phase = w * i / kRate_Hz;
      truth_mm.push_back(0.010 * std::sin(phase));
      acceleration.push_back(-0.010 * w * w * std::sin(phase) + noise(random));
    }
  }
  std::vector<double> truth_mm, acceleration;
};

double rms_difference_um(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size())) * 1e3;
}

TEST(SpectralCut, FoundFromTheNoiseFloorKeepsTheVibrationAlone) {
  constexpr unsigned kSeed = 4;
  const Vibration v(kSeed);
  const double cutoff = noise_floor_cutoff(v.acceleration);
  SpectralCut cut;
  const std::vector<double> kept = kept_lines(v.acceleration, cutoff, &cut);
  EXPECT_EQ(cut.kept, 1u);
  const double filtered = rms_difference_um(integrate_twice(kept, kRate_Hz, Constants::kCentred), v.truth_mm);
  const double raw =
      rms_difference_um(integrate_twice(v.acceleration, kRate_Hz, Constants::kCentred), v.truth_mm);
  std::printf("seed %u: displacement of 10 um at 20 Hz: %.3f um off with the cut, %.3f without\n", kSeed,
              filtered, raw);
  EXPECT_LT(filtered,
            0.1);  // trapezoids at 20 Hz of 1 kHz lose 0.26 % of 7 um rms; the line's noise adds as much
  EXPECT_GT(raw, 10 * filtered);
}

TEST(SpectralCut, PassesNoiseAloneAboutOnceInTwentyRecords) {
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0, 3);
  int passed = 0;
  for (int record = 0; record < 400; ++record) {
    std::vector<double> x(2048);
    for (double& value : x) value = noise(random);
    SpectralCut cut;
    kept_lines(x, noise_floor_cutoff(x), &cut);
    passed += cut.kept > 0 ? 1 : 0;
  }
  EXPECT_GT(passed, 5);  // 20 expected
  EXPECT_LT(passed, 40);
}

TEST(IntegrateTwice, PublishedConstantsLeaveTheDriftThatCentredOnesDoNot) {
  Vibration v(1, 0);
  const auto published = integrate_twice(v.acceleration, kRate_Hz, Constants::kPublished);
  const auto centred = integrate_twice(v.acceleration, kRate_Hz, Constants::kCentred);
  // From rest the true speed of 1.26 mm/s at t = 0 is missing throughout: 5 mm after 4 s.
  EXPECT_NEAR(published.back(), -0.010 * 2 * kPi * 20 * 4, 0.02);
  EXPECT_LT(rms_difference_um(centred, v.truth_mm), 0.03);
}

TEST(FittedCut, FindsTheCutoffThatTheBallBarAgreesWith) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 20);
  std::vector<AcceleratedPass> passes(2);
  for (std::size_t p = 0; p < 2; ++p) {
    AcceleratedPass& pass = passes[p];
    pass.rate_Hz = kRate_Hz;
    const double sense = p == 0 ? -1 : 1, turn = 2 * kPi / 8;  // 8 s a turn
    for (int i = 0; i < 8000; ++i) {
      const double t = i / kRate_Hz, angle = sense * turn * t, radius_mm = 0.020, w = turn;
      pass.angle_rad.push_back(angle);
      pass.ax.push_back(-radius_mm * w * w * std::cos(angle) + 0.01 * noise(random));
      pass.ay.push_back(-radius_mm * w * w * std::sin(angle) + 0.01 * noise(random));
    }
    pass.mean_ballbar_um = 20;
  }
  const FittedCut fitted = fitted_cutoff(passes, Constants::kCentred);
  EXPECT_LT(fitted.objective_um, 4);  // 10 % of both, by the noise of the line that carries the circle
  double without = 0;
  for (const AcceleratedPass& pass : passes)
    without += std::fabs(20 - mean_radial_um(pass, 1e9, Constants::kCentred));
  EXPECT_NEAR(without, 40, 1e-9);  // everything cut: no displacement at all
  EXPECT_THROW(fitted_cutoff({}, Constants::kCentred), InputError);
}

}  // namespace
}  // namespace vernier::integration_test
