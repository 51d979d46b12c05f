// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>

#include "tools/compile/walk.h"

namespace vernier::compile {

/// Number of poses over the declared ranges at which a determinant is evaluated, and of boxes into which the
/// ranges are divided for a bound. A larger number of poses or boxes changes the damping by less than a
/// tenth.
inline constexpr Eigen::Index kSamples = 512;
inline constexpr std::size_t kBoxes = 4096;  // see the line above
/// If a determinant is smaller than this share of its largest sampled value, the correction decreases to 0.
inline constexpr double kFloorShare = 1.0 / 256;

/// The span of the columns of some axes over the declared ranges, from samples.
struct Span {
  int rank = 0;             // of all directions together: 3 if the axes reach every direction somewhere
  bool everywhere = false;  // no sampled pose has a lower rank
  Eigen::Matrix3Xd basis;   // 3 x rank, orthonormal
};
Span span_of(const Derivation& derivation, const std::vector<AxisColumn>& columns);

/// Solution x of J(q) x = v: a value for each output. For least squares, Solved also has the intermediate
/// values.
struct Solved {
  std::vector<NodeId> values;
  std::vector<NodeId> components, weights;  // as LeastSquares::deviation and ::weights
};
/// Solves J(q) x = v for any vector v in the frame of the deviation. The graph argument is the graph of the
/// derivation.
using Solver = std::function<Solved(Graph&, const NodeVector& v)>;

/// Solves J(q) x = deviation (derivation.columns, derivation.deviation) for the deviation along each axis and
/// enters the outputs. If the directions of the axes are constant, solve_axes uses numbers. If a 3 x 3 J(q)
/// is proved regular over the declared ranges, solve_axes uses its inverse. Otherwise solve_axes minimises
/// the squares of the motions, J' (J J')^-1. If there are fewer axes than directions that they reach
/// anywhere, solve_axes minimises the squares of the residual, (J'J)^-1 J'. The determinant has a lower
/// limit, so that the correction decreases to 0 where the axes no longer reach every direction. The solver is
/// also used for a second evaluation of the deviation.
Solver solve_axes(Derivation& derivation);

}  // namespace vernier::compile
