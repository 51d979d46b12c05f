// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine.h"

namespace vernier::importer {

/// Place of the measured point on the tool.
enum class ToolPlace {
  kOfTheMachine,  // the tool point of the machine file
  kUnknown,       // found with the rigid motion: a reflector
};

/// Returns the measured points of a table (columns x y z), mm; nullopt: a coordinate is missing.
std::optional<Eigen::Matrix3Xd> measured_points(const ImportTable& table);

/// Returns the poses of the nominal machine. `table`: with a position of every axis of the machine in each
/// row. Throws InputError for an empty cell of an axis.
model::Poses nominal_poses(const ImportTable& table, const model::Machine& machine);

/// Returns for each point the index of its pose, where points are missing: both are in the order of the
/// measurement, and the distances between points agree with those between poses. A reflector at an unknown
/// place is found on the way. `points`: mm, in the frame of the instrument; `tolerance_mm`: permitted
/// difference of a distance, machine against nominal machine. Empty: a point agrees with no pose.
std::vector<std::size_t> poses_in_order(const model::Poses& nominal, const Eigen::Matrix3Xd& points,
                                        ToolPlace place, double tolerance_mm);

/// Returns the distance of each measured point (columns x y z) from the tool point of the nominal machine,
/// mm, after the best rigid motion of all points. `table`: with a position of every axis of the machine in
/// each row. Empty: a coordinate is missing, or the points determine no rigid motion. Throws InputError for
/// an empty cell of an axis.
Eigen::VectorXd distances_from_nominal(const ImportTable& table, const model::Machine& machine,
                                       ToolPlace place);

}  // namespace vernier::importer
