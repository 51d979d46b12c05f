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
  double reading_um = 5;    // standard uncertainty of a coordinate that will be read
  double expected_um = 20;  // change of the tool point, rms over the poses, from which one wants to know
};

/// How small a change a check shows.
struct Shown {
  check::Suspect suspect;
  double change = 0;   // in its unit
  double tool_um = 0;  // what that moves the tool point by, rms over the work volume
};

/// A short measurement that sees the likeliest changes of a fitted machine.
struct CheckPlan {
  model::States states;      // in the order in which they are measured
  std::vector<Shown> shows;  // the one that has to move the tool furthest before it shows comes first
  std::vector<std::string> not_seen;
  double random_um = 0;  // the first of `shows`, from as many poses at random (median of several draws)
};

/// Chooses the poses one by one. Each pose raises most the sum over the tested parameters of log(1 +
/// information on a change that moves the tool point by `expected_um`), with a free set-up and the
/// uncertainty of the fit. A change is detected from five standard deviations on: evidence of 100 against
/// some thirty parameters of six sizes needs this. Throws InputError: never fitted, an axis without range.
/// tool.
CheckPlan check_plan(const model::Machine& machine, const CheckPlanOptions& options = {});

/// A measurement file with these rows, readings to be filled in.
std::string check_plan_csv(const model::Machine& machine, const CheckPlan& plan, double reading_um);

}  // namespace vernier::plan
