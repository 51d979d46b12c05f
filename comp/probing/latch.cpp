// SPDX-License-Identifier: Apache-2.0
#include "comp/probing/latch.h"

#include "comp/fixed.h"

namespace vernier {
namespace {

constexpr unsigned kRatioBits = 28;
constexpr unsigned kGuardBits = 8;  // below the count, while parabolas are built
constexpr std::int64_t kMostTravel = std::int64_t{1} << 35;

// numerator / denominator in Q28, cut towards zero. 0 < denominator < 2^31, |numerator| < 16 * denominator.
std::int64_t ratio(std::int64_t numerator, std::int64_t denominator) noexcept {
  std::int64_t rest = magnitude_of(numerator) << kRatioBits;
  std::int64_t quotient = 0;
  for (int bit = kRatioBits + 4; bit >= 0; --bit) {
    const std::int64_t part = denominator << bit;
    if (rest < part) continue;
    rest -= part;
    quotient |= std::int64_t{1} << bit;
  }
  return numerator < 0 ? -quotient : quotient;
}

// value * ratio, rounded down to a guard bit. |value| < 2^46, |ratio| < 2^32.
std::int64_t scaled(std::int64_t value, std::int64_t q28) noexcept {
  constexpr unsigned kHalf = kRatioBits / 2;
  const std::int64_t high = (value >> kHalf) * q28;
  const std::int64_t low = (value & ((std::int64_t{1} << kHalf) - 1)) * q28;
  return (high >> kHalf) + (low >> kRatioBits);
}

// One step of Neville's scheme: the value at the instant between two that end at neighbouring samples.
std::int64_t between(std::int64_t from, std::int64_t to, std::int64_t q28) noexcept {
  return from + scaled(to - from, q28);
}

}  // namespace

void LatchRing::add(const LatchSample& sample) noexcept {
  if (count_ > begin_ && sample.at <= newest()) begin_ = count_;
  samples_[count_ % kSize] = sample;
  ++count_;
  if (count_ - begin_ > kSize) begin_ = count_ - kSize;
}

LatchFault LatchRing::seek(InstantNs when) noexcept {
  if (count_ - begin_ < 4) return LatchFault::kNotYet;
  if (sample(begin_ + 1).at > when) return LatchFault::kTooOld;
  // The newest sample that is not later than the instant, with one more on its other side.
  std::uint64_t before = count_ - 1;
  while (sample(before).at > when) --before;  // ends at begin_ + 1
  if (before + 2 >= count_) return LatchFault::kNotYet;
  const std::uint64_t first = before - 1;
  std::int64_t t[4], gap[3];
  for (std::uint32_t i = 0; i < 4; ++i) t[i] = (sample(first + i).at - sample(first).at).count;
  std::int64_t least = INT64_MAX, most = 0;
  for (int i = 0; i < 3; ++i) {
    gap[i] = t[i + 1] - t[i];
    least = lower(least, gap[i]), most = higher(most, gap[i]);
  }
  if (t[3] >= (std::int64_t{1} << 30) || most > kMostUneven * least) return LatchFault::kUneven;
  const std::int64_t at = (when - sample(first).at).count;
  first_ = first;
  for (int i = 0; i < 3; ++i) gap_[i] = gap[i];
  // Times count from the first of the four samples: t[0] is zero.
  r01_ = ratio(at, t[1]), r12_ = ratio(at - t[1], t[2] - t[1]), r23_ = ratio(at - t[2], t[3] - t[2]);
  r02_ = ratio(at, t[2]), r13_ = ratio(at - t[1], t[3] - t[1]);
  r03_ = ratio(at, t[3]);
  return LatchFault::kNone;
}

LatchFault LatchRing::position_of(std::uint32_t axis, bool rollover, InstantNs time_uncertainty,
                                  LatchedPosition& latched) const noexcept {
  const std::int64_t origin = sample(first_ + 1).position[axis].count;
  std::int64_t p[4];
  for (std::uint32_t i = 0; i < 4; ++i) {
    // Unsigned, so that no two readings overflow.
    const auto travel =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(sample(first_ + i).position[axis].count) -
                                  static_cast<std::uint64_t>(origin));
    p[i] = rollover ? static_cast<std::int32_t>(static_cast<std::uint32_t>(travel)) : travel;
    if (p[i] >= kMostTravel || p[i] <= -kMostTravel) return LatchFault::kTooFast;
    p[i] *= std::int64_t{1} << kGuardBits;
  }
  const std::int64_t p01 = between(p[0], p[1], r01_), p12 = between(p[1], p[2], r12_),
                     p23 = between(p[2], p[3], r23_);
  const std::int64_t p02 = between(p01, p12, r02_), p13 = between(p12, p23, r13_);
  const std::int64_t p03 = between(p02, p13, r03_);
  latched.position = AxisPosition(origin + round_shift(p03, kGuardBits));
  latched.truncation = AxisTravel(round_shift(magnitude_of(p13 - p02), kGuardBits));
  std::int64_t blur = 0;  // of the fastest of the three stretches
  for (int i = 0; i < 3; ++i) {
    const std::int64_t most_time = 15 * gap_[i];
    const std::int64_t q28 = ratio(lower(time_uncertainty.count, most_time), gap_[i]);
    blur = higher(blur, scaled(magnitude_of(p[i + 1] - p[i]), q28));
  }
  const std::int64_t up = (std::int64_t{1} << kGuardBits) - 1;
  latched.uncertainty = AxisTravel(((blur + up) >> kGuardBits) + 2 * latched.truncation.count);
  const std::int64_t owed = sample(first_ + 1).owed[axis].counts;
  latched.owed = AxisTravel(owed + scaled(sample(first_ + 2).owed[axis].counts - owed, r12_));
  return LatchFault::kNone;
}

}  // namespace vernier
