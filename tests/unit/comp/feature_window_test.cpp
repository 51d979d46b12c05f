// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/vibration/feature_window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace vernier::feature_window_test {
namespace {

using Real = long double;
constexpr Real kPi = 3.14159265358979323846264338327950288L;

/// The definitions, over samples in LSB, in the units of FeatureValues. The spectrum by its sum over samples.
std::array<Real, kFeatures> defined(const std::vector<std::int32_t>& x, Real lsb, Real rate,
                                    bool with_spectrum) {
  const auto n = static_cast<Real>(x.size());
  Real sum = 0, absolute = 0, square = 0, c2 = 0, c3 = 0, c4 = 0;
  for (const Real v : x) sum += v, absolute += std::fabs(v), square += v * v;
  for (const Real v : x) {
    const Real d = v - sum / n;
    c2 += d * d, c3 += d * d * d, c4 += d * d * d * d;
  }
  const Real high = *std::max_element(x.begin(), x.end()), low = *std::min_element(x.begin(), x.end());
  const Real largest = std::max(std::fabs(high), std::fabs(low));
  const Real mav = absolute / n, rms = std::sqrt(square / n);
  Real moment = 0, power = 0;
  for (std::size_t k = 0; with_spectrum && k <= x.size() / 2; ++k) {
    Real re = 0, im = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Real angle = 2 * kPi * static_cast<Real>(k * i % x.size()) / n;
      re += static_cast<Real>(x[i]) * std::cos(angle), im += static_cast<Real>(x[i]) * std::sin(angle);
    }
    const Real p = (re * re + im * im) * (k == 0 || 2 * k == x.size() ? 1 : 2);
    power += p, moment += p * static_cast<Real>(k) * rate / n;
  }
  const Real million = 1e6L, unit2 = lsb * lsb / million;
  return {mav * lsb,
          c2 / (n - 1) * unit2,
          rms * lsb,
          rms / mav * million,
          largest / mav * million,
          largest / rms * million,
          c4 / n / (c2 / n * c2 / n) * million,
          c3 / n / std::pow(c2 / n, 1.5L) * million,
          with_spectrum ? moment / power : 0,
          square / n * unit2,
          high * lsb,
          high / mav * million,
          high / rms * million};
}

/// Largest error of a feature over its proved bound.
Real worst_ratio(const FeatureValues& fixed, const std::array<Real, kFeatures>& exact, Real rate, Real n,
                 bool with_spectrum) {
  Real worst = 0;
  for (unsigned i = 0; i < kFeatures; ++i) {
    const bool frequency = i == static_cast<unsigned>(Feature::kFrequency);
    if ((frequency && !with_spectrum) || (fixed.undefined >> i & 1) != 0) continue;
    const Real bound =
        0.501L + std::ldexp(std::fabs(exact[i]), -54) + (frequency ? rate * n * std::ldexp(1.0L, -36) : 0);
    const Real ratio = std::fabs(static_cast<Real>(fixed.value[i].count) - exact[i]) / bound;
    EXPECT_LE(ratio, 1) << "feature " << i << " fixed " << fixed.value[i].count << " exact " << exact[i];
    worst = std::max(worst, ratio);
  }
  return worst;
}

/// Signals that move a window's features through their ranges: noise of any size, offsets, tones, knocks,
/// full scale, silence.
class Signal {
 public:
  explicit Signal(unsigned seed) : random_(seed) {}
  std::int32_t next() {
    if (left_ == 0) change();
    --left_;
    phase_ += step_;
    const double knock = random_() % 400 == 0 ? knock_ : 0;
    const double value = offset_ + size_ * uniform() + tone_ * std::sin(phase_) + knock;
    return static_cast<std::int32_t>(std::clamp(value, -524287.0, 524287.0));
  }

