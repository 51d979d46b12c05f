// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/signal_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "comp/vibration/feature_window.h"

namespace vernier::signal_features_test {

using namespace vernier::vibration;
namespace {

constexpr double kPi = 3.14159265358979323846;

double feature(const SignalFeatures& values, Feature which) {
  return values[static_cast<std::size_t>(which)];
}

TEST(SignalFeatures, OfASineAreTheTextbooks) {
  std::vector<double> x(1500);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = 2 * std::sin(2 * kPi * 15 * static_cast<double>(i) / 1500);
  Fourier fourier(1500);
  const SignalFeatures f = signal_features(x, 3000, fourier);
  EXPECT_NEAR(feature(f, Feature::kMav), 4 / kPi, 1e-3);
  EXPECT_NEAR(feature(f, Feature::kVar), 2 * 1500.0 / 1499, 1e-12);
  EXPECT_NEAR(feature(f, Feature::kRms), std::sqrt(2), 1e-12);
  EXPECT_NEAR(feature(f, Feature::kShape), kPi / std::sqrt(8), 1e-3);
  EXPECT_NEAR(feature(f, Feature::kCrest), std::sqrt(2), 1e-12);
  EXPECT_NEAR(feature(f, Feature::kKurtosis), 1.5, 1e-12);
  EXPECT_NEAR(feature(f, Feature::kSkewness), 0, 1e-12);
  EXPECT_NEAR(feature(f, Feature::kFrequency), 30, 1e-9);
  EXPECT_NEAR(feature(f, Feature::kBandpower), 2, 1e-12);
  EXPECT_EQ(feature(f, Feature::kPeak), 2);
}

TEST(SignalFeatures, TellPeakFromLargestMagnitude) {
  const std::vector<double> x = {1, -4, 2, -1};
  Fourier fourier(4);
  const SignalFeatures f = signal_features(x, 1, fourier);
  EXPECT_DOUBLE_EQ(feature(f, Feature::kImpact), 2);
  EXPECT_DOUBLE_EQ(feature(f, Feature::kPeakImpact), 1);
  // F = -2, -1 + 3j, 8: powers 4, 2 * 10, 64; their mean line is (20 + 128) / 88, a line being 1/4 Hz.
  EXPECT_NEAR(feature(f, Feature::kFrequency), 148.0 / 88 / 4, 1e-15);
}

TEST(SignalFeatures, AgreeWithTheBoardsWithinItsBound) {
  constexpr unsigned kSeed = 21;
  std::mt19937 random(kSeed);
  std::normal_distribution<double> noise(0, 3000);
  SpectralWeights weights;
  ASSERT_TRUE(prepare_weights(800, weights));
  FeatureWindow window;
  ASSERT_TRUE(window.start({InputMicro(10), InputMicro(1'651'000'000)}, weights));
  std::vector<double> x;
  for (int i = 0; i < 800; ++i) {
    const auto sample = static_cast<std::int32_t>(noise(random) + 2000 * std::sin(0.3 * i));
    window.push(sample);
    x.push_back(sample * 1e-5);
  }
  Fourier fourier(800);
  const SignalFeatures reference = signal_features(x, 1651, fourier);
  const FeatureValues fixed = window.features();
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double bound =
        0.52 + (i == static_cast<std::size_t>(Feature::kFrequency) ? 1651e6 * 800 * 0x1p-36 : 0);
    EXPECT_NEAR(static_cast<double>(fixed.value[i].count), reference[i] * 1e6, bound) << kFeatureNames[i];
  }
}

}  // namespace
}  // namespace vernier::signal_features_test
