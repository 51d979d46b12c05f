// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/create/dh_table.h"

namespace vernier::create {

/// Description of an axis by the user: name, travel, and the direction along which it moves (X Y Z) or about
/// which it rotates (A B C).
struct PlannedAxis {
  std::string name;
  double min = 0, max = 0;  // mm or deg
  char direction = 'X';
  bool rollover = false;           // true: the axis rotates without limit, and its range is one turn
  std::array<double, 3> centre{};  // centre of a rotary axis with all other axes at zero, mm
  std::string joint{};             // name of the joint in the URDF, if it is no name of an axis
  std::vector<double> stations{};  // stations of the table as the user states them; empty: round_stations
  bool rotary() const { return direction >= 'A' && direction <= 'C'; }
  /// Returns the index of the direction: 0, 1, 2 for X, Y, Z, and also for A, B, C.
  std::size_t along() const { return static_cast<std::size_t>(direction - (rotary() ? 'A' : 'X')); }
};

/// An object that the tool point touches, without known values: name and type of an <artefact>.
struct PlannedArtefact {
  std::string name, type;
};

/// Content of a new machine file. The lists of axes on both sides begin at the bed. The last axes of both
/// lists carry the tool and the workpiece.
struct MachinePlan {
  std::string type, name;
  std::vector<PlannedAxis> axes;                  // in the order of the machine file
  std::vector<std::size_t> tool_side, work_side;  // indices of the axes
  /// Position of the tool in the frame of the last axis on the tool side, mm
  std::array<double, 3> tool{};
  std::vector<DhRow> arm;  // rows of a robot, one row for each joint; empty for other
                           // machines
  /// End link of the URDF of a robot, and its frame in the frame of the last row: T(X,Y,Z)·Rx·Ry·Rz, mm, deg
  std::string link{};
  std::array<double, 6> link_frame{};
  /// BaseShift: base of the chain in the measuring frame, mm and deg
  std::array<double, 6> base{};
  /// True if only errors are free in a fit that an instrument along each axis can measure. If only such
  /// errors are free, squareness, straightness and angles stay 0.
  bool positioning_only = false;
  /// True if only errors are free that the distances of a printed square show: the squareness of Y to X, and
  /// the scales of X and Y. All other errors stay 0.
  bool square_only = false;
  std::vector<PlannedArtefact> artefacts;
  /// True if the readings are those of a reflector at an unknown place on the tool: <ToolShift/>, which is a
  /// part of the set-up.
  bool reflector = false;
};

/// The line of a machine file that declares the unknown place of a reflector on the tool, within <static>.
inline constexpr const char* kReflectorLine =
    "      <ToolShift/> <!-- unknown place of the reflector on the tool, estimated by the fit -->\n";

/// A type of machine for which the command `new` has a default chain.
struct MachineType {
  const char* name;
  const char* title;
  const char* tool_side;  // directions of the axes from the bed to the tool, "YXZ"; directions without an
                          // axis are omitted
  const char* work_side;
  std::array<const char*, 3> slides;  // names of the slides X, Y and Z
};

/// Returns the machine types of `vernier new`, including the robot.
const std::vector<MachineType>& machine_types();

/// Reads an axis from a text: "X:0:600", "U:0:300:X" (along X), "C:0:360:wrap". Throws InputError with the
/// wrong word.
PlannedAxis parse_planned_axis(const std::string& words);

/// Gives an axis the stations of a text: "X=25" (a step, in mm or deg) or "X=0,50,130,600" (positions). The
/// ends of the travel are stations too. Throws InputError for an unknown axis, a step that is not positive,
/// positions that do not increase or are outside the travel, or more than 2000 stations. Returns the axis.
PlannedAxis& plan_stations(std::vector<PlannedAxis>& axes, const std::string& words);

/// Returns the stations of the table of an axis.
std::vector<double> stations_of(const PlannedAxis& axis);

/// Reads an artefact from a text: "bed:plane". Throws InputError if the name or a known type is missing.
PlannedArtefact parse_planned_artefact(const std::string& words);

/// Assigns the axes to the tool side and the workpiece side by the rule of the machine type. `tool_order`,
/// `work_order`: names of the axes from the bed outwards, if their order differs from that of the type.
/// Throws InputError if the type is unknown (with the reason for a delta machine), if there is no axis, if a
/// name occurs twice, or if an axis is assigned to neither side.
MachinePlan plan_machine(const std::string& type, std::vector<PlannedAxis> axes,
                         const std::optional<std::vector<std::string>>& tool_order,
                         const std::optional<std::vector<std::string>>& work_order);

/// Returns the plan of a robot from its joint rows and the same number of axes. If `axes` is empty, the axes
/// are J1, J2 … with ±180 deg, or 0 to 500 mm for a prismatic joint. Throws InputError if the numbers of rows
/// and axes differ.
MachinePlan plan_robot(std::vector<PlannedAxis> axes, const std::vector<DhRow>& rows);

/// Returns positions for the stations of a table. The station positions are round numbers that divide a range
/// into four to seven parts.
std::vector<double> round_stations(double min, double max, bool rotary);

}  // namespace vernier::create
