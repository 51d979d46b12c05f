// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/part/surface/flank_path.h"

namespace vernier::part {

/// A point of the surface that the moving cutter produces. `normal` points out of the part; the outward
/// normal of the cutter at this point is -normal.
struct EnvelopePoint {
  Eigen::Vector3d position, normal;
};

/// Returns the point of the swept cylinder's envelope on the generatrix at height parameter `v`. The normal
/// of the envelope is perpendicular to the axis and to the velocity (tangency condition of sweeps, equation 5
/// of the paper). The velocity of the cutter per unit of u is dTip + h dR. The result of envelope_point() is
/// valid only where the cutter does not move along its own axis.
EnvelopePoint envelope_point(const FlankPose& pose, const Cutter& cutter, double v);

/// Returns the overcut by the paper's formula R (1 - |sin theta|), theta = atan2(-V.T, V.N), mm (equation 6,
/// reconstructed from the formula after it). The paper permits several interpretations of this formula; the
/// function uses one of them. The result of overcut_formula_mm() is not a distance along the normal, because
/// the paper's vector T(u,1) is not perpendicular to the tool axis.
double overcut_formula_mm(const FlankPose& pose, const Cutter& cutter, double v);

/// Returns the distance of the envelope point at (u, v) to the true surface, along the outward normal; a
/// negative value is overcut. The function envelope_distance_mm() returns 0 if the nearest point of the
/// surface is beyond an end of the part.
double envelope_distance_mm(const RuledSurface& surface, const Cutter& cutter, double u, double v,
                            NormalReading reading = {});

/// The largest value over 0 <= u <= 1, and the parameter u of this value.
struct Worst {
  double value_mm = 0, u = 0;
};

/// Returns the largest overcut by the paper's formula at `v`. Every knot of the curve is evaluated, because
/// the largest value may be a cusp at a knot. The largest of 40 samples in each span is refined within its
/// span to 1e-9 of u.
Worst worst_formula(const RuledSurface& surface, const Cutter& cutter, double v, NormalReading reading);

/// Returns the largest overcut as a positive distance, with the same search as worst_formula.
Worst worst_distance(const RuledSurface& surface, const Cutter& cutter, double v, NormalReading reading = {});

}  // namespace vernier::part
