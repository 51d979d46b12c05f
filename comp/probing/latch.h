// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"
#include "comp/quantity.h"

namespace vernier {

/// Positions of the axes at one time, and the part of each correction that is not yet applied.
struct LatchSample {
  InstantNs at;
  AxisPosition position[kMaxAxes];
  Correction owed[kMaxAxes];  // required minus applied correction, counts of the axis
};

/// Reason why LatchRing has no position at a requested time.
enum class LatchFault : std::uint8_t {
  kNone = 0,
  kNotYet = 1,   // the samples after the requested time have not come yet; ask again after the next sample
  kTooOld = 2,   // the ring no longer contains samples of the requested time
  kUneven = 3,   // samples near the requested time are missing: their distances differ by more than the
                 // factor kMostUneven
  kTooFast = 4,  // an axis moved more than 2^35 counts between two samples
};

/// The position of an axis at a time in the past.
struct LatchedPosition {
  AxisPosition position;
  AxisTravel uncertainty;  // standard uncertainty of the time multiplied by the speed, plus twice
                           // `truncation`, counts
  AxisTravel truncation;   // distance between the two parabolas of which the cubic is composed, counts
  AxisTravel owed;         // LatchSample::owed at the requested time, linear between the samples
};

/// Ring with the latest samples of all axes. LatchRing computes positions between samples with the cubic
/// polynomial through the four neighbouring samples. The cubic is also accurate during acceleration and
/// deceleration, and for samples at uneven intervals. LatchRing needs no division, and its computing time is
/// limited: at most six ratios of 33 steps per requested time, and six products per axis.
///
/// The error of an interpolated position is 1 count of rounding (linear axis below 2 m/s) plus the error of
/// the cubic. The error of the cubic is h^4/384 of the fourth derivative at the even interval h, and h^2/16
/// of a jump in acceleration.
class LatchRing {
 public:
  static constexpr std::uint32_t kSize = 64;
  static constexpr std::int64_t kMostUneven = 8;

  /// Adds a sample. The time of a sample must be later than that of the previous sample; otherwise the ring
  /// is emptied and starts with this sample. Real-time safe.
  void add(const LatchSample& sample) noexcept;

  /// Selects the time for which position_of() computes positions. Real-time safe.
  LatchFault seek(InstantNs when) noexcept;

  /// Computes the position of an axis at the time of the last successful seek(). `axis`: below kMaxAxes;
  /// `rollover`: true ignores whole turns (2^32 counts) between two samples. `time_uncertainty`: standard
  /// uncertainty of the time, 0 to 2^31 ns. The function position_of() returns kTooFast or kNone. Real-time
  /// safe.
  LatchFault position_of(std::uint32_t axis, bool rollover, InstantNs time_uncertainty,
                         LatchedPosition& latched) const noexcept;

  /// Returns the time of the newest sample; the value has no meaning if the ring is empty.
  InstantNs newest() const noexcept { return sample(count_ - 1).at; }
  bool empty() const noexcept { return count_ == 0; }

 private:
  const LatchSample& sample(std::uint64_t i) const noexcept { return samples_[i % kSize]; }

  LatchSample samples_[kSize];
  std::uint64_t count_ = 0, begin_ = 0;  // the samples begin_ to count_ - 1 are one sequence
  // Result of the last seek(): index of the first of the four neighbouring samples, and the ratios (when -
  // t_i) / (t_j - t_i) in Q28.
  std::uint64_t first_ = 0;
  std::int64_t r01_ = 0, r12_ = 0, r23_ = 0, r02_ = 0, r13_ = 0, r03_ = 0;
  std::int64_t gap_[3] = {};  // intervals between the neighbouring samples, ns
};

}  // namespace vernier
