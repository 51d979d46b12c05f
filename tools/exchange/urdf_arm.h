// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/exchange/undetermined_joints.h"
#include "tools/exchange/urdf_original.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// A robot arm in the format URDF (wiki.ros.org/urdf/XML), and the difference between the URDF model and the
/// machine.
struct UrdfFile {
  std::string text;
  double worst_um = 0, worst_urad = 0;  // largest difference of the tool point, and of the tool direction
  double rms_um = 0;                    // rms difference of the tool point: what URDF leaves out
  /// Rms difference of the nominal arm from the machine, with the base and the tool point of the best fit
  double rms_nominal_um = 0;
  std::size_t positions = 0;  // number of positions at which the differences were computed
  bool measured = false;      // true if these positions are in the measured ranges of the fit
  std::vector<UndeterminedJoint> undetermined;  // joints that the readings of the fit do not determine
  std::optional<CalibratedOriginal> original;   // with an original URDF: its tip and its tool point
};

/// The end link of a URDF that was written without an original.
inline constexpr const char* kToolLink = "tool";

/// Returns the URDF model of an arm with one joint for each axis. The links are base_link, one link for each
/// axis, and tool. With the joints at zero, or in the middle of a range that does not contain zero, each
/// frame of the URDF model is parallel to the base. URDF has ideal joints. The origins and axes of the joints
/// and the tool are therefore fitted to the machine: least squares of the tool point and of the rotation of
/// the tool (with a lever of 100 mm), at 1000 poses in the measured ranges of the axes (without a fit: in the
/// ranges of the axes). The start of the fit are the origins and axes about which (or along which) the chain
/// moves, one joint after another. Errors that depend on joints, inputs or direction then remain only in
/// part. `joints`: name of the joint of each axis; empty: the names of the axes. The differences of the
/// result are those at 1000 other poses in the same ranges (fixed seeds). `at` (one state): values of inputs
/// and motion. `original`: if not null, the text of the result is the original with the calibrated origins.
/// Throws InputError if an axis moves the workpiece, or if an axis moves no transform.
UrdfFile urdf_arm(const model::Machine& machine, const model::States& at,
                  const std::vector<std::string>& joints = {}, const UrdfOriginal* original = nullptr);

/// Returns the names of the joints in the URDF from which a machine file was made (attribute `joint` of an
/// axis): one name for each axis, that of the axis if it has no such attribute. `text`: the machine file.
std::vector<std::string> joint_names(const model::Machine& machine, const std::string& text);

}  // namespace vernier::exchange
