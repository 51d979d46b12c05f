// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>

#include "tools/compile/walk.h"

namespace vernier::compile {

/// Poses over the declared ranges at which a determinant is looked at, and boxes into which they are cut
/// where a bound is wanted: more change the damping by less than a tenth.
inline constexpr Eigen::Index kSamples = 512;
inline constexpr std::size_t kBoxes = 4096;  // as the line above says
/// Where a determinant is below this share of its largest sampled value, the correction fades.
inline constexpr double kFloorShare = 1.0 / 256;

/// What the columns of some axes span over the declared ranges, as sampled.
struct Span {
  int rank = 0;             // of all directions together: 3 where the axes reach every direction somewhere
  bool everywhere = false;  // no sampled pose has a lower rank
  Eigen::Matrix3Xd basis;   // 3 x rank, orthonormal
};
Span span_of(const Derivation& derivation, const std::vector<AxisColumn>& columns);

/// x with J(q) x = v: a value for each output; of least squares what they came from too.
struct Solved {
  std::vector<NodeId> values;
  std::vector<NodeId> components, weights;  // as LeastSquares::deviation and ::weights
};
/// The same of any vector v in the frame of the deviation. The graph is that of the derivation.
using Solver = std::function<Solved(Graph&, const NodeVector& v)>;

/// Solves J(q) x = deviation (derivation.columns, derivation.deviation) for the deviation along each axis and
/// enters the outputs: by numbers where the directions are constant; by the inverse of a 3 x 3 J(q) that is
/// proved regular over the declared ranges; else by the least squares of the motions, J' (J J')^-1, or of
/// what is left, (J'J)^-1 J', where the axes are fewer than the directions that they reach anywhere. The
/// determinant is held at a floor, so that the correction fades where the axes no longer reach every
/// direction. The solver serves a second evaluation of the deviation. tool.
Solver solve_axes(Derivation& derivation);

}  // namespace vernier::compile
