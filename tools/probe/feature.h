// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/probe/calibration.h"
#include "tools/probe/touch_fit.h"
#include "tools/probe/touch_table.h"

namespace vernier::probe {

enum class FeatureKind { kPlane, kLine, kCircle, kSphere, kCylinder, kBlock };

/// Data that are known before a feature is fitted.
struct FeatureSetup {
  FeatureKind kind = FeatureKind::kPlane;
  double ball_radius_mm = 0;  // effective radius of the stylus ball; the points are centres of the ball
  bool inside = false;        // true: the feature is touched from inside (circle, sphere, cylinder); used if
                              // the rows have no normals
  std::array<double, 2> block_size_mm = {0, 0};  // size of the block along its own X and Y
  double outlier_level = 0.01;
  std::optional<double> expansion_per_K =
      std::nullopt;  // expansion coefficient of the workpiece; if it is given, sizes are those at 20 degC
  std::optional<double> temperature_degC = std::nullopt;  // temperature of all rows if the table has no
                                                          // column T
  double expansion_std_per_K = 1e-6, temperature_std_K = 0.1;
};

/// A feature that is fitted to touches by orthogonal least squares.
struct MeasuredFeature {
  TouchFit fit;
  std::vector<Calibrated> parameters;  // in the order for this kind of feature, mm and deg; size and form are
                                       // last
  double form_mm = 0;                  // range of the residuals of all touches that were not excluded
  Eigen::MatrixXd points,
      normals;                // one row per touch: centre of the ball (at 20 degC if the temperature is
                              // known), and normal of the surface
  Eigen::VectorXd deviation;  // distance of each touch from the fitted feature along its normal, mm
  std::vector<std::string> findings;

  const Calibrated* find(const std::string& name) const { return find_calibrated(parameters, name); }
};

/// Fits a feature to touches. The columns are x, y, z (z is not needed for a line, circle or block in the
/// plane z = 0), nx ny nz (outward normals; for a block, of the touched face), T[degC], u[mm]. If the touches
/// have no normals, a fitted plane or line passes through the centres of the stylus ball.
///
/// Parameters by kind. Plane: point (nearest to the centroid), normal, tilt about x and y. Line: point,
/// direction, angle (deg from X, in the plane). Circle, sphere, cylinder: centre (for a cylinder the point
/// nearest to the centroid, and the axis), radius. Block: centre, angle. A block needs at least two points on
/// a face across X, and at least two points on a face across Y. The centre of the block is half of its size
/// inside both faces, along their common angle. Throws InputError if the touches do not determine the
/// feature.
MeasuredFeature fit_feature(TouchTable& table, const FeatureSetup& setup);

/// Returns the touches as the text of a measurement file: `d` along `nx ny nz` from the fitted feature at `px
/// py pz` (FORMATS section 2). All other columns are unchanged, except that the recorded point is not
/// written to the measurement file.
std::string feature_csv(const TouchTable& table, const MeasuredFeature& feature);

}  // namespace vernier::probe
