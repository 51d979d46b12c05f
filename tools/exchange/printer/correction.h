// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/exchange/left_out.h"
#include "tools/exchange/printer/bed_shape.h"
#include "tools/exchange/three_axes.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// A grid of heights over X and Y with bilinear interpolation between its points. Outside the grid, the
/// values at its edge are used.
struct HeightMesh {
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;
  Eigen::MatrixXd z;  // rows along Y, columns along X, mm; the height is added to the command of Z

  double at(double x, double y) const;
};

/// A skew or a step factor that the last fit did not measure: the correction has none. `um` is 0 if the
/// machine file has no value for it and the last fit no parameter.
struct UnmeasuredPart {
  std::string name;           // "XY", "XZ", "YZ" for a skew, "X", "Y", "Z" for steps
  double value = 0, std = 0;  // of the model, and its standard uncertainty because no reading determines it
  double um = 0;              // the larger of both over the travel, um
};

/// The corrections that the firmware of a 3D printer supports. The firmware applies them to a command in the
/// order skew, heights, steps per mm.
struct PrinterCorrection {
  /// Skew, which is added to the command: x += xy*y + xz*z, y += yz*z. The three skew values are tangents of
  /// angles.
  double xy = 0, xz = 0, yz = 0;
  HeightMesh mesh;
  /// Factors for the steps per mm of X, Y and Z.
  std::array<double, 3> steps{1, 1, 1};
  /// Lost motion of X, Y and Z at a reversal, mm; 0 for an axis without. The firmware moves this much further
  /// after a reversal.
  std::array<double, 3> lost_motion{};
  /// Skews and factors that stay 0 and 1, because the last fit did not measure them.
  std::vector<UnmeasuredPart> unmeasured;
  /// True if the last fit measured none of the three skews: the files then contain no skew.
  bool no_skew = false;

  /// True if the last fit measured this skew ("XY", "XZ", "YZ").
  bool measured(const std::string& skew) const;
  /// True if the files contain heights.
  bool has_mesh() const { return mesh.z.size() > 0; }
  /// True if the correction changes nothing.
  bool empty() const;
  /// Returns the corrected commands of X, Y and Z, one column for each command, mm.
  Eigen::Matrix3Xd corrected(const Eigen::Matrix3Xd& commands) const;
};

/// Parts of a correction that a firmware supports.
struct PrinterFeatures {
  bool skew = true, mesh = true;
  bool steps = false;               // true: the user states the present steps per mm
  bool lost_motion = false;         // true: the firmware has a command for the backlash of an axis
  bool size_known = true;           // false: the last fit says that no known length determines the size
  std::vector<std::size_t> points;  // numbers of mesh points per axis that are tested, in increasing order
};

/// The bed of a 3D printer: a plane that the nozzle or a probe touched, as the last fit estimated it.
struct Bed {
  std::string name;
  Eigen::Vector3d place_mm, normal;  // point and normal of the plane in workpiece coordinates
  /// Range of X and Y in which the bed was touched and the machine works, mm
  std::array<double, 2> low{}, high{};

  /// Shape of the bed from its touches; no value: the bed is the plane
  std::optional<BedShape> shape{};
  std::vector<BedTouch> touches{};  // the touches of the shape

  /// Returns the height of the bed at x and y of workpiece coordinates, mm.
  double height(double x, double y) const;
};

/// Returns the bed with the name `name` from the fit record of a machine. If the name is empty, the only
/// touched plane is returned; nullopt if the record contains no plane. Throws InputError if no plane has this
/// name, if there are several planes and no name, or if the plane is nearly vertical.
std::optional<Bed> bed_of(const model::Machine& machine, const ThreeAxes& axes, const std::string& name);

/// Returns a horizontal bed with the name `name` for touches that the last fit did not have. If the name is
/// empty, the only plane of unknown position that `rows` touch is the bed. Throws InputError if there is no
/// such plane, or if there are several.
Bed bed_of_touches(const model::Machine& machine, const ThreeAxes& axes, const model::Measurement& rows,
                   const std::string& name);