 private:
  double uniform() { return static_cast<double>(random_()) / 2147483648.0 - 1; }
  void change() {
    left_ = 50 + static_cast<unsigned>(random_() % 3000);
    const auto some = [this] { return random_() % 2 != 0 ? std::exp2(uniform() * 9.5 + 9.5) : 0.0; };
    size_ = some(), tone_ = some(), knock_ = some(), offset_ = some() * uniform(),
    step_ = 1.6 + 1.6 * uniform();
    if (random_() % 8 == 0) size_ = tone_ = knock_ = 0;
    if (random_() % 8 == 0) tone_ = 9e5;
  }
  std::mt19937 random_;
  unsigned left_ = 0;
  double size_ = 0, tone_ = 0, knock_ = 0, offset_ = 0, phase_ = 0, step_ = 0;
};

TEST(SpectralWeights, AreTheRoundedTransformOfATriangle) {
  for (const std::uint32_t n : {6u, 8u, 62u, 800u, 1500u, 2046u, 2048u}) {
    SpectralWeights weights;
    ASSERT_TRUE(prepare_weights(n, weights));
    Real total = 0;
    for (std::uint32_t m = 1; m <= n / 2; m += 2) {
      const Real side = n * std::sin(kPi * m / n);
      const std::int32_t got = m == n / 2 ? weights.middle : weights.weight[m / 2];
      EXPECT_NEAR(got, static_cast<double>(std::ldexp(1 / (side * side), 34)), 0.5 + 1e-6) << n << " " << m;
      total += (m == n / 2 ? 1.0L : 2.0L) * got;
    }
    EXPECT_NEAR(static_cast<double>(total), 4294967296.0, n / 4.0);  // a constant signal has no frequency
  }
}

TEST(SpectralWeights, RefuseWindowsTheyAreNotMadeFor) {
  SpectralWeights weights;
  for (const std::uint32_t n : {0u, 2u, 4u, 7u, 1501u, 2050u}) EXPECT_FALSE(prepare_weights(n, weights)) << n;
}

TEST(Scaled, ReciprocalAndRootKeepTheirBounds) {
  constexpr unsigned kSeed = 7;
  std::mt19937_64 random(kSeed);
  Real worst = 0;
  for (int i = 0; i < 300000; ++i) {
    const std::uint64_t value = random() >> (random() % 64) | (i % 3 == 0 ? std::uint64_t{1} << 63 : 1);
    const Real x = static_cast<Real>(value);
    const Scaled inverse = reciprocal(scaled(value)), root = inverse_root(scaled(value));
    EXPECT_EQ(inverse.mantissa >> 63, 1u);
    worst =
        std::max(worst, std::fabs(std::ldexp(static_cast<Real>(inverse.mantissa), inverse.exponent) * x - 1));
    const Real r = std::ldexp(static_cast<Real>(root.mantissa), root.exponent);
    worst = std::max(worst, std::fabs(r * std::sqrt(x) - 1));
  }
  std::printf("seed %u: relative error up to 2^%.1f\n", kSeed, static_cast<double>(std::log2(worst)));
  EXPECT_LE(worst, std::ldexp(1.0L, -59));
}

TEST(Wide, MultipliesLikeTheSchool) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  EXPECT_EQ(long_product(kAll, kAll), (Wide{kAll - 1, 1}));
  EXPECT_EQ(long_product(kAll, 2), (Wide{1, kAll - 1}));
  EXPECT_EQ(wide(-3) * wide(5), wide(-15));
  EXPECT_EQ(wide(INT64_MIN) * wide(INT64_MIN), (Wide{std::uint64_t{1} << 62, 0}));
  EXPECT_EQ(wide(-1) + wide(1), Wide{});
  EXPECT_EQ(wide(0) - wide(1), wide(-1));
}

