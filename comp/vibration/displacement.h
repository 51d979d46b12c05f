// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"

namespace vernier {

/// Scales for the conversion of accelerometer samples to a displacement. Each field has its own unit;
/// Displacement::start checks the fields.
struct DisplacementScale {
  std::int64_t lsb_nm_s2 = 98067;     // value of one LSB, nm/s^2, 1..2^31 (10 ug)
  std::int64_t rate_mHz = 1'000'000;  // sample rate, 1..2^30 mHz
  std::int64_t corner_mHz = 500;      // corner frequency; drift below it is removed; rate/2^17 to rate/64
  std::int64_t exact_mHz = 180'000;   // frequency at which the gain is exact, 0 to rate/4
};

/// A factor below 1: mantissa * 2^-shift, mantissa 2^30..2^31 - 1, shift 31..94.
struct Factor {
  std::int64_t mantissa = 0;
  unsigned shift = 31;
};

/// Computes the displacement from the acceleration within a frequency band. The filter has two sections s /
/// (s^2 + sqrt(2) w s + w^2) in series, with w = 2 pi corner. The two sections integrate twice above the
/// corner frequency, and remove constant and linear parts below it.
///
/// Form. Each section has two states, v and p = e (sum of v), with e = w / rate. Each sample changes the two
/// states of a section by v += u - sqrt(2) e v - e p and p += e v. Far above the corner the two sections are
/// z^2 / (z - 1)^2. A symmetric filter k, 1 - 2k, k before the sections makes the integral free of delay and
/// phase. The integral is exact at the angle t per sample that corresponds to `exact_mHz`, where k = 1 / (4
/// sin^2(t/2)) - 1 / t^2. At a rate of 1 kHz and an exact frequency of 180 Hz, the gain is within 0.3 % up
/// to 200 Hz (with the bilinear form: 25 %).
///
/// Drift. The sums of |impulse response| for every e <= 1/8 are (test
/// Displacement.GainsStayBelowTheirBounds): a sample to v 0.97/e, to x 0.71/e^2; a step to x 0.21/e^2. From
/// these sums, an acceleration bias within +-b moves x by less than 0.71 b/w^2, and a step of the bias by b
/// moves x by less than 0.21 b/w^2. The effect of a constant bias decays like exp(-w t / sqrt(2)).
///
/// Widths. |sample| < 2^19, e > 2^-14.4: v, p < 2^34 with 27 guard bits, x and its p < 2^47.4 with 14: below
/// 2^62. Rounding: at most 0.63 of a guard unit per product, together (2.4 2^-27/e^2 + 3 2^-14/e) lsb/rate^2
/// + 0.51 nm.
class Displacement {
 public:
  static constexpr std::int32_t kLimit = (std::int32_t{1} << 19) - 1;

  /// Starts the filter at rest. Returns false and changes nothing if a field of the scale is out of range.
  /// Not real-time safe.
  bool start(const DisplacementScale& scale) noexcept;

  /// Takes one sample in LSB. Returns the displacement at the time of this sample. A sample beyond +-kLimit
  /// is limited to +-kLimit, and a displacement beyond int32 is limited to int32. Limited samples and
  /// limited displacements are counted. Real-time safe.
  LengthNm step(std::int32_t sample) noexcept;

  std::uint32_t held() const noexcept { return held_; }

 private:
  struct Section {
    std::int64_t v = 0, p = 0;
    std::int64_t step(std::int64_t u, Factor epsilon, Factor damping) noexcept;
  };

  Section first_, second_;
  Factor epsilon_, damping_, nanometres_;  // e, sqrt(2) e, and the guard unit of x in nm
  std::int64_t bend_ = 0;                  // the factor k of the symmetric filter, 24 fraction bits
  std::int32_t before_ = 0, last_ = 0;
  std::uint32_t held_ = 0;
};

}  // namespace vernier
