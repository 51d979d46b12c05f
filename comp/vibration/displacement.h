// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"

namespace vernier {

/// Scales for the conversion of accelerometer samples to a displacement. Each field has its own unit;
/// Displacement::start checks the fields.
struct DisplacementScale {
  std::int64_t lsb_nm_s2 = 98067;     // one LSB, nm/s^2, 1..2^31 (10 ug)
  std::int64_t rate_mHz = 1'000'000;  // samples per second, 1..2^30 mHz
  std::int64_t corner_mHz = 500;      // below it drift is taken out; rate/2^17 .. rate/64
  std::int64_t exact_mHz = 180'000;   // gain is exact here, 0 .. rate/4
};

/// A factor below 1: mantissa * 2^-shift, mantissa 2^30..2^31 - 1, shift 31..94.
struct Factor {
  std::int64_t mantissa = 0;
  unsigned shift = 31;
};

/// Displacement from acceleration within a band: two sections s / (s^2 + sqrt(2) w s + w^2) in a row, w = 2
/// pi corner. The two sections integrate twice above the corner frequency and remove constants and slopes
/// below the corner.
///
/// Form. Each section has two states, v and p = e (sum of v), with e = w / rate: v += u - sqrt(2) e v - e p,
/// p += e v. Far above the corner the two sections are z^2 / (z - 1)^2. The symmetric filter k, 1 - 2k, k
/// before them makes an integral without delay or phase. The integral is exact at the angle t per sample of
/// `exact`, where k = 1 / (4 sin^2(t/2)) - 1 / t^2. At 1 kHz and exact = 180 Hz the gain is within 0.3 % up
/// to 200 Hz (the bilinear form: 25 %).
///
/// Drift. Sums of |impulse response| for every e <= 1/8 (test Displacement.GainsStayBelowTheirBounds): a
/// sample to v 0.97/e, to x 0.71/e^2; a step to x 0.21/e^2. An acceleration bias within +-b therefore moves x
/// by less than 0.71 b/w^2, a step of b by less than 0.21 b/w^2. The effect of a constant bias decays like
/// exp(-w t / sqrt(2)).
///
/// Widths. |sample| < 2^19, e > 2^-14.4: v, p < 2^34 with 27 guard bits, x and its p < 2^47.4 with 14: below
/// 2^62. Rounding: at most 0.63 of a guard unit per product, together (2.4 2^-27/e^2 + 3 2^-14/e) lsb/rate^2
/// + 0.51 nm.
class Displacement {
 public:
  static constexpr std::int32_t kLimit = (std::int32_t{1} << 19) - 1;

  /// Starts at rest. Returns false, and changes nothing, if a setting is out of range. Not real-time safe.
  bool start(const DisplacementScale& scale) noexcept;

  /// Takes a sample, LSB; returns the displacement at the instant of the sample. A sample beyond +-kLimit is
  /// limited to +-kLimit, a displacement beyond int32 to int32; both are counted. Real-time safe.
  LengthNm step(std::int32_t sample) noexcept;

  std::uint32_t held() const noexcept { return held_; }

 private:
  struct Section {
    std::int64_t v = 0, p = 0;
    std::int64_t step(std::int64_t u, Factor epsilon, Factor damping) noexcept;
  };

  Section first_, second_;
  Factor epsilon_, damping_, nanometres_;  // e, sqrt(2) e, guard unit of x in nm
  std::int64_t bend_ = 0;                  // k, 24 fraction bits
  std::int32_t before_ = 0, last_ = 0;
  std::uint32_t held_ = 0;
};

}  // namespace vernier
