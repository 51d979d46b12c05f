// SPDX-License-Identifier: GPL-3.0-or-later
// feature_check [WINDOWS] [SEED]: the features of so many windows (10^6) of 1500 and 800 samples at 1651 Hz,
// a new one each sample, in fixed point against double from the samples themselves; largest error of each
// feature in units of its proved bound. Status 1 where one is beyond.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "comp/vibration/feature_window.h"
#include "tools/vibration/signal_features.h"

namespace {

using vernier::FeatureWindow;
constexpr std::size_t kCount = vernier::vibration::kFeatureNames.size();

/// Noise, tone, offset and knocks of sizes that change every few thousand samples, LSB of 10 ug.
class Cutting {
 public:
  explicit Cutting(unsigned seed) : random_(seed) {}
  double next() {
    if (left_-- == 0) change();
    phase_ += step_;
    const double knock = random_() % 300 == 0 ? knock_ * normal_(random_) : 0;
    return std::clamp(std::round(offset_ + noise_ * normal_(random_) + tone_ * std::sin(phase_) + knock),
                      -524287.0, 524287.0);
  }

 private:
  double size() {
    return std::exp2(std::uniform_real_distribution<double>(2.3, 16)(random_));
  }  // from 5e-5 g
  void change() {
    left_ = 500 + static_cast<long>(random_() % 5000);
    noise_ = size(), tone_ = random_() % 2 != 0 ? size() : 0, knock_ = random_() % 2 != 0 ? size() : 0;
    offset_ = random_() % 2 != 0 ? size() * normal_(random_) : 0;
    step_ = std::uniform_real_distribution<double>(0.001, 3.1)(random_);
  }
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  long left_ = 0;
  double noise_ = 0, tone_ = 0, knock_ = 0, offset_ = 0, phase_ = 0, step_ = 0;
};

struct Worst {
  double error[kCount] = {}, ratio[kCount] = {};
};

void compare(const vernier::FeatureValues& fixed, const vernier::vibration::SignalFeatures& exact,
             double rate_n, Worst& worst) {
  for (std::size_t i = 0; i < kCount; ++i) {
    if (!std::isfinite(exact[i])) continue;
    const double micro = exact[i] * 1e6, error = std::fabs(static_cast<double>(fixed.value[i].count) - micro);
    // The double reference itself: some 1500 additions, relative error below 1e-12 of the largest sum.
    double bound = 0.501 + std::fabs(micro) * 1e-12;
    if (i == static_cast<std::size_t>(vernier::Feature::kFrequency)) bound += rate_n * 0x1p-36 * 1e6;
    worst.error[i] = std::max(worst.error[i], error);
    worst.ratio[i] = std::max(worst.ratio[i], error / bound);
  }
}

bool check(std::uint32_t n, long windows, unsigned seed) {
  constexpr double kRate = 1651;
  static vernier::SpectralWeights weights;
  static FeatureWindow window;
  if (!prepare_weights(n, weights)) return false;
  if (!window.start({vernier::InputMicro(10), vernier::InputMicro(1'651'000'000)}, weights)) return false;
  vernier::vibration::Fourier fourier(n);
  Cutting cutting(seed);
  std::vector<double> x;
  Worst worst;
  for (long i = 0; i < windows + static_cast<long>(n) - 1; ++i) {
    const double sample = cutting.next();
    window.push(static_cast<std::int32_t>(sample));
    x.push_back(sample * 1e-5);
    if (x.size() > 16 * n) x.erase(x.begin(), x.end() - static_cast<std::ptrdiff_t>(n));
    if (!window.filled() || x.size() < n) continue;
    compare(window.features(), signal_features(std::span(x).last(n), kRate, fourier), kRate * n, worst);
  }
  bool good = true;
  for (std::size_t i = 0; i < kCount; ++i) {
    std::printf("%5u  %-10s  error up to %9.3f e-6, %.3f of the bound\n", n,
                vernier::vibration::kFeatureNames[i], worst.error[i], worst.ratio[i]);
    good = good && worst.ratio[i] <= 1 && worst.ratio[i] > 0;
  }
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  const long windows = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  const auto seed = static_cast<unsigned>(argc > 2 ? std::atol(argv[2]) : 1);
  std::printf("seed %u, %ld windows\n", seed, windows);
  const bool long_one = check(1500, windows - windows / 2, seed),
             short_one = check(800, windows / 2, seed + 1);
  return long_one && short_one ? 0 : 1;
}
