// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/exchange/three_axes.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// A grid of heights over X and Y, bilinear between the points; the end values are used outside.
struct HeightMesh {
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;
  Eigen::MatrixXd z;  // rows along Y, columns along X, mm; added to the command of Z

  double at(double x, double y) const;
};

/// The correction that the firmware of a printer supports, in the order in which the firmware applies it to a
/// command: skew, then heights, then the steps per mm.
struct PrinterCorrection {
  /// Added: x += xy*y + xz*z, y += yz*z. Tangents of the angles.
  double xy = 0, xz = 0, yz = 0;
  HeightMesh mesh;
  /// Factors of the steps per mm of X, Y and Z.
  std::array<double, 3> steps{1, 1, 1};

  /// Commands of X, Y and Z, a column each, mm.
  Eigen::Matrix3Xd corrected(const Eigen::Matrix3Xd& commands) const;
};

/// Which parts a firmware has.
struct PrinterFeatures {
  bool skew = true, mesh = true;
  bool steps = false;               // the user states the present steps per mm
  std::vector<std::size_t> points;  // numbers of mesh points per axis that are tried, increasing
};

/// The bed of a printer: a plane that the nozzle or a probe touched, as the last fit estimated it.
struct Bed {
  std::string name;
  Eigen::Vector3d place_mm, normal;     // in workpiece coordinates
  std::array<double, 2> low{}, high{};  // of X and Y, where it was touched and the machine works, mm

  /// Height at x and y of workpiece coordinates, mm.
  double height(double x, double y) const;
};

/// Returns the bed of this name from the fit record of a machine. An empty name: the only touched plane, or
/// nullopt if the record has no plane. Throws InputError: no plane of this name, several planes without a
/// name, a plane that is nearly vertical.
std::optional<Bed> bed_of(const model::Machine& machine, const ThreeAxes& axes, const std::string& name);

/// Returns the correction of a machine, by least squares over the working volume for skew and steps, and at
/// the lowest position of Z for the heights. The number of points is the smallest one at which the heights
/// between them are within tolerance_um, or the largest one. `at` (count 1): inputs, motion. Offsets of the
/// axes are not corrected: homing sets them. A turn about Z is not corrected: it turns the part as a whole.
/// With a bed the heights follow its slope, and the mesh covers the region where the bed was touched.
PrinterCorrection printer_correction(const model::Machine& machine, const ThreeAxes& axes,
                                     const PrinterFeatures& features, const model::States& at,
                                     double tolerance_um, const std::optional<Bed>& bed = {});

/// Errors of the tool point at positions of the whole volume, without the offset and without the turn about
/// Z that fit them best, um. With a bed: of the region of the bed, and heights count from the bed.
struct PrinterErrors {
  std::array<double, 3> before_um{}, after_um{};  // largest of each direction
  double rms_before_um = 0, rms_after_um = 0;     // of the three directions together
  std::size_t positions = 0;
  /// Largest error of the height over the whole travel, um; 0 without a bed. Outside the mesh the firmware
  /// holds the end values.
  double beyond_bed_um = 0;
};

/// Evaluates the chain with the corrected commands at positions between the points of the mesh (4096, fixed
/// seed).
PrinterErrors printer_errors(const model::Machine& machine, const ThreeAxes& axes,
                             const PrinterCorrection& correction, const model::States& at,
                             const std::optional<Bed>& bed = {});

}  // namespace vernier::exchange