TEST(FeatureWindow, AgreesWithTheDefinitions) {
  constexpr unsigned kSeed = 11;
  Real worst = 0;
  for (const std::uint32_t n : {6u, 8u, 62u, 800u, 1500u, 2048u}) {
    SpectralWeights weights;
    ASSERT_TRUE(prepare_weights(n, weights));
    FeatureWindow window;
    const FeatureScale scale{InputMicro(10), InputMicro(1'651'000'000)};
    ASSERT_TRUE(window.start(scale, weights));
    Signal signal(kSeed + n);
    std::vector<std::int32_t> last(n, 0);
    std::vector<std::int32_t> ordered(n);
    for (std::uint32_t i = 0; i < 40 * n + 3000; ++i) {
      const std::int32_t sample = signal.next();
      last[i % n] = sample;
      window.push(sample);
      if (i + 1 < n || i % 37 != 0) continue;
      // A periodic spectrum does not mind where the window begins: the power of each line is the same.
      const bool with_spectrum = i % (37 * n / 4 + 37) == 0;
      worst = std::max(worst, worst_ratio(window.features(), defined(last, 10, 1651e6L, with_spectrum),
                                          1651e6L, n, with_spectrum));
    }
  }
  std::printf("seed %u: error up to %.3f of the proved bound\n", kSeed, static_cast<double>(worst));
  EXPECT_GT(worst, 0.9L);  // rounding alone reaches half a count
}

TEST(FeatureWindow, HoldsFullScaleOfEitherSign) {
  SpectralWeights weights;
  ASSERT_TRUE(prepare_weights(2048, weights));
  for (const int pattern : {0, 1, 2, 3}) {
    FeatureWindow window;
    ASSERT_TRUE(window.start({InputMicro(1 << 20), InputMicro(10'240'000'000)}, weights));
    std::vector<std::int32_t> x;
    for (int i = 0; i < 2048; ++i) {
      const bool down = pattern == 0 ? false : pattern == 1 ? true : pattern == 2 ? i % 2 == 0 : i == 5;
      x.push_back(down ? -FeatureWindow::kLimit : FeatureWindow::kLimit);
      window.push(x.back());
    }
    worst_ratio(window.features(), defined(x, 1 << 20, 10240e6L, true), 10240e6L, 2048, true);
    EXPECT_EQ(window.features().undefined != 0, pattern < 2);  // a constant has neither kurtosis nor skewness
  }
}

TEST(FeatureWindow, ForgetsWhatLeftIt) {
  SpectralWeights weights;
  ASSERT_TRUE(prepare_weights(800, weights));
  FeatureWindow used, fresh;
  ASSERT_TRUE(used.start({}, weights));
  ASSERT_TRUE(fresh.start({}, weights));
  Signal signal(3);
  for (int i = 0; i < 500000 / 800 * 800; ++i) used.push(signal.next());
  for (int i = 0; i < 800; ++i) {
    EXPECT_FALSE(fresh.filled());
    const std::int32_t sample = signal.next();
    used.push(sample);
    fresh.push(sample);
  }
  EXPECT_TRUE(fresh.filled());
  for (unsigned i = 0; i < kFeatures; ++i)
    EXPECT_EQ(used.features().value[i], fresh.features().value[i]) << i;
}

TEST(FeatureWindow, SaysWhatIsUndefinedAndWhatWasHeld) {
  SpectralWeights weights;
  ASSERT_TRUE(prepare_weights(6, weights));
  FeatureWindow window;
  EXPECT_FALSE(window.start({InputMicro(0), InputMicro(1)}, weights));
  EXPECT_FALSE(window.start({InputMicro(1), InputMicro(0)}, weights));
  EXPECT_FALSE(window.start({InputMicro((std::int64_t{1} << 30) + 1), InputMicro(1)}, weights));
  EXPECT_FALSE(window.start({InputMicro(1), InputMicro((std::int64_t{1} << 42) + 1)}, weights));
  EXPECT_TRUE(window.start({InputMicro(std::int64_t{1} << 30), InputMicro(std::int64_t{1} << 42)}, weights));
  EXPECT_TRUE(window.start({InputMicro(1), InputMicro(1)}, weights));
  EXPECT_FALSE(window.start({}, SpectralWeights{}));
  ASSERT_TRUE(window.start({}, weights));
  for (int i = 0; i < 6; ++i) window.push(0);
  EXPECT_EQ(window.features().undefined, 0b1100111111000u);
  window.push(INT32_MAX);
  window.push(INT32_MIN);
  EXPECT_EQ(window.held(), 2u);
  EXPECT_EQ(window.features().undefined, 0u);
  EXPECT_EQ(window.features().value[static_cast<unsigned>(Feature::kPeak)].count, 10 * FeatureWindow::kLimit);
}

}  // namespace
}  // namespace vernier::feature_window_test
