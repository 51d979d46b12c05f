// SPDX-License-Identifier: Apache-2.0
#include "comp/vibration/displacement.h"

#include "comp/fixed.h"
#include "comp/vibration/scaled.h"

namespace vernier {
namespace {

constexpr unsigned kBendBits = 24, kSpeedGuard = 27, kTravelGuard = 14;
constexpr Scaled kTwoPi{14488038916154245685u, -61};    // 2 pi
constexpr Scaled kRootTwo{13043817825332782212u, -63};  // sqrt(2)

Scaled scaled_count(std::int64_t positive) noexcept { return scaled(static_cast<std::uint64_t>(positive)); }

Factor factor_of(Scaled value) noexcept {
  return {static_cast<std::int64_t>(value.mantissa >> 33), static_cast<unsigned>(-(value.exponent + 33))};
}

// value * factor, |value| < 2^62: two halves, the lower one cut below the unit that the last rounding sees.
std::int64_t times(std::int64_t value, Factor factor) noexcept {
  const std::int64_t high = (value >> 31) * factor.mantissa;
  const std::int64_t low = ((value & 0x7fffffff) * factor.mantissa) >> 31;
  return round_shift(high + low, factor.shift - 31);
}

// 1 / (4 sin^2(t/2)) - 1 / t^2 with kBendBits: its series in t^2; the omitted terms are below 2^-20 for t <=
// pi/2.
std::int64_t bend_of(Scaled t) noexcept {
  constexpr std::uint64_t kDivisors[] = {12, 240, 6048, 172800, 5322240};
  const Scaled square = t * t;
  Scaled power{std::uint64_t{1} << 63, -63};
  std::int64_t sum = 0;
  for (const std::uint64_t divisor : kDivisors) {
    sum += count_of(shifted(power * reciprocal(scaled(divisor)), 40));
    power = power * square;
  }
  return round_shift(sum, 40 - kBendBits);
}

// (1 - e/sqrt(2))^2: the feedback's delay of one sample raises the gain above the corner by the inverse of
// it.
Scaled delay_gain(Scaled epsilon) noexcept {
  const auto loss = static_cast<std::uint64_t>(count_of(shifted(epsilon * kRootTwo, 61)));
  const Scaled left = shifted(scaled(kOneQ62 - loss), -62);
  return left * left;
}

}  // namespace

bool Displacement::start(const DisplacementScale& scale) noexcept {
  constexpr std::int64_t kMaxLsb = std::int64_t{1} << 31, kMaxRate = std::int64_t{1} << 30;
  if (scale.lsb_nm_s2 < 1 || scale.lsb_nm_s2 > kMaxLsb) return false;
  if (scale.rate_mHz < 1 || scale.rate_mHz > kMaxRate) return false;
  if (scale.corner_mHz < 1 || scale.corner_mHz * 64 > scale.rate_mHz) return false;
  if (scale.corner_mHz * 131072 < scale.rate_mHz) return false;
  if (scale.exact_mHz < 0 || scale.exact_mHz * 4 > scale.rate_mHz) return false;
  const Scaled period = reciprocal(scaled_count(scale.rate_mHz));  // ks
  const Scaled epsilon = kTwoPi * scaled_count(scale.corner_mHz) * period;
  const Scaled unit_nm = scaled_count(scale.lsb_nm_s2) * scaled(std::uint64_t{1'000'000}) * period * period;
  const Factor nanometres =
      factor_of(shifted(unit_nm * delay_gain(epsilon), -static_cast<std::int32_t>(kTravelGuard)));
  if (nanometres.shift < 31 || nanometres.shift > 94) return false;  // an LSB of more than 16 um a sample
  *this = Displacement{};
  nanometres_ = nanometres;
  epsilon_ = factor_of(epsilon);
  damping_ = factor_of(epsilon * kRootTwo);
  bend_ = bend_of(kTwoPi * scaled_count(scale.exact_mHz) * period);
  return true;
}

std::int64_t Displacement::Section::step(std::int64_t u, Factor epsilon, Factor damping) noexcept {
  v += u - times(v, damping) - times(p, epsilon);
  p += times(v, epsilon);
  return v;
}

LengthNm Displacement::step(std::int32_t sample) noexcept {
  const std::int32_t taken = clamp(sample, -kLimit, kLimit);
  if (taken != sample) ++held_;
  constexpr std::int64_t kOne = std::int64_t{1} << kBendBits;
  const std::int64_t bent = bend_ * (std::int64_t{taken} + before_) + (kOne - 2 * bend_) * last_;
  before_ = last_;
  last_ = taken;
  const std::int64_t v = first_.step(bent * (1 << (kSpeedGuard - kBendBits)), epsilon_, damping_);
  const std::int64_t x = second_.step(round_shift(v, kSpeedGuard - kTravelGuard), epsilon_, damping_);
  bool beyond = false;
  const LengthNm result(saturate(times(x, nanometres_), beyond));
  if (beyond) ++held_;
  return result;
}

}  // namespace vernier
