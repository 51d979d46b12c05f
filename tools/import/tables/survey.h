// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>

#include "tools/import/tables/column_map.h"

namespace vernier::importer {

/// Converts a tracker's table to a measurement. Positions x y z are imported unchanged. The orientation
/// becomes the rotation vector rx ry rz in deg. Input: fixed order angles rX rY rZ (Rx*Ry*Rz, as a sixdof
/// transform), or a quaternion qw qx qy qz. Throws InputError: an orientation with a missing or repeated
/// part, a quaternion whose length is not 1 within 1e-3, no measured column.
void finish_tracker(ImportTable& table);

/// Finishes a table of poses of a board as camera software gives them: x y z and an orientation in one of the
/// forms of finish_tracker(). on_tool: the tool carries the camera; the columns become bx by bz brx bry brz,
/// the pose of the board in the frame of the camera. Else the tool carries the board and the camera is fixed:
/// x y z rx ry rz, as a tracker reads them. Throws InputError without a complete position.
void finish_camera(ImportTable& table, bool on_tool);

/// Converts a table of touches to a measurement. A column d is imported as d; otherwise d = n * (m - p) with
/// the recorded point mx my mz. nx ny nz (scaled to length 1, within 1e-3) and the nominal point px py pz are
/// required. All points are in workpiece coordinates. `radius_mm`: radius of the stylus ball, if the recorded
/// point is the centre of the ball and the nominal point is on the surface. The nominal point then moves out
/// along the normal. Throws InputError.
void finish_probe(ImportTable& table, double radius_mm);

/// Gives every `every`-th row the role check, the other rows the role fit. Throws InputError if the table has
/// roles already.
void set_roles(ImportTable& table, std::size_t every);

/// Returns the rotation vector (deg) of the angles of a sixdof transform (deg) and of a quaternion w x y z.
Eigen::Vector3d rotation_vector_of_angles(const std::array<double, 3>& angles_deg);
Eigen::Vector3d rotation_vector_of_quaternion(const std::array<double, 4>& wxyz);

}  // namespace vernier::importer
