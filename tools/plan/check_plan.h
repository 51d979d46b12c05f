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
  double reading_um = 5;    // standard uncertainty of a coordinate of the planned readings
  double expected_um = 20;  // smallest relevant change of the tool point, rms over the poses
};

/// The smallest change that a check detects.
struct Shown {
  check::CheckedQuantity quantity;
  double change = 0;   // in its unit
  double tool_um = 0;  // motion of the tool point by it, rms over the work volume
};

/// A short measurement that shows the most probable changes of a fitted machine.
struct CheckPlan {
  model::States states;               // in the order in which they are measured
  std::vector<Shown> shows;           // the change with the largest motion of the tool comes first
  std::vector<std::string> not_seen;  // not identifiable: no motion of the tool, or that of another set-up
  double random_um =
      0;  // the first of `shows`, from the same number of random poses (median of several samples)
};

/// Chooses the poses one by one. Each new pose gives the largest increase of the sum of log(1 + information)
/// over the tested parameters. The information is about a change that moves the tool point by `expected_um`,
/// with a free set-up and the uncertainty of the fit. A change is detected from five standard deviations on:
/// an evidence of 100 with about thirty parameters of six sizes needs this. Throws InputError: never fitted,
/// an axis without range.
CheckPlan check_plan(const model::Machine& machine, const CheckPlanOptions& options = {});

/// Returns a text for users about the changes that the poses can detect: the largest changes, the number of
/// the other changes, and the parameters that are not identifiable.
std::string check_plan_text(const CheckPlan& plan, double reading_um);
/// Returns a measurement file with the poses of the plan. The readings must be filled in.
std::string check_plan_csv(const model::Machine& machine, const CheckPlan& plan, double reading_um);

}  // namespace vernier::plan
