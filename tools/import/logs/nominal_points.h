// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/import/columns/column_map.h"
#include "tools/model/machine.h"

namespace vernier::importer {

/// Place of the measured point on the tool.
enum class ToolPlace {
  kOfTheMachine,  // the tool point of the machine file
  kUnknown,       // found with the rigid motion: a reflector
};

/// Returns the distance of each measured point (columns x y z) from the tool point of the nominal machine,
/// mm, after the best rigid motion of all points. `table`: with a position of every axis of the machine in
/// each row. Empty: a coordinate is missing, or the points determine no rigid motion. Throws InputError for
/// an empty cell of an axis.
Eigen::VectorXd distances_from_nominal(const ImportTable& table, const model::Machine& machine,
                                       ToolPlace place);

}  // namespace vernier::importer
