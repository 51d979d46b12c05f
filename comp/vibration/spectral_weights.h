// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

constexpr std::uint32_t kMaxWindow = 2048;
constexpr unsigned kSpectralShift = 34;

/// Weights for the mean frequency of a window of n samples. The one-sided periodogram (rectangular window, n
/// points, zero and half the rate counted once) has sum f P / sum P = rate * (1/4 - sum over odd m of h(m)
/// R(m) / R(0)). R is the circular autocorrelation. h(m) = 1 / (n sin(pi m/n))^2 is the transform of a
/// triangle, which is zero at even m. A new sample in the window therefore needs n/4 products, exactly; a
/// sliding transform needs n. Weights are h in 2^-34, rounded: 2^34/9 at most (n = 6), all odd m together
/// 2^32.
struct SpectralWeights {
  std::uint32_t window = 0;
  std::uint32_t pairs = 0;                   // odd m below n/2: each serves m and n - m
  std::int32_t weight[kMaxWindow / 4] = {};  // of m = 1, 3, 5 ...
  std::int32_t middle = 0;                   // of m = n/2 if that is odd, else 0
};

/// Computes the weights for a window of n samples, in integers. The bits are identical on every target; each
/// weight is within 0.5 + 1e-6 of exact. Returns false, and changes nothing, if n is odd or not in 6..2048.
/// Not real-time safe.
bool prepare_weights(std::uint32_t window, SpectralWeights& weights) noexcept;

}  // namespace vernier
