// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::plan {

struct TouchPlanOptions {
  std::size_t points = 40;   // touches, at most
  double reading_um = 5;     // standard uncertainty of one touch
  double expected_um = 100;  // by how much a parameter may plausibly move the tool point, rms over the volume
};

/// Poses at which the tool point touches one artefact of the machine file.
struct TouchPlan {
  model::States states;           // in the order in which they are measured
  Eigen::Vector3d place_mm;       // of the artefact, workpiece coordinates; of the file if it is known there
  bool place_is_assumed = false;  // the file does not know the place: the middle of the volume
  double before_um = 0, after_um = 0;  // expanded uncertainty of the tool point over the volume (k = 2)
  double least_um = 0;                 // from all touches that were looked at: lower limit of this artefact
  /// Parameters that no touch of this artefact determines; the plan does not change their uncertainty.
  std::vector<std::string> not_seen;
  bool has_length = false;  // linear axes that the file takes as true, or a known radius, give the size
};

/// Chooses one by one the touches that lower most the expected uncertainty of the tool point over the work
/// volume (I-optimal, as first_plan). The unknown values of the artefact are unknown in the plan, and a rigid
/// motion does not count. The touches are reached by the nominal chain from postures over the whole ranges.
/// Throws InputError: no artefact of this name, an axis without a range, no free parameter, no posture
/// touches the artefact.
TouchPlan touch_plan(const model::Machine& machine, const std::string& artefact,
                     const TouchPlanOptions& options = {});

/// Returns a text for users: the values that the touches determine, and the values that the touches do not
/// determine.
std::string touch_plan_text(const TouchPlan& plan, const std::string& artefact);
/// Returns a measurement file with the poses of the plan and the column `on`. The positions of the axes must
/// be replaced by those of the touch.
std::string touch_plan_csv(const model::Machine& machine, const TouchPlan& plan, const std::string& artefact,
                           double reading_um);

}  // namespace vernier::plan
