// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/text/error.h"

namespace vernier::alignment_test {

using namespace vernier::text;
using namespace vernier::vibration;
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A motion that never repeats itself: tones that have no common period, swelling and fading.
double motion(double t) {
  return std::sin(2 * kPi * 0.71 * t + 2 * std::sin(0.37 * t)) +
         0.6 * std::sin(2 * kPi * 2.3 * t) * std::sin(0.23 * t);
}

Series sampled(double from, double to, double rate_Hz, double noise, std::mt19937& random) {
  std::normal_distribution<double> draw(0, noise);
  Series series;
  for (double t = from; t < to; t += 1 / rate_Hz) {
    series.t_s.push_back(t);
    series.value.push_back(motion(t) + draw(random));
  }
  return series;
}

TEST(AlignClocks, FindsOffsetAndRateFarBelowASample) {
  constexpr unsigned kSeed = 12;
  std::mt19937 random(kSeed);
  for (const double rate : {1.0, 1.0003, 0.999}) {
    const double offset = 3.4567;
    const Series reference = sampled(0, 60, 100, 0.02, random);
    Series other = sampled(5, 50, 250, 0.02, random);
    for (double& t : other.t_s) t = (t - offset) / rate;
    for (double& value : other.value) value = 4 * value + 1;  // another unit and datum
    const ClockFit fit = align_clocks(reference, other);
    const double middle = 27.5, error_s = fit.offset_s + fit.rate * (middle - offset) / rate - middle;
    std::printf("seed %u, rate %.4f: %.1f us off at the middle (std %.1f), rate %.2e off (std %.1e)\n", kSeed,
                rate, error_s * 1e6, fit.offset_std_s * 1e6, fit.rate - rate, fit.rate_std);
    EXPECT_LT(std::fabs(error_s), 5 * fit.offset_std_s);
    EXPECT_LT(std::fabs(error_s), 3e-4);  // 3 % of a sample
    EXPECT_LT(std::fabs(fit.rate - rate), 5 * fit.rate_std);
    EXPECT_GT(fit.correlation, 0.99);
    EXPECT_LT(fit.second_best, 0.9);
  }
}

TEST(AlignClocks, SaysWhereAnotherLagIsAsGood) {
  Series reference, other;
  for (int i = 0; i < 3000; ++i) {
    reference.t_s.push_back(i * 0.01), reference.value.push_back(std::sin(2 * kPi * i * 0.01));
    if (i >= 500 && i < 2500)
      other.t_s.push_back(i * 0.01), other.value.push_back(std::sin(2 * kPi * i * 0.01));
  }
  EXPECT_GT(align_clocks(reference, other).second_best, 0.98);
}

TEST(AlignClocks, RefusesRecordsOfDifferentMotions) {
  std::mt19937 random(2);
  std::normal_distribution<double> draw;
  Series a, b;
  for (int i = 0; i < 2000; ++i) {
    a.t_s.push_back(i), a.value.push_back(draw(random));
    b.t_s.push_back(i), b.value.push_back(draw(random));
  }
  EXPECT_THROW(align_clocks(a, b), InputError);
  b.t_s[5] = b.t_s[4];
  EXPECT_THROW(align_clocks(a, b), InputError);
}

TEST(NearestPlaces, TellTheSecondPassFromTheFirst) {
  Eigen::MatrixXd path(2, 2000), points(2, 400);
  for (int i = 0; i < 2000; ++i)
    path.col(i) << 50 * std::cos(i * 4 * kPi / 2000), 50 * std::sin(i * 4 * kPi / 2000);
  for (int i = 0; i < 400; ++i) {
    const double angle = (i + 0.3) * 4 * kPi / 400;
    points.col(i) << 50.02 * std::cos(angle), 50.02 * std::sin(angle);
  }
  const auto places = nearest_places(path, points, 10);
  for (std::size_t i = 0; i < 399; ++i) {
    EXPECT_NEAR(static_cast<double>(places[i].sample) + places[i].fraction,
                (static_cast<double>(i) + 0.3) * 5, 0.05)
        << i;
    EXPECT_NEAR(places[i].distance, 0.02, 1e-3) << i;
  }
}

}  // namespace
}  // namespace vernier::alignment_test
