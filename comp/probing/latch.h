// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/compensator.h"
#include "comp/quantity.h"

namespace vernier {

/// Positions of the axes at one instant, and the part of each correction that is not yet applied.
struct LatchSample {
  InstantNs at;
  AxisPosition position[kMaxAxes];
  Correction owed[kMaxAxes];  // wanted minus applied, counts of the axis
};

/// Reason why LatchRing has no position at an instant.
enum class LatchFault : std::uint8_t {
  kNone = 0,
  kNotYet = 1,   // the samples behind the instant have not come: ask again after the next one
  kTooOld = 2,   // the ring has forgotten it
  kUneven = 3,   // samples are missing around it: their distances differ by more than kMostUneven
  kTooFast = 4,  // an axis moved more than 2^35 counts between two samples
};

/// The position of an axis at a past instant.
struct LatchedPosition {
  AxisPosition position;
  AxisTravel
      uncertainty;  // standard uncertainty of the instant times the speed, plus twice `truncation`, counts
  AxisTravel truncation;  // how far the two parabolas that the cubic is made of lie apart, counts
  AxisTravel owed;        // Correction::owed at the instant, linear between the samples
};

/// The latest samples of all axes. LatchRing computes positions between samples by the cubic through the four
/// neighbours. The cubic is also accurate during acceleration and deceleration, and for samples
/// at uneven distances. LatchRing needs no division; its work is bounded: at most six ratios of 33 steps per
/// instant and six products per axis.
///
/// Error of an interpolated position: 1 count of rounding (linear axis below 2 m/s) plus the error of the
/// cubic. The cubic has h^4/384 of the fourth derivative at even distance h, and h^2/16 of a jump in
/// acceleration.
class LatchRing {
 public:
  static constexpr std::uint32_t kSize = 64;
  static constexpr std::int64_t kMostUneven = 8;

  /// Adds a sample. sample.at: later than the previous sample; otherwise the ring is emptied and starts with
  /// this sample. Real-time safe.
  void add(const LatchSample& sample) noexcept;

  /// Goes to an instant. Real-time safe.
  LatchFault seek(InstantNs when) noexcept;

  /// Computes the position at the instant of the last successful seek(). axis: below kMaxAxes; rollover:
  /// whole turns (2^32 counts) between two samples are ignored. time_uncertainty: standard uncertainty of the
  /// instant, 0 .. 2^31 ns. kTooFast or kNone. Real-time safe.
  LatchFault position_of(std::uint32_t axis, bool rollover, InstantNs time_uncertainty,
                         LatchedPosition& latched) const noexcept;

  /// Returns the instant of the newest sample; meaningless in an empty ring.
  InstantNs newest() const noexcept { return sample(count_ - 1).at; }
  bool empty() const noexcept { return count_ == 0; }

 private:
  const LatchSample& sample(std::uint64_t i) const noexcept { return samples_[i % kSize]; }

  LatchSample samples_[kSize];
  std::uint64_t count_ = 0, begin_ = 0;  // samples begin_ .. count_ - 1 belong together
  // Result of the last seek(): index of the first of the four neighbouring samples, and (when - t_i) / (t_j -
  // t_i) in Q28.
  std::uint64_t first_ = 0;
  std::int64_t r01_ = 0, r12_ = 0, r23_ = 0, r02_ = 0, r13_ = 0, r03_ = 0;
  std::int64_t gap_[3] = {};  // ns between the neighbours
};

}  // namespace vernier
