// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/fixed.h"

namespace vernier {

/// The number 1 in the format of a fraction of a segment (Q30). In the format Q30, the fraction 1
/// is the far end of the segment.
constexpr std::int32_t kFractionOne = std::int32_t{1} << 30;

/// The interval between two neighbouring stations of a table, in counts of the position's register. The ends
/// of a segment are stations. Station i is the start of segment i, and the last station is the end of the
/// last segment.
struct Segment {
  std::int32_t start;    // position of the station at the near end
  std::uint32_t length;  // distance to the next station, > 0
  std::uint32_t
      reciprocal;       // ceil(2^(30 + shift) / length): converts a distance to a fraction without a division
  std::uint32_t shift;  // 0..33
};

static_assert(sizeof(Segment) == 16);
static_assert(offsetof(Segment, start) == 0 && offsetof(Segment, length) == 4 &&
              offsetof(Segment, reciprocal) == 8 && offsetof(Segment, shift) == 12);
constexpr std::uint32_t kSegmentWords = 4;

/// Period of a periodic axis. Before the interpolation, a position is changed by whole periods into [first,
/// first + period).
struct Wrap {
  std::int32_t first;
  std::int32_t period;      // > 0
  std::int32_t reciprocal;  // about 2^shift / period
  std::uint32_t shift;      // 0..61
};
static_assert(sizeof(Wrap) == 16);
static_assert(offsetof(Wrap, first) == 0 && offsetof(Wrap, period) == 4 && offsetof(Wrap, reciprocal) == 8 &&
              offsetof(Wrap, shift) == 12);

/// Errors of one axis as functions of its position. The functions are polynomials between the stations. The
/// coefficients of all columns of a segment are adjacent in memory, so that an interpolation reads one or two
/// cache lines. The ErrorTable does not own its memory.
///
/// A record of a segment contains the four words of its Segment, and then the coefficients of each column in
/// the format of the column, for increasing powers of the fraction. With degree 1 a column has two
/// coefficients (value at the near station, change to the far station); with degree 3 a column has
/// four. Station i is the start of segment i, and the last station is the end of the last segment.
/// Before the first station, the table gives the value of the first station. After the last
/// station, the table gives the value of the last station.
struct ErrorTable {
  const std::int32_t* records = nullptr;
  std::uint32_t pieces = 0;   // > 0
  std::uint16_t columns = 0;  // > 0
  std::uint16_t degree = 1;   // 1 or 3
  // If the stations are evenly spaced, the index of the segment is distance * grid_multiplier >> grid_shift.
  // If grid_multiplier is 0, the stations are not evenly spaced, and the segment is found by bisection.
  std::uint32_t grid_multiplier = 0;
  std::uint32_t grid_shift = 0;  // 0..63

