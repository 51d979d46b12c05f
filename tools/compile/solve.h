// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>

#include "tools/compile/walk.h"

namespace vernier::compile {

/// Number of poses over the declared ranges at which a determinant is sampled. kBoxes is the number of boxes
/// into which the ranges are divided for a bound. A larger number of poses or boxes changes the damping by
/// less than a tenth.
inline constexpr Eigen::Index kSamples = 512;
inline constexpr std::size_t kBoxes = 4096;  // number of boxes for a bound
/// Limit for a determinant, as a share of its largest sampled value. If the determinant is below the limit,
/// the correction decreases to 0.
inline constexpr double kFloorShare = 1.0 / 256;

/// The space that the motions of some axes span over the declared ranges, from samples.
struct Span {
  int rank = 0;             // rank of all directions together: 3 if the axes reach every direction at some
                            // pose
  bool everywhere = false;  // true: no sampled pose has a lower rank
  Eigen::Matrix3Xd basis;   // orthonormal basis of the space, 3 x rank
};
Span span_of(const Derivation& derivation, const std::vector<AxisColumn>& columns);

/// Solution x of J(q) x = v: one value for each output. For least squares, Solved also contains the
/// intermediate values.
struct Solved {
  std::vector<NodeId> values;
  std::vector<NodeId> components, weights;  // as LeastSquares::deviation and LeastSquares::weights
};
/// Solves J(q) x = v for any vector v in the frame of the deviation. The graph argument of a Solver is the
/// graph of the derivation.
using Solver = std::function<Solved(Graph&, const NodeVector& v)>;

/// Solves J(q) x = deviation for the motion of each axis and stores the outputs. J(q) and the deviation are
/// derivation.columns and derivation.deviation. If the directions of the axes are constant, solve_axes
/// computes the solution with numbers. If a 3 x 3 J(q) is proved regular over the declared ranges, solve_axes
/// uses its inverse. If J(q) is not proved regular, solve_axes minimises the sum of squares of the motions,
/// J' (J J')^-1. If there are fewer axes than directions that the axes reach at some pose, solve_axes
/// minimises the sum of squares of the residual, (J'J)^-1 J'. The determinant in the solution for the axis
/// motions has a lower limit. Where the axes no longer reach every direction, the correction therefore
/// decreases to 0. The returned Solver is also used for a second evaluation of the deviation.
Solver solve_axes(Derivation& derivation);

}  // namespace vernier::compile
