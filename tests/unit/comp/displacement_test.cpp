// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/vibration/displacement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

namespace vernier::displacement_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// The same filter in double, samples in LSB, result in nm.
struct InDouble {
  explicit InDouble(const DisplacementScale& s)
      : e(2 * kPi * static_cast<double>(s.corner_mHz) / static_cast<double>(s.rate_mHz)),
        nm(static_cast<double>(s.lsb_nm_s2) * 1e6 / std::pow(static_cast<double>(s.rate_mHz), 2)) {
    const double t = 2 * kPi * static_cast<double>(s.exact_mHz) / static_cast<double>(s.rate_mHz);
    nm *= std::pow(1 - e / std::sqrt(2), 2);
    k = t == 0 ? 1 / 12.0 : 1 / (4 * std::pow(std::sin(t / 2), 2)) - 1 / (t * t);
  }
  double step(double sample) {
    const double u = k * (sample + before) + (1 - 2 * k) * last;
    before = last, last = sample;
    v1 += u - std::sqrt(2) * e * v1 - e * p1, p1 += e * v1;
    v2 += v1 - std::sqrt(2) * e * v2 - e * p2, p2 += e * v2;
    return v2 * nm;
  }
  double e, nm, k, before = 0, last = 0, v1 = 0, p1 = 0, v2 = 0, p2 = 0;
};

double rounding_bound_nm(const InDouble& f) {
  return (2.4 * std::ldexp(1.0, -27) / (f.e * f.e) + 3 * std::ldexp(1.0, -14) / f.e) * f.nm + 0.51;
}

/// Amplitude ratio and phase of the filter's displacement to the true one, of a tone with rounded samples.
std::complex<double> response(const DisplacementScale& scale, double frequency_Hz, double noise_lsb,
                              unsigned seed) {
  Displacement filter;
  EXPECT_TRUE(filter.start(scale));
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_lsb);
  const double rate = static_cast<double>(scale.rate_mHz) * 1e-3,
               corner = static_cast<double>(scale.corner_mHz) * 1e-3;
  const double omega = 2 * kPi * frequency_Hz, amplitude_lsb = 200000;
  const double true_nm = -amplitude_lsb * static_cast<double>(scale.lsb_nm_s2) / (omega * omega);
  const auto settle = static_cast<long>(rate * 4 / corner);
  const auto measured = std::lround(rate * std::ceil(std::max(20.0, frequency_Hz)) / frequency_Hz);
  std::complex<double> sum = 0;
  for (long i = 0; i < settle + measured; ++i) {
    const double phase = omega * static_cast<double>(i) / rate;
    const double nm =
        filter.step(static_cast<std::int32_t>(std::lround(amplitude_lsb * std::sin(phase) + noise(random))))
            .count;
    if (i >= settle) sum += nm * std::polar(1.0, -phase);
  }
  return sum * std::complex<double>(0, 2) / static_cast<double>(measured) / true_nm;
}

