// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::plan {

struct TouchPlanOptions {
  std::size_t points = 40;   // largest number of touches
  double reading_um = 5;     // standard uncertainty of one touch
  double expected_um = 100;  // plausible motion of the tool point by one parameter, rms over the volume
};

/// Poses at which the tool point touches one artefact of the machine file.
struct TouchPlan {
  model::States states;           // poses in the order in which they are measured
  Eigen::Vector3d place_mm;       // position of the artefact in workpiece coordinates; from the machine file
                                  // if the file states it
  bool place_is_assumed = false;  // true: the file does not state the position, so that the middle of the
                                  // volume is assumed
  double before_um = 0, after_um = 0;  // expanded uncertainty of the tool point over the volume (k = 2),
                                       // without and with the touches
  double least_um = 0;                 // lower limit for this artefact: expanded uncertainty with all tested
                                       // touches
  /// Parameters that no touch of this artefact determines; the plan does not change their uncertainty.
  std::vector<std::string> not_seen;
  bool has_length = false;  // true: the size is determined by linear axes whose scale is fixed in the file,
                            // or by a known radius
};

/// Selects touches, one after another. Each touch is the one that most reduces the expected uncertainty of
/// the tool point over the work volume (I-optimal, as first_plan). The plan treats the unknown values of the
/// artefact as unknown. A rigid motion of the machine does not count. The postures for the touches are
/// computed with the nominal chain, over the whole ranges of the axes. Throws InputError if there is no
/// artefact of this name, an axis has no range, no parameter is free, or no posture touches the artefact.
TouchPlan touch_plan(const model::Machine& machine, const std::string& artefact,
                     const TouchPlanOptions& options = {});

/// Returns a text for users about the parameters that the touches determine, and the parameters that they do
/// not determine.
std::string touch_plan_text(const TouchPlan& plan, const std::string& artefact);
/// Returns a measurement file with the poses of the plan and the column `on`. The user must replace the axis
/// positions in the file by those of the actual touch.
std::string touch_plan_csv(const model::Machine& machine, const TouchPlan& plan, const std::string& artefact,
                           double reading_um);

}  // namespace vernier::plan
