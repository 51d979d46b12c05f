// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>

#include "tools/import/columns/column_map.h"

namespace vernier::importer {

/// Converts the table of a laser tracker to a measurement. The positions x y z of a tracker are imported
/// unchanged. An orientation is converted to the rotation vector rx ry rz in deg. The orientation may be
/// given as fixed order angles rX rY rZ (Rx*Ry*Rz, as in a sixdof transform), or as a quaternion qw qx qy qz.
/// Throws InputError for: an orientation with a missing or repeated component, a quaternion whose length is
/// not 1 within 1e-3, a table without a measured column.
void finish_tracker(ImportTable& table);

/// Converts a table with poses of a board from camera software to a measurement. The columns are x y z and an
/// orientation in one of the forms of finish_tracker(). `on_tool` = true: the tool carries the
/// camera. If the tool carries the camera, the columns become bx by bz brx bry brz, the pose of the
/// board in the camera frame. `on_tool` = false: the tool carries the board, and the camera is
/// fixed. If the camera is fixed, the columns are x y z rx ry rz, as for a tracker. Throws
/// InputError if the table has no complete position.
void finish_camera(ImportTable& table, bool on_tool);

/// Converts a table of touches of a probe to a measurement. A column d (deviation along the normal)
/// is imported without change. Without a column d, the reading is d = n * (m - p) with the recorded
/// point mx my mz; then the normal nx ny nz (scaled to length 1, within 1e-3) and the nominal point
/// px py pz are required. All points of the touches are in workpiece coordinates. `radius_mm`:
/// radius of the stylus ball. The radius is not zero if the recorded point is the centre of the
/// ball and the nominal point is on the surface. The nominal point is then moved along the normal
/// by this radius, out of the surface. Throws InputError if a required column is missing or not
/// valid.
void finish_probe(ImportTable& table, double radius_mm);

/// Assigns the role check to each row whose number is a multiple of `every`, and the role fit to the other
/// rows. Throws InputError if the table already has roles.
void set_roles(ImportTable& table, std::size_t every);

/// Returns the rotation vector (deg) of the fixed order angles of a sixdof transform (deg), or of a
/// quaternion w x y z.
Eigen::Vector3d rotation_vector_of_angles(const std::array<double, 3>& angles_deg);
Eigen::Vector3d rotation_vector_of_quaternion(const std::array<double, 4>& wxyz);

}  // namespace vernier::importer
