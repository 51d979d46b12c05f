// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::plan {

struct FirstPlanOptions {
  /// Expanded uncertainty (k = 2) of the tool point over the work volume at which the plan ends,
  /// um; no value: that of one reading.
  std::optional<double> accuracy_um;
  double reading_um = 5;      // standard uncertainty of a coordinate of the planned readings
  double expected_um = 100;   // plausible motion of the tool point by a parameter, rms over the volume
  std::size_t most = 400;     // poses
  double check_share = 0.15;  // share of additional poses that only test the fit
};

/// Poses for the first measurement of a machine.
struct FirstPlan {
  model::States states;                // in the order in which they are measured
  std::vector<char> check;             // role of each
  std::size_t references = 0;          // of them: repeats of the first pose, which show a drift
  double before_um = 0, after_um = 0;  // expanded uncertainty over the volume, without and with the fit poses
  double random_um = 0;                // the same from the same number of random poses
  double least_um = 0;  // from all poses that could be chosen: the lower limit of such readings
  bool reached = true;  // the requested accuracy
};

/// Selects the poses one by one. Each lowers most the expected uncertainty of the tool point over
/// the work volume and all its tools (I-optimal, without exchange: Fedorov 1972, 2.5), for the
/// parameters that the machine file frees. A motion of the whole belongs to the set-up and is
/// ignored. The poses are measured in the order of a path through the axes' travels, with repeats
/// of the first pose and check poses in between. Throws InputError for an axis without a range, or
/// without free parameters. tool.
FirstPlan first_plan(const model::Machine& machine, const FirstPlanOptions& options = {});

/// Returns the expanded uncertainty (k = 2) of the tool point over the work volume, um, after
/// readings at any poses, by the same definition as `after_um`. tool.
double planned_uncertainty_um(const model::Machine& machine, const model::States& poses,
                              const FirstPlanOptions& options = {});

/// Returns a measurement file with these rows. The readings must be filled in.
std::string first_plan_csv(const model::Machine& machine, const FirstPlan& plan, double reading_um);

}  // namespace vernier::plan