  constexpr std::uint32_t stride() const noexcept { return kSegmentWords + columns * (degree + 1u); }
  constexpr const std::int32_t* record(std::uint32_t piece) const noexcept {
    return records + std::size_t{piece} * stride();
  }
};

/// Returns the Segment at the beginning of a record. Real-time safe.
constexpr Segment segment_at(const std::int32_t* record) noexcept {
  return {record[0], static_cast<std::uint32_t>(record[1]), static_cast<std::uint32_t>(record[2]),
          static_cast<std::uint32_t>(record[3])};
}

/// Returns the index of the segment of an evenly spaced table. The index may be wrong within one count beyond
/// a station, where both segments have the same value. A segment that starts beyond the position is never
/// returned. Beyond the last station, grid_piece returns the last segment. `position`: at or after the first
/// station. The function grid_piece needs one multiplication. Real-time safe.
constexpr std::uint32_t grid_piece(const ErrorTable& table, std::int32_t position) noexcept {
  const std::uint64_t inside =
      static_cast<std::uint32_t>(position) - static_cast<std::uint32_t>(table.records[0]);
  const std::uint64_t piece = (inside * table.grid_multiplier) >> table.grid_shift;
  return static_cast<std::uint32_t>(lower<std::uint64_t>(piece, table.pieces - 1));
}

/// Returns the same index as piece_of(), by a bisection without branches. Real-time safe.
constexpr std::uint32_t searched_piece(const ErrorTable& table, std::int32_t position) noexcept {
  std::uint32_t base = 0;
  for (std::uint32_t count = table.pieces; count > 1;) {
    const std::uint32_t half = count / 2;
    base += position >= table.record(base + half)[0] ? half : 0;
    count -= half;
  }
  return base;
}

/// Returns the index of the segment that contains `position`; beyond the last station, the last segment.
/// `position`: at or after the first station. The computing time of piece_of depends only on the table, not
/// on the position: one multiplication for evenly spaced stations, otherwise a bisection without branches.
/// Real-time safe.
constexpr std::uint32_t piece_of(const ErrorTable& table, std::int32_t position) noexcept {
  return table.grid_multiplier != 0 ? grid_piece(table, position) : searched_piece(table, position);
}

/// Returns the position within the segment as a fraction 0..kFractionOne (Q30). Beyond the end of the
/// segment, the fraction is limited to 1. `position`: at or after the start of the segment. fraction_in
/// truncates: the error is below 2^-30 + 2^-31 of the segment, and zero at both ends. (The verifier rejects a
/// reciprocal that does not give 1 at the far end.) Real-time safe.
constexpr std::int64_t fraction_in(const Segment& segment, std::int32_t position) noexcept {
  const std::uint32_t distance =
      static_cast<std::uint32_t>(position) - static_cast<std::uint32_t>(segment.start);
  const std::uint64_t inside = lower(distance, segment.length);
  return static_cast<std::int64_t>((inside * segment.reciprocal) >> segment.shift);
}

/// Returns the value between two stations: near + fraction * rise with c = {near, rise}. The interpolated
/// value is rounded once, ties up (<= 1/2 LSB of the column). The interpolated value is between the values of
/// both stations; the product is below 2^62. Real-time safe.
constexpr std::int32_t linear_between(const std::int32_t* c, std::int64_t fraction) noexcept {
  return c[0] + narrow(round_shift(c[1] * fraction, 30));
}

/// Returns the value of the cubic polynomial c[0] + f (c[1] + f (c[2] + f c[3])). In this polynomial, f is
/// the fraction (Q30), and all values have the format of the column. The inner two products are truncated and
/// the last product is rounded. The error is between -5/2 and +1/2 LSB. Every partial sum of the cubic
/// polynomial is below 2^31 (proved by the verifier). Real-time safe.
constexpr std::int32_t cubic_between(const std::int32_t* c, std::int64_t fraction) noexcept {
  const std::int32_t second = c[2] + narrow((c[3] * fraction) >> 30);
  const std::int32_t first = c[1] + narrow((second * fraction) >> 30);
  return c[0] + narrow(round_shift(first * fraction, 30));
}

/// Computes the values of kColumns columns of one record. piece_values is recursive, so that the compiler
/// removes the loop. Real-time safe.
template <unsigned kDegree, unsigned kColumns, class Value>
constexpr void piece_values(const std::int32_t* c, std::int64_t fraction, Value* out) noexcept {
  static_assert(kDegree == 1 || kDegree == 3);
  *out = kDegree == 1 ? linear_between(c, fraction) : cubic_between(c, fraction);
  if constexpr (kColumns > 1) piece_values<kDegree, kColumns - 1>(c + kDegree + 1, fraction, out + 1);
}

/// Interpolates all columns of a table in the segment `piece`. `held`: position, at or after the start of the
/// segment. Real-time safe.
template <unsigned kDegree, unsigned kColumns, class Value>
inline void piece_look_up(const ErrorTable& table, std::uint32_t piece, std::int32_t held,
                          Value* out) noexcept {
  const std::int32_t* const record =
      table.records + std::size_t{piece} * (kSegmentWords + kColumns * (kDegree + 1));
  piece_values<kDegree, kColumns>(record + kSegmentWords, fraction_in(segment_at(record), held), out);
}

/// Interpolates all columns of a table at `position`. The table must have the degree kDegree and kColumns
/// columns. `out`: kColumns values, each in the format of its column. The error is at most 1/2 LSB of the
/// column (linear) or 5/2 LSB (cubic), plus 2^-29 of the change in the segment because of the fraction.
/// Real-time safe.
template <unsigned kDegree, unsigned kColumns, class Value>
inline void look_up(const ErrorTable& table, std::int32_t position, Value* out) noexcept {
  const std::int32_t held = higher(position, table.records[0]);
  piece_look_up<kDegree, kColumns>(table, piece_of(table, held), held, out);
}

/// Interpolates like look_up<kDegree, kColumns>, with the degree and number of columns read from the table at
/// run time. Both forms of look_up() give identical values. Real-time safe.
template <class Value>
inline void look_up(const ErrorTable& table, std::int32_t position, Value* out) noexcept {
  const std::int32_t held = higher(position, table.records[0]);
  const std::int32_t* const record = table.record(piece_of(table, held));
  const std::int64_t fraction = fraction_in(segment_at(record), held);
  const std::int32_t* c = record + kSegmentWords;
  const std::int32_t* const end = record + table.stride();
  if (table.degree == 1) {
    for (; c != end; c += 2) *out++ = linear_between(c, fraction);
  } else {
    for (; c != end; c += 4) *out++ = cubic_between(c, fraction);
  }
}

/// Returns the position changed by whole periods into [first, first + period). wrapped() is exact if the
/// verifier accepted the wrap for the range of the position. If the verifier accepted the wrap, the
/// estimated number of periods has an error of at most 1. Real-time safe.
inline std::int32_t wrapped(const Wrap& wrap, std::int32_t position) noexcept {
  const std::int64_t distance = std::int64_t{position} - wrap.first;
  const std::int64_t periods = (distance * wrap.reciprocal) >> wrap.shift;
  std::int64_t rest = distance - periods * wrap.period;
  rest += rest < 0 ? wrap.period : 0;
  rest -= rest >= wrap.period ? wrap.period : 0;
  return narrow(wrap.first + rest);
}

}  // namespace vernier
