// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "comp/error_table.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/compile/symbolic/graph.h"
#include "tools/compile/types.h"

namespace vernier::compile {

/// Returns a segment between two integer positions. The reciprocal of the segment gives exactly 1 at the far
/// end.
Segment make_segment(std::int64_t start, std::int64_t end);

/// Segments between consecutive positions (strictly increasing, at least two).
std::vector<Segment> make_segments(const std::vector<std::int64_t>& positions);

/// Returns a table from its segments and the coefficients of each column, piece after piece (degree + 1
/// coefficients per piece). The table has a grid if its stations are evenly spaced.
LoweredTable make_table(const std::string& name, const std::vector<Segment>& segments, std::uint16_t degree,
                        const std::vector<std::vector<std::int32_t>>& columns);

/// Returns a wrap of `period` counts from `first` that comp/verify.h accepts. period: 4 .. 2^31 -
/// 1.
Wrap make_wrap(std::int64_t first, std::int64_t period);

/// A smooth function as cubic pieces over the whole range of a register.
struct FunctionPieces {
  std::vector<Segment> segments;
  std::vector<std::int32_t> coefficients;  // four per segment, in the result's format
  int fraction_bits = 0;                   // of the result
  double error = 0;                        // bound: interpolation (4th derivative) + quantisation + rounding
  double slope = 0;                        // largest |derivative|
};

/// low, high: counts of the argument's register, both reachable; argument_bits: fraction bits of the
/// argument. Piece lengths halve until the 4th-derivative bound h^4/384 * max|f''''| (de Boor, cubic Hermite)
/// is below 2^-26 of the result's magnitude.
FunctionPieces make_pieces(Function f, std::int64_t low, std::int64_t high, int argument_bits);

/// Value, slopes and their quantised form of one cubic piece. Computed from the end values and end slopes
/// (per unit of fraction).
struct CubicPiece {
  double c[4];
};
CubicPiece hermite(double near, double far, double near_slope, double far_slope);

}  // namespace vernier::compile
