// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/error_table.h"

// Interpolation of three tables together, in vectors of 256 bits, for a processor that has them (a build with
// -march=x86-64-v3). Without such vectors the interpolation of one table after another needs fewer
// instructions: SSE2 has no signed product, no shift by lanes and no smaller of two values.
#if defined(__AVX2__) && defined(__GNUC__)
#define VERNIER_THREE_TABLES 1

namespace vernier {

constexpr unsigned kThreeColumns = 6;  // columns of each table

/// Three linear tables of six columns and evenly spaced stations, in lanes of 64 bits. The fourth lane
/// repeats the third. The tables must exist longer than their ThreeTables.
struct ThreeTables {
  std::int64_t first[4], multiplier[4], shift[4], last[4], records[4];
};
constexpr std::size_t kThreeWords = sizeof(ThreeTables) / sizeof(std::int64_t);

/// True if the table can be one of three tables.
constexpr bool may_be_of_three(const ErrorTable& table) noexcept {
  return table.degree == 1 && table.columns == kThreeColumns && table.grid_multiplier != 0;
}

inline ThreeTables three_tables(const ErrorTable& a, const ErrorTable& b, const ErrorTable& c) noexcept {
  ThreeTables three;
  const ErrorTable* const tables[4] = {&a, &b, &c, &c};
  for (int i = 0; i < 4; ++i) {
    const ErrorTable& table = *tables[i];
    three.first[i] = table.records[0];
    three.multiplier[i] = table.grid_multiplier;
    three.shift[i] = table.grid_shift;
    three.last[i] = table.pieces - 1;
    three.records[i] = reinterpret_cast<std::intptr_t>(table.records);
  }
  return three;
}

namespace lanes {

using Int4 = std::int64_t __attribute__((vector_size(32)));
using Unsigned4 = std::uint64_t __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Unsigned8 = std::uint32_t __attribute__((vector_size(32)));
using Int2 = std::int64_t __attribute__((vector_size(16)));
using Half = std::int32_t __attribute__((vector_size(16)));

template <class Vector>
inline Vector loaded(const void* from) noexcept {
  Vector v;
  __builtin_memcpy(&v, from, sizeof(v));
  return v;
}
// Products of the low halves of the lanes: exact, 64 bits.
inline Unsigned4 product_unsigned(Unsigned4 a, Unsigned4 b) noexcept {
  return (Unsigned4)__builtin_ia32_pmuludq256((Int8)a, (Int8)b);
}
inline Int4 product_signed(Int4 a, Int4 b) noexcept {
  return (Int4)__builtin_ia32_pmuldq256((Int8)a, (Int8)b);
}

/// Values of four columns in the low halves of the lanes: linear_between().
inline Int8 four_columns(const std::int32_t* c, Int4 fraction) noexcept {
  const auto pairs = loaded<Unsigned4>(c);
  const Int4 rise = product_signed((Int4)(pairs >> 32), fraction) + (std::int64_t{1} << 29);
  return (Int8)((Unsigned4)rise >> 30) + (Int8)pairs;
}

/// Values of six columns, to `out`.
template <class Value>
inline void six_columns(const std::int32_t* c, Int4 fraction, Value* out) noexcept {
  const Int8 near = four_columns(c, fraction);
  // The last four columns: two of the first four again.
  const Int8 far = four_columns(c + 4, fraction);
  const Half head = __builtin_shufflevector(near, near, 0, 2, 4, 6);
  const Half tail = __builtin_shufflevector(far, far, 0, 2, 4, 6);
  if constexpr (sizeof(Value) == sizeof(std::int32_t)) {
    __builtin_memcpy(out, &head, sizeof(head));
    __builtin_memcpy(out + 2, &tail, sizeof(tail));
  } else {
    const Int4 wide_head = __builtin_convertvector(head, Int4),
               wide_tail = __builtin_convertvector(tail, Int4);
    __builtin_memcpy(out, &wide_head, sizeof(wide_head));
    __builtin_memcpy(out + 2, &wide_tail, sizeof(wide_tail));
  }
}

}  // namespace lanes

/// Interpolates three tables like look_up<1, 6>, with the same bits. `three`: a ThreeTables; `position`: one
/// position a lane; `out`: 18 values, table after table. Real-time safe.
template <class Value>
inline void look_up_three(const void* three, lanes::Int4 position, Value* out) noexcept {
  using namespace lanes;
  const auto word = [three](std::size_t offset) {
    return loaded<Unsigned4>(static_cast<const char*>(three) + offset);
  };
  // Only the low halves of the lanes count: a difference and a comparison of 32 bits each.
  const Int8 first = (Int8)word(offsetof(ThreeTables, first));
  const Int8 given = (Int8)position;
  const Int8 held = given > first ? given : first;
  const Unsigned4 found =
      product_unsigned((Unsigned4)(held - first), word(offsetof(ThreeTables, multiplier))) >>
      word(offsetof(ThreeTables, shift));
  const auto last = (Unsigned8)word(offsetof(ThreeTables, last));
  const auto piece = (Unsigned4)((Unsigned8)found < last ? (Unsigned8)found : last);
  const Unsigned4 at =
      piece * (4 * (kSegmentWords + 2 * kThreeColumns)) + word(offsetof(ThreeTables, records));
  const std::int32_t* const record[3] = {reinterpret_cast<const std::int32_t*>(at[0]),
                                         reinterpret_cast<const std::int32_t*>(at[1]),
                                         reinterpret_cast<const std::int32_t*>(at[2])};
  // Start and length of the three segments, then reciprocal and shift.
  const auto a = loaded<Int2>(record[0]), b = loaded<Int2>(record[1]), c = loaded<Int2>(record[2]);
  const Int2 near = __builtin_shufflevector(a, b, 0, 2), far = __builtin_shufflevector(a, b, 1, 3);
  const auto ends = (Unsigned4)__builtin_shufflevector(near, c, 0, 1, 2, 2);
  const auto factors = (Unsigned4)__builtin_shufflevector(far, c, 0, 1, 3, 3);
  const auto distance = (Unsigned8)(held - (Int8)ends);
  const auto length = (Unsigned8)(ends >> 32);
  const auto inside = (Unsigned4)(distance < length ? distance : length);
  const auto fraction = (Int4)(product_unsigned(inside, factors) >> (factors >> 32));
  six_columns(record[0] + kSegmentWords, __builtin_shufflevector(fraction, fraction, 0, 0, 0, 0), out);
  six_columns(record[1] + kSegmentWords, __builtin_shufflevector(fraction, fraction, 1, 1, 1, 1), out + 6);
  six_columns(record[2] + kSegmentWords, __builtin_shufflevector(fraction, fraction, 2, 2, 2, 2), out + 12);
}

}  // namespace vernier

#else
#define VERNIER_THREE_TABLES 0
#endif
