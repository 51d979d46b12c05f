// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/signal_features.h"

#include <algorithm>
#include <cmath>

namespace vernier::vibration {
namespace {

// MATLAB's meanfreq: one-sided periodogram, rectangular window; the mean value counts, zero and half the rate
// once.
double mean_frequency(std::span<const double> x, double rate_Hz, Fourier& fourier) {
  const auto lines = fourier.forward(x);
  double moment = 0, power = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double p = std::norm(lines[k]) * (k == 0 || 2 * k == x.size() ? 1 : 2);
    power += p;
    moment += p * static_cast<double>(k);
  }
  return moment / power * rate_Hz / static_cast<double>(x.size());
}

}  // namespace

bool in_signal_unit(std::size_t feature) { return feature == 0 || feature == 2 || feature == 10; }

SignalFeatures signal_features(std::span<const double> x, double rate_Hz, Fourier& fourier) {
  const auto n = static_cast<double>(x.size());
  double sum = 0, absolute = 0, square = 0;
  for (const double v : x) sum += v, absolute += std::fabs(v), square += v * v;
  const double mean = sum / n;
  double second = 0, third = 0, fourth = 0;
  for (const double v : x) {
    const double d = v - mean, d2 = d * d;
    second += d2, third += d2 * d, fourth += d2 * d2;
  }
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double mav = absolute / n, rms = std::sqrt(square / n),
               largest = std::max(std::fabs(*low), std::fabs(*high));
  const double m2 = second / n;
  return {mav,
          second / (n - 1),
          rms,
          rms / mav,
          largest / mav,
          largest / rms,
          fourth / n / (m2 * m2),
          third / n / (m2 * std::sqrt(m2)),
          mean_frequency(x, rate_Hz, fourier),
          square / n,
          *high,
          *high / mav,
          *high / rms};
}

}  // namespace vernier::vibration
