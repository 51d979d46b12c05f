// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/part/surface/flank_path.h"

namespace vernier::part {

/// A point of the surface that the moving cutter leaves, and the cutter's normal at the point (outwards from
/// the cutter's axis the normal is
/// -normal: `normal` points out of the part).
struct EnvelopePoint {
  Eigen::Vector3d position, normal;
};

/// Returns the characteristic point of the swept cylinder on the generatrix at `v`. The normal of the
/// envelope is perpendicular to the axis and to the velocity (tangency condition of sweeps, equation 5 of the
/// paper). The velocity by u is dTip + h dR. The result is valid only where the motion is not along the axis.
EnvelopePoint envelope_point(const FlankPose& pose, const Cutter& cutter, double v);

/// Returns the paper's overcut R (1 - |sin theta|), theta = atan2(-V.T, V.N) (equation 6, recovered from the
/// formula that follows it), mm. The function uses one of several interpretations of the formula. The result
/// is no normal distance, because the paper's vector T(u,1) is not perpendicular to the tool axis.
double overcut_formula_mm(const FlankPose& pose, const Cutter& cutter, double v);

/// Returns the distance of the envelope point of u at `v` to the true surface, along its outward normal;
/// negative is overcut. 0 if the nearest point is beyond an end of the part.
double envelope_distance_mm(const RuledSurface& surface, const Cutter& cutter, double u, double v,
                            NormalReading reading = {});

/// The largest value over 0 <= u <= 1, and the u of this value.
struct Worst {
  double value_mm = 0, u = 0;
};

/// Returns the largest overcut by the paper's formula at `v`. Every knot is evaluated (the largest value may
/// be a cusp at a knot). The largest of 40 samples per span is refined within its span to 1e-9 of u.
Worst worst_formula(const RuledSurface& surface, const Cutter& cutter, double v, NormalReading reading);

/// Returns the largest overcut as a distance (positive), with the same search as worst_formula.
Worst worst_distance(const RuledSurface& surface, const Cutter& cutter, double v, NormalReading reading = {});

}  // namespace vernier::part