/// Gives the bed the shape of its touches `rows`. The mesh then covers the region of the touched points.
/// Throws InputError if the fit rows have fewer than three touches of this bed.
void give_shape(Bed& bed, const model::Machine& machine, const ThreeAxes& axes,
                const model::Measurement& rows);

/// Returns the correction of a machine. Skew and steps are fitted by least squares over the working volume;
/// the heights are computed at the lowest position of Z. The number of mesh points is the smallest number at
/// which the heights between the points are within tolerance_um, or the largest permitted number. `at` (one
/// state): values of inputs and motion. Offsets of the axes are not corrected, because homing determines
/// them. A skew or a factor whose standard uncertainty exceeds half of its value, because no reading
/// determines its parameters (`open` of the fit record), is not corrected: it is in `unmeasured`. A rotation
/// about Z is not corrected, because it rotates the whole part. The lost motion of an axis is the mean of its
/// reversal error over the working volume, if its whole standard uncertainty is at most half of it, and if
/// the axis falls short (a firmware does not shorten a move). If a bed is given, the
/// heights follow its slope, and the mesh covers the region in which the bed was touched. The mesh is 0 in
/// its middle; with the shape of the bed, its zero is that of the touches. `straight`: the machine of the
/// skews and steps, if it is not the machine of the heights. Its skews and steps then must meet the same
/// limit with their whole standard uncertainty.
PrinterCorrection printer_correction(const model::Machine& machine, const ThreeAxes& axes,
                                     const PrinterFeatures& features, const model::States& at,
                                     double tolerance_um, const std::optional<Bed>& bed = {},
                                     const model::Machine* straight = nullptr);

/// True if the last fit measured the heights of the axes: the part of their standard uncertainty that no
/// reading determines is at most half of the heights at the lowest Z, without a constant offset. False if the
/// machine has no error along Z there. True for a machine file without this part (`open`).
bool heights_are_measured(const model::Machine& machine, const ThreeAxes& axes, const model::States& at);

/// Heights of the touches without the files, and with them: rms without a constant offset, um. The touches
/// are those of the nozzle, if there are three or more, otherwise those of the probe.
struct TouchResidual {
  std::size_t touches = 0;
  bool of_nozzle = false;
  double before_um = 0, after_um = 0;

  bool worse() const { return after_um > before_um; }
};

/// Computes the heights at the touches of the bed in the region of the mesh, as the firmware sees them (with
/// straight axes). No value without a mesh, or with fewer than three touches.
std::optional<TouchResidual> touch_residual(const model::Machine& machine, const ThreeAxes& axes,
                                            const PrinterCorrection& correction, const model::States& at,
                                            const Bed& bed);

/// Errors of the tool point at positions in the whole volume, um. An offset and a rotation about Z are fitted
/// and removed. If a bed is given, the errors are those in the region of the bed, with heights relative to
/// the bed.
struct PrinterErrors {
  std::array<double, 3> before_um{}, after_um{};  // largest error in X, Y and Z
  double rms_before_um = 0, rms_after_um = 0;     // rms error of X, Y and Z together
  std::size_t positions = 0;
  /// Largest height error over the whole travel, um; 0 if no bed is given. Outside the mesh, the firmware
  /// uses the values at the edge of the mesh.
  double beyond_bed_um = 0;
};

/// Computes the errors with the chain at corrected commands, at 4096 positions between the points of the mesh
/// (fixed seed).
PrinterErrors printer_errors(const model::Machine& machine, const ThreeAxes& axes,
                             const PrinterCorrection& correction, const model::States& at,
                             const std::optional<Bed>& bed = {});

/// Returns the errors that inputs add (temperatures): the files hold the state `at`, and no file of a printer
/// depends on an input. One entry for each input and each end of its range with a change of 0.01 um or more:
/// the largest change of the error of the tool point from the state `at`, without a constant offset and a
/// rotation about Z. The range is that of the machine file, else that of the last fit, else 10 units on both
/// sides of the reference.
std::vector<LeftOut> errors_of_inputs(const model::Machine& machine, const ThreeAxes& axes,
                                      const PrinterCorrection& correction, const model::States& at,
                                      const std::optional<Bed>& bed);

}  // namespace vernier::exchange
