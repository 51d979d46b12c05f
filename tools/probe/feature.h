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

/// Data that are known before the fit of a feature.
struct FeatureSetup {
  FeatureKind kind = FeatureKind::kPlane;
  double ball_radius_mm = 0;  // effective; points are centres of the ball
  bool inside = false;        // touched from inside (circle, sphere, cylinder), if the rows have no normals
  std::array<double, 2> block_size_mm = {0, 0};  // along its own X and Y
  double outlier_level = 0.01;
  std::optional<double> expansion_per_K =
      std::nullopt;  // of the workpiece; if given, sizes are those at 20 degC
  std::optional<double> temperature_degC = std::nullopt;  // of all rows, if there is no column T
  double expansion_std_per_K = 1e-6, temperature_std_K = 0.1;
};

/// A feature fitted to touches: orthogonal least squares.
struct MeasuredFeature {
  TouchFit fit;
  std::vector<Calibrated> parameters;  // in the order of its kind, mm and deg; size and form last
  double form_mm = 0;                  // range of the kept residuals
  Eigen::MatrixXd points,
      normals;                // per touch: centre of the ball (at 20 degC if that is known), surface normal
  Eigen::VectorXd deviation;  // of the touch along its normal from the fitted feature, mm
  std::vector<std::string> findings;

  const Calibrated* find(const std::string& name) const { return find_calibrated(parameters, name); }
};

/// Columns: x, y, z (z not needed for line, circle and block in the plane z = 0), nx ny nz
/// (outward normals; for a block: of the touched face), T[degC], u[mm]. If the touches have no normals, plane
/// and line pass through the centres of the stylus ball.
///
/// parameters: plane: point (nearest to the centroid), normal, tilt about x and y; line: point, direction,
/// angle (deg from X, in the plane); circle, sphere, cylinder: centre (for a cylinder nearest to the
/// centroid; and axis), radius; block: centre, angle. A block needs two or more points on a face across X and
/// on a face across Y. The centre of the block is half its size inside both faces, along their common angle.
/// Throws InputError.
MeasuredFeature fit_feature(TouchTable& table, const FeatureSetup& setup);

/// Returns the touches as a measurement file: `d` along `nx ny nz` from the fitted feature at `px
/// py pz` (FORMATS section 2). The other columns are unchanged, without the recorded point.
std::string feature_csv(const TouchTable& table, const MeasuredFeature& feature);

}  // namespace vernier::probe
