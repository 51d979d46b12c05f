// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns true if the fit rows determine a bow of the axes over a touched plane separately from a bow of the
/// plane itself. Touches of planes of unknown position do not determine this bow. All other readings count as
/// far as they read along the normal of the plane: they must determine the three second-order terms of the
/// height over the touched region, beside an unknown height and tilt for each set-up and an unknown height
/// for each touched object. A distance between two points of the same height reads nothing along the normal.
/// `plane`: name of the artefact. `normal`: its unit normal in workpiece coordinates.
bool bow_is_read(const model::Machine& machine, const model::Measurement& rows, const std::string& plane,
                 const Eigen::Vector3d& normal);

}  // namespace vernier::fit
