// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

constexpr std::uint32_t kMaxWindow = 2048;
constexpr unsigned kSpectralShift = 34;

/// Weights for the mean frequency of a window of n samples. For the one-sided periodogram (rectangular
/// window, n points; zero and half the rate are counted once), the mean frequency is sum f P / sum P = rate *
/// (1/4 - sum over odd m of h(m) R(m) / R(0)). In this formula, R is the circular autocorrelation. The
/// weights h(m) = 1 / (n sin(pi m/n))^2 are the transform of a triangle, which is zero at even m. Because of
/// this form, a new sample in the window needs n/4 exact products. A sliding transform needs n products. The
/// stored weights are h in units of 2^-34, rounded. A weight is at most 2^34/9 (n = 6), and the sum over all
/// odd m is 2^32.
struct SpectralWeights {
  std::uint32_t window = 0;
  std::uint32_t pairs = 0;                   // number of odd m below n/2; each weight is used for m and n - m
  std::int32_t weight[kMaxWindow / 4] = {};  // weights of m = 1, 3, 5 ...
  std::int32_t middle = 0;                   // weight of m = n/2 if n/2 is odd, otherwise 0
};

/// Computes the weights for a window of n samples with integer arithmetic. The weights have the same bits on
/// every target. The error of each weight is at most 0.5 + 1e-6. Returns false and changes nothing if n is
/// odd or outside 6..2048. Not real-time safe.
bool prepare_weights(std::uint32_t window, SpectralWeights& weights) noexcept;

}  // namespace vernier
