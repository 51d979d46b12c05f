// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/fixed.h"
#include "comp/quantity.h"

namespace vernier {

/// Location of a workpiece in a machine with axes X, Y, Z: its origin and its rotation about Z. The host
/// computer computes the cosine and the sine, so that the board computes no angle.
struct WorkpieceFrame {
  static constexpr std::int32_t kOne = std::int32_t{1} << 30;

  PositionNm origin[3];        // machine coordinates, |.| < 2^50
  std::int32_t cosine = kOne;  // Q30; the sum cosine^2 + sine^2 differs from one by at most 2^-28
  std::int32_t sine = 0;       // sine of the angle from the machine's X axis to the workpiece's X axis

  /// True if cosine and sine form a rotation and all values are in range. Not real-time safe.
  constexpr bool valid() const noexcept {
    constexpr std::int64_t kUnit = std::int64_t{kOne} * kOne;
    if (cosine < -kOne || cosine > kOne || sine < -kOne || sine > kOne) return false;
    const std::int64_t off = std::int64_t{cosine} * cosine + std::int64_t{sine} * sine - kUnit;
    for (const PositionNm& at : origin)
      if (at.count <= -kMost || at.count >= kMost) return false;
    return off <= (kUnit >> 28) && off >= -(kUnit >> 28);
  }
  /// Converts machine coordinates X, Y, Z to workpiece coordinates; the error is below 2 nm. `machine`:
  /// coordinates with a magnitude below 2^50. Real-time safe.
  constexpr void to_workpiece(const PositionNm* machine, PositionNm* workpiece) const noexcept {
    const std::int64_t x = machine[0].count - origin[0].count, y = machine[1].count - origin[1].count;
    workpiece[0] = PositionNm(turned(x, cosine) + turned(y, sine));
    workpiece[1] = PositionNm(turned(y, cosine) - turned(x, sine));
    workpiece[2] = PositionNm(machine[2].count - origin[2].count);
  }

 private:
  static constexpr std::int64_t kMost = std::int64_t{1} << 50;
  // Computes value * q30 in two halves, so that 2^51 times 2^30 does not overflow.
  static constexpr std::int64_t turned(std::int64_t value, std::int32_t q30) noexcept {
    const std::int64_t high = (value >> 20) * q30, low = (value & 0xfffff) * q30;
    return round_shift(high + (low >> 20), 10);
  }
};
// The link of the board transmits this struct (workpiece frame) without conversion (LinkOp::kWorkpiece).
static_assert(sizeof(WorkpieceFrame) == 32);
static_assert(offsetof(WorkpieceFrame, origin) == 0 && offsetof(WorkpieceFrame, cosine) == 24 &&
              offsetof(WorkpieceFrame, sine) == 28);

}  // namespace vernier
