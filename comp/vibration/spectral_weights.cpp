// SPDX-License-Identifier: Apache-2.0
#include "comp/vibration/spectral_weights.h"

#include "comp/vibration/scaled.h"

namespace vernier {
namespace {

constexpr std::uint64_t kPiQ62 = 14488038916154245685u;  // 3.14159265358979323846 * 2^62

// x with 62 fraction bits; x < 4.
std::uint64_t fixed_of(Scaled x) noexcept {
  const std::int32_t shift = -(x.exponent + 62);  // mantissa * 2^exponent * 2^62
  return shift <= 0 ? x.mantissa : shift >= 64 ? 0 : x.mantissa >> shift;
}

// sin x, x 0..pi/2: x (1 - x^2/(2*3) (1 - x^2/(4*5) (...))), twelve brackets: the next term is below 1e-20.
// The outer product keeps the relative precision of small angles.
Scaled sine_of(Scaled x) noexcept {
  constexpr std::uint64_t kInverse[] = {// 2^64 / (2k (2k + 1)), k = 1..12
                                        3074457345618258602u, 922337203685477580u, 439208192231179800u,
                                        256204778801521550u,  167697673397359560u, 118248359446856100u,
                                        87841638446235960u,   67818912035696880u,  53937848168741378u,
                                        43920819223117980u,   36456015955947730u,  30744573456182586u};
  const std::uint64_t square = fixed_of(x * x);
  std::uint64_t bracket = kOneQ62;
  for (int k = 11; k >= 0; --k) {
    const std::uint64_t step = long_product(square, kInverse[k]).high;  // x^2/(2k(2k+1)), 62 bits
    bracket = kOneQ62 - (long_product(step, bracket).high << 2);
  }
  return shifted(x * scaled(bracket), -62);
}

}  // namespace

bool prepare_weights(std::uint32_t window, SpectralWeights& weights) noexcept {
  if (window < 6 || window > kMaxWindow || window % 2 != 0) return false;
  weights = {};
  weights.window = window;
  const std::uint32_t half = window / 2;
  weights.pairs = half / 2;
  const Scaled n = scaled(std::uint64_t{window});
  const Scaled step = shifted(scaled(kPiQ62), -62) * reciprocal(n);
  for (std::uint32_t m = 1; m <= half; m += 2) {
    const Scaled side = n * sine_of(step * scaled(std::uint64_t{m}));
    const auto weight = static_cast<std::int32_t>(count_of(shifted(reciprocal(side * side), kSpectralShift)));
    if (m == half) {
      weights.middle = weight;
    } else {
      weights.weight[m / 2] = weight;
    }
  }
  return true;
}

}  // namespace vernier
