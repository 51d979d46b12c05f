// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/fit/types.h"

namespace vernier::fit {

/// A parameter that the readings do not determine. The convention (a prior at nominal) sets the
/// value of a parameter that the readings do not determine.
struct Decision {
  std::vector<std::string> parameters;  // names of the parameters; a column of a table has one name:
                                        // `table.Z.rX`
  double reach_um =
      0;  // possible motion of the tool at the edge of the measured box, one standard uncertainty
  std::string sentence;
};

/// Returns at most `most` parameters that the convention sets, the largest possible motion of the tool
/// (`reach_um`) first. Set-ups are excluded from the result, because the position of the measuring frame is
/// not an error of the machine.
std::vector<Decision> decisions_of(const FitResult& result, std::size_t most = 10);

/// Returns the reason why a fit did not converge: the number of readings and of parameters, the combination
/// of parameters that still changed in the last step, the combinations that the readings do not determine,
/// and what to do. `step`: the last step of the fit, in units of each parameter's scale; empty if this step
/// was small. `readings`: number of readings of the fit rows. Readings that determine only touched objects
/// are not counted. Semicolons separate the parts of the reason, and the reason has no full stop at
/// the end.
std::string blame_of(const FitResult& result, const Eigen::VectorXd& step, std::size_t readings);

}  // namespace vernier::fit
