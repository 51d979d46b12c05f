// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/evidence_of_change.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::plan {

struct CheckPlanOptions {
  std::size_t points = 10;
  double reading_um = 5;    // standard uncertainty of one coordinate of the planned readings
  double expected_um = 20;  // smallest relevant change of the tool point, rms over the poses
};

/// The smallest change of one checked quantity that a check detects.
struct Shown {
  check::CheckedQuantity quantity;
  double change = 0;   // size of the change, in the unit of the quantity
  double tool_um = 0;  // motion of the tool point by this change, rms over the work volume
};

/// A short measurement that shows the most probable changes of a fitted machine.
struct CheckPlan {
  model::States states;               // poses in the order in which they are measured
  std::vector<Shown> shows;           // detected changes; the change with the largest motion of the tool is
                                      // first
  std::vector<std::string> not_seen;  // quantities that the poses cannot show: they do not move the tool, or
                                      // have the same effect as another set-up
  double random_um = 0;  // tool_um of the first element of `shows` with the same number of random poses
                         // (median of several samples)
};

/// Selects the poses of a check, one after another. Each new pose is the one with the largest increase of the
/// sum of log(1 + information) over the checked parameters. The information is about a change that moves the
/// tool point by `expected_um`. The information of a pose allows for a free set-up and for the uncertainty
/// of the last fit. A change counts as detected from five standard deviations. The limit of five standard
/// deviations follows from an evidence of 100, with about thirty parameters of six sizes. Throws InputError
/// if the machine was never fitted or an axis has no range.
CheckPlan check_plan(const model::Machine& machine, const CheckPlanOptions& options = {});

/// Returns a text for users about the changes that the poses can detect: the largest changes, the number of
/// other changes, and the parameters that cannot be identified.
std::string check_plan_text(const CheckPlan& plan, double reading_um);
/// Returns a measurement file with the poses of the plan. The user must enter the readings in this file.
std::string check_plan_csv(const model::Machine& machine, const CheckPlan& plan, double reading_um);

}  // namespace vernier::plan
