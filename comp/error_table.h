// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"
#include "comp/view.h"

namespace vernier {

/// One as a fraction of a segment (Q30), reached at the far end of a segment.
constexpr std::int32_t kFractionOne = std::int32_t{1} << 30;

/// The stretch between two neighbouring stations of a table, in counts of the position's register.
/// Nodes stand at the segment's ends: station i is the start of segment i, the last station the end of the
/// last.
struct Segment {
  std::int32_t start;    // position of the station at the near end
  std::uint32_t length;  // to the next station, > 0
  std::uint32_t
      reciprocal;       // ceil(2^(30 + shift) / length): turns a distance into a fraction without division
  std::uint32_t shift;  // 0..33
};

/// A periodic axis: positions are brought into [first, first + period) before the look-up.
struct Wrap {
  std::int32_t first;
  std::int32_t period;      // > 0
  std::int32_t reciprocal;  // about 2^shift / period
  std::uint32_t shift;      // 0..61
};

/// Number of the segment that holds `position`; 0 before the first station, the last one beyond the last
/// station. A position on a station belongs to the segment that starts there. segments: at least one, starts
/// increasing. Branch-free bisection: the number of steps depends on the table's length alone. Exact.
/// realtime.
inline std::uint32_t segment_of(View<Segment> segments, std::int32_t position) noexcept {
  std::uint32_t base = 0;
  for (std::uint32_t count = segments.size; count > 1;) {
    const std::uint32_t half = count / 2;
    base += position >= segments[base + half].start ? half : 0;
    count -= half;
  }
  return base;
}

/// How far `position` lies into the segment, 0..kFractionOne (Q30); held at 0 before and at one beyond it.
/// Truncates: error < 2^-30 + 2^-31 of the segment, exact at both ends. realtime.
inline std::int32_t fraction_in(const Segment& segment, std::int32_t position) noexcept {
  const std::int64_t distance = std::int64_t{position} - segment.start;
  const std::uint64_t inside =
      static_cast<std::uint64_t>(clamp<std::int64_t>(distance, 0, std::int64_t{segment.length}));
  const std::uint64_t fraction = (inside * segment.reciprocal) >> segment.shift;
  return static_cast<std::int32_t>(lower<std::uint64_t>(fraction, kFractionOne));
}

/// Value between two stations: near + fraction * (far - near), rounded once (<= 1/2 LSB of the column).
/// Stays within the two; |far - near| < 2^32, product < 2^62. realtime.
inline std::int32_t linear_between(std::int32_t near, std::int32_t far, std::int32_t fraction) noexcept {
  return narrow(near + round_shift((std::int64_t{far} - near) * fraction, 30));
}

/// Value of the cubic c[0] + f (c[1] + f (c[2] + f c[3])), f the fraction (Q30), all in the column's format.
/// Three roundings, together <= 3/2 LSB. |c[1]|, |c[2]|, |c[3]| sums < 2^31 (proved by the verifier).
/// realtime.
inline std::int32_t cubic_between(const std::int32_t* c, std::int32_t fraction) noexcept {
  const std::int64_t f = fraction;
  const std::int64_t second = c[2] + round_shift(c[3] * f, 30);
  const std::int64_t first = c[1] + round_shift(second * f, 30);
  return narrow(c[0] + round_shift(first * f, 30));
}

/// position brought into [first, first + period) by whole periods. Exact where the verifier accepted the wrap
/// for the range of the position: the estimate of the number of periods is then at most one off. realtime.
inline std::int32_t wrapped(const Wrap& wrap, std::int32_t position) noexcept {
  const std::int64_t distance = std::int64_t{position} - wrap.first;
  const std::int64_t periods = (distance * wrap.reciprocal) >> wrap.shift;
  std::int64_t rest = distance - periods * wrap.period;
  rest += rest < 0 ? wrap.period : 0;
  rest -= rest >= wrap.period ? wrap.period : 0;
  return narrow(wrap.first + rest);
}

}  // namespace vernier
