// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// The end link of the URDF from which a machine file was made: attributes `link` and `frame` of
/// <transforms>.
struct TipLink {
  std::string name;
  Eigen::Isometry3d frame;  // frame of the link in the frame of the last row, mm
};

/// Returns the end link of a machine file; no value without the attribute. `text`: the machine file, valid.
std::optional<TipLink> tip_link(const std::string& text);

/// Returns the machine with the tool point at the reflector of its ToolShift, which becomes 0: a running
/// correction acts at the tool point, and readings of the reflector judge it there only. No value without a
/// ToolShift of all rows, or with a ToolShift of single runs.
std::optional<model::Machine> with_tool_point_at_reflector(const model::Machine& machine);

/// Returns the end link of a URDF that was written without an original: its frame is the last row of the
/// machine file, with the origin at the tool point.
TipLink tool_link(const model::Machine& machine, const std::string& name);

/// Returns a sentence for each ToolShift of a machine: its place in the frame of a link, mm. `urdf`: the URDF
/// that has the link.
std::vector<std::string> tool_shift_places(const model::Machine& machine, const TipLink& link,
                                           const std::string& urdf);

/// Returns these sentences with the end link of the machine file. A machine file without the name of a link:
/// one sentence that names the frame of ToolShift. Empty without ToolShift.
std::vector<std::string> tool_shift_places(const model::Machine& machine, const std::string& text);

}  // namespace vernier::exchange
