// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

#include "comp/compensator.h"
#include "tables/image_view.h"

namespace vernier::bench {

/// Seeded poses that need nothing but integers, so that every target walks the same ones (xorshift64*, Vigna
/// 2016).
class Poses {
 public:
  explicit Poses(const ImageView& view) : view_(view) {}

  CycleInput next() {
    CycleInput input;
    for (std::uint32_t i = 0; i < view_.axes().size; ++i) {
      AxisInput& axis = input.axis[i];
      axis.position = AxisPosition(between(view_.axes()[i].low, view_.axes()[i].high));
      axis.velocity = AxisSpeed(between(-500000000, 500000000));
      axis.acceleration = AxisAcceleration(between(-2000000000, 2000000000));
      axis.since = AxisTravel(between(0, 100000000));
      axis.sense = static_cast<std::int8_t>(random() >> 63 != 0 ? 1 : -1);
    }
    for (std::uint32_t i = 0; i < view_.inputs().size; ++i)
      input.input[i] = InputMicro(between(view_.inputs()[i].low, view_.inputs()[i].high));
    input.feed = FeedNmPerMin(between(0, 5000000000));
    input.curvature = CurvatureNanoPerMm(between(0, 100000000));
    input.time = TimeUs(time_us_ += 1000);
    return input;
  }

 private:
  std::uint64_t random() {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return state_ * 0x2545f4914f6cdd1du;
  }
  // The range scaled by 32 random bits; no division. Ranges stay below 2^62 counts.
  std::int64_t between(std::int64_t low, std::int64_t high) {
    const auto width = static_cast<std::uint64_t>(high - low);
    const std::uint64_t share = random() >> 32;
    return low + static_cast<std::int64_t>((width >> 32) * share + (((width & 0xffffffffu) * share) >> 32));
  }

  const ImageView& view_;
  std::uint64_t state_ = 20260701;
  std::int64_t time_us_ = 0;
};

/// FNV-1a over the corrections and flags of one tick.
inline std::uint64_t mixed(std::uint64_t hash, const CycleOutput& output) {
  for (const Correction& correction : output.correction)
    hash = (hash ^ static_cast<std::uint32_t>(correction.counts)) * 0x100000001b3u;
  return (hash ^ output.flags) * 0x100000001b3u;
}

}  // namespace vernier::bench
