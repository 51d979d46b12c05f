// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "comp/error_table.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/compile/symbolic/graph.h"
#include "tools/compile/types.h"

namespace vernier::compile {

/// Returns a segment between two integer positions. Multiplication by the reciprocal of the segment gives
/// exactly 1 at its far end.
Segment make_segment(std::int64_t start, std::int64_t end);

/// Returns the segments between consecutive positions (strictly increasing, at least two positions).
std::vector<Segment> make_segments(const std::vector<std::int64_t>& positions);

/// Returns a table from its segments and the coefficients of each column. For each segment there are degree +
/// 1 coefficients. The table has a grid (direct index) if its stations are evenly spaced.
LoweredTable make_table(const std::string& name, const std::vector<Segment>& segments, std::uint16_t degree,
                        const std::vector<std::vector<std::int32_t>>& columns);

/// Returns a wrap (rollover) of `period` counts from `first`, in the form that comp/verify.h accepts.
/// `period`: 4 to 2^31 - 1 counts.
Wrap make_wrap(std::int64_t first, std::int64_t period);

/// A smooth function as cubic polynomials, one per segment, over the whole range of a register.
struct FunctionPieces {
  std::vector<Segment> segments;
  std::vector<std::int32_t> coefficients;  // four coefficients per segment, in the format of the result
  int fraction_bits = 0;                   // fraction bits of the result
  double error = 0;                        // error bound: interpolation (4th derivative) + quantisation +
                                           // rounding
  double slope = 0;                        // largest |derivative| of the function
};

/// `low`, `high`: counts of the argument's register, both reachable; `argument_bits`: fraction bits of the
/// argument. The length of a segment is halved until the 4th-derivative bound h^4/384 * max|f''''| (de Boor,
/// cubic Hermite) is below 2^-26 of the result's magnitude.
FunctionPieces make_pieces(Function f, std::int64_t low, std::int64_t high, int argument_bits);

/// Coefficients of one cubic polynomial of a FunctionPieces. The coefficients are computed from the values
/// and slopes at both ends of the segment (slopes per unit of fraction).
struct CubicPiece {
  double c[4];
};
CubicPiece hermite(double near, double far, double near_slope, double far_slope);

}  // namespace vernier::compile