TEST(Displacement, RefusesSettingsItCannotKeepItsBoundsWith) {
  Displacement filter;
  EXPECT_TRUE(filter.start({}));
  EXPECT_TRUE(filter.start({98067, 10'240'000, 100, 200'000}));
  EXPECT_TRUE(filter.start({std::int64_t{1} << 31, std::int64_t{1} << 30, 10'000, 0}));
  EXPECT_TRUE(filter.start({1, 1'000'000, 15'625, 0}));
  for (const DisplacementScale& bad :
       {DisplacementScale{(std::int64_t{1} << 31) + 1, 1'000'000, 500, 0},
        DisplacementScale{1, (std::int64_t{1} << 30) + 1, 10'000, 0}, DisplacementScale{1, 1'000'000, 0, 0},
        DisplacementScale{0, 1'000'000, 500, 0}, DisplacementScale{1, 0, 500, 0},
        DisplacementScale{1, 1'000'000, 7, 0}, DisplacementScale{1, 1'000'000, 15'626, 0},
        DisplacementScale{1, 1'000'000, 500, 250'001}, DisplacementScale{1, 1'000'000, 500, -1},
        DisplacementScale{INT32_MAX, 1'000, 10, 0}})
    EXPECT_FALSE(filter.start(bad));
  EXPECT_TRUE(filter.start({1, 1'000'000, 500, 250'000})) << "exact at a quarter of the rate";
  EXPECT_TRUE(filter.start({1, 131'072, 1, 0})) << "the lowest corner at a rate";
  EXPECT_FALSE(filter.start({1, 131'073, 1, 0}));
}

// 2^14 nm of one LSB in one sample: the factor of the guard unit is a fraction below one.
TEST(Displacement, RefusesAnLsbThatMovesMoreThanSixteenMicrometresInASample) {
  const double rate_Hz = 100, gain = std::pow(1 - 2 * kPi * 0.01 / std::sqrt(2), 2);
  const double limit = 16384 * rate_Hz * rate_Hz / gain;
  const auto starts = [](double lsb_nm_s2) {
    return Displacement{}.start({std::llround(lsb_nm_s2), 100'000, 1'000, 0});
  };
  EXPECT_TRUE(starts(limit * (1 - 1e-6)));
  EXPECT_FALSE(starts(limit * (1 + 1e-6)));
}

TEST(Displacement, CountsSamplesBeyondItsLimit) {
  Displacement filter;
  ASSERT_TRUE(filter.start({}));
  filter.step(Displacement::kLimit);
  filter.step(-Displacement::kLimit);
  EXPECT_EQ(filter.held(), 0u);
  filter.step(Displacement::kLimit + 1);
  filter.step(-Displacement::kLimit - 1);
  EXPECT_EQ(filter.held(), 2u);
}

TEST(Displacement, GainsStayBelowTheirBounds) {
  for (const double e : {0.125, 0.098, 0.03, 1e-3, 5e-5}) {
    double v1 = 0, p1 = 0, v2 = 0, p2 = 0, speed = 0, travel = 0, sum = 0, step = 0;
    for (long i = 0; i < static_cast<long>(40 / e); ++i) {
      v1 += (i == 0 ? 1 : 0) - std::sqrt(2) * e * v1 - e * p1, p1 += e * v1;
      v2 += v1 - std::sqrt(2) * e * v2 - e * p2, p2 += e * v2;
      speed += std::fabs(v1) * e, travel += std::fabs(v2) * e * e, sum += v2 * e * e;
      step = std::max(step, std::fabs(sum));
    }
    EXPECT_LT(speed, 0.97) << e;
    EXPECT_LT(travel, 0.71) << e;
    EXPECT_LT(step, 0.21) << e;
    EXPECT_GT(travel, 0.69) << e;
    EXPECT_NEAR(sum, 0, 1e-9) << e;
  }
}

TEST(Displacement, RoundingStaysBelowItsBound) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  for (const DisplacementScale& scale :
       {DisplacementScale{}, DisplacementScale{98067, 1'000'000, 10, 0},
        DisplacementScale{98067, 10'240'000, 80, 200'000}, DisplacementScale{1000, 100'000, 1500, 25'000}}) {
    Displacement filter;
    ASSERT_TRUE(filter.start(scale));
    InDouble reference(scale);
    double worst = 0, largest = 0;
    std::int32_t hold = 0;
    for (int i = 0; i < 1000000; ++i) {
      if (random() % 500 == 0) hold = static_cast<std::int32_t>(random() % 60001) - 30000;
      const std::int32_t sample = hold / 100 + static_cast<std::int32_t>(random() % 401) - 200;
      const double expected = reference.step(sample);
      worst = std::max(worst, std::fabs(filter.step(sample).count - expected));
      largest = std::max(largest, std::fabs(expected));
    }
    EXPECT_EQ(filter.held(), 0u);
    // Coefficients have 31 significant bits.
    const double coefficients = std::ldexp(largest, -28);
    EXPECT_LT(worst, rounding_bound_nm(reference) + coefficients);
    std::printf(
        "seed %u, %lld mHz corner at %lld mHz: %.3f nm from double; bound %.3f of rounding, %.3f of the "
        "coefficients\n",
        kSeed, static_cast<long long>(scale.corner_mHz), static_cast<long long>(scale.rate_mHz), worst,
        rounding_bound_nm(reference), coefficients);
  }
}

// The first sample meets nothing but the factor k of the symmetric filter.
TEST(Displacement, TheFactorOfTheSymmetricFilterIsThatOfItsExactFrequency) {
  for (const std::int64_t exact_mHz : {0, 5'000, 12'500, 20'000, 25'000}) {
    const DisplacementScale scale{100'000'000, 100'000, 1500, exact_mHz};  // 10 um a sample
    Displacement filter;
    ASSERT_TRUE(filter.start(scale)) << exact_mHz;
    InDouble reference(scale);
    const double full = Displacement::kLimit * reference.nm;
    EXPECT_NEAR(filter.step(Displacement::kLimit).count, reference.step(Displacement::kLimit),
                std::ldexp(full, -20))
        << exact_mHz;
  }
}

// Samples of full scale, each with the sign that its response has at the end: no other samples give a larger
// displacement. The corner is the lowest that start() accepts.
TEST(Displacement, LargestDisplacementOfTheLowestCornerFitsItsWidths) {
  const DisplacementScale scale{100'000, 131'072'000, 1'000, 0};
  Displacement filter;
  ASSERT_TRUE(filter.start(scale));
  InDouble impulse(scale), reference(scale);
  std::vector<bool> up;
  for (int i = 0; i < 300'000; ++i) up.push_back(impulse.step(i == 0 ? 1 : 0) >= 0);
  double worst = 0, largest = 0;
  for (auto sign = up.rbegin(); sign != up.rend(); ++sign) {
    const std::int32_t sample = *sign ? Displacement::kLimit : -Displacement::kLimit;
    const double expected = reference.step(sample);
    worst = std::max(worst, std::fabs(filter.step(sample).count - expected));
    largest = std::max(largest, std::fabs(expected));
  }
  const double w = 2 * kPi,
               bound = 0.71 * Displacement::kLimit * static_cast<double>(scale.lsb_nm_s2) / (w * w);
  EXPECT_LT(largest, bound);
  EXPECT_GT(largest, 0.97 * bound);
  EXPECT_EQ(filter.held(), 0u);
  EXPECT_LT(worst, rounding_bound_nm(reference) + std::ldexp(largest, -28)) << "31 bits of the coefficients";
}

TEST(Displacement, IsRightFromTheBandsFootToTwoHundredHertz) {
  struct Setup {
    const char* name;
    DisplacementScale scale;
    double gain_error;  // at and above 5 Hz
  };
  // The sensor's noise, 5e-5 g rms, is 5 LSB of 10 ug.
  for (const Setup& setup : {Setup{"1 kHz", {98067, 1'000'000, 50, 180'000}, 0.003},
                             Setup{"10240 Hz", {98067, 10'240'000, 80, 180'000}, 0.0005}}) {
    std::printf("%s, corner %.2f Hz\n", setup.name, static_cast<double>(setup.scale.corner_mHz) * 1e-3);
    for (const double f : {0.5, 1.0, 2.0, 5.0, 20.0, 50.0, 100.0, 150.0, 200.0}) {
      const std::complex<double> got = response(setup.scale, f, 5, 1);
      const double phase_deg = std::arg(got) * 180 / kPi;
      const double r = static_cast<double>(setup.scale.corner_mHz) * 1e-3 / f;
      const double lead_deg = 2 * std::atan2(std::sqrt(2) * r, 1 - r * r) * 180 / kPi;
      std::printf("  %6.1f Hz  amplitude %+8.4f %%  phase %+8.4f deg (band edge alone %+.4f)\n", f,
                  100 * (std::abs(got) - 1), phase_deg, lead_deg);
      EXPECT_NEAR(std::abs(got), 1 / (1 + std::pow(r, 4)), setup.gain_error) << f;
      EXPECT_NEAR(phase_deg, lead_deg, 0.05) << f;
    }
  }
}

TEST(Displacement, TenMinutesOfTheSensorsNoiseStayWithinWhatTheBandLetsThrough) {
  constexpr unsigned kSeed = 17;
  std::mt19937 random(kSeed);
  std::normal_distribution<double> noise(0, 5);  // 5e-5 g rms in LSB of 10 ug
  for (const std::int64_t rate_mHz : {1'000'000, 10'240'000})
    for (const std::int64_t corner_mHz : {100, 500, 2000}) {
      const DisplacementScale scale{98067, rate_mHz, corner_mHz, 180'000};
      Displacement filter;
      ASSERT_TRUE(filter.start(scale));
      const double rate = static_cast<double>(rate_mHz) * 1e-3,
                   w = 2 * kPi * static_cast<double>(corner_mHz) * 1e-3;
      const double swing = 2 * kPi / 300;
      double square = 0, most = 0;
      const auto ticks = std::lround(600 * rate), settle = std::lround(30 * rate);
      for (long i = -settle; i < ticks; ++i) {
        // A bias of 10 mg that a change of temperature carries up and down by 1 mg in five minutes.
        const double bias = 1000 + 100 * std::sin(swing * static_cast<double>(i) / rate);
        const double x = filter.step(static_cast<std::int32_t>(std::lround(bias + noise(random)))).count;
        if (i < 0) continue;
        square += x * x, most = std::max(most, std::fabs(x));
      }
      const double rms = std::sqrt(square / static_cast<double>(ticks));
      // White noise of density S through (s/(s^2 + sqrt2 w s + w^2))^2: S / (16 sqrt2 w^3); rounding samples
      // adds 1/12.
      const double density = (25 + 1 / 12.0) * 2 / rate;
      const double noise_nm =
          static_cast<double>(scale.lsb_nm_s2) * std::sqrt(density / (16 * std::sqrt(2) * w * w * w));
      const double swings =
          100 * static_cast<double>(scale.lsb_nm_s2) * swing * swing / (std::pow(swing, 4) + std::pow(w, 4));
      const double expected = std::hypot(noise_nm, swings / std::sqrt(2));
      const double bound = 0.71 * 1130 * static_cast<double>(scale.lsb_nm_s2) / (w * w);
      std::printf(
          "seed %u, %6.0f Hz, corner %.1f Hz: rms %8.1f nm (noise %.1f and bias give %.1f), most %8.1f, "
          "bound of any "
          "11.3 mg %.0f\n",
          kSeed, rate, static_cast<double>(corner_mHz) * 1e-3, rms, noise_nm, expected, most, bound);
      EXPECT_NEAR(rms, expected,
                  (corner_mHz < 500 ? 0.4 : 0.2) * expected);  // a few hundred independent swings
      EXPECT_LT(most, bound);
    }
}

TEST(Displacement, ConstantBiasDecaysToNothing) {
  const DisplacementScale scale;
  Displacement filter;
  ASSERT_TRUE(filter.start(scale));
  const double bias = 1000, w = 2 * kPi * 0.5;  // 10 mg
  const double scale_nm = bias * static_cast<double>(scale.lsb_nm_s2) / (w * w);
  double peak = 0;
  LengthNm x;
  for (int i = 0; i < 20000; ++i) {
    x = filter.step(1000);
    peak = std::max(peak, std::fabs(static_cast<double>(x.count)));
  }
  EXPECT_LT(peak, 0.21 * scale_nm);
  EXPECT_GT(peak, 0.19 * scale_nm);
  EXPECT_EQ(x.count, 0);
}

}  // namespace
}  // namespace vernier::displacement_test
