// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/fit/types.h"

namespace vernier::fit {

/// A parameter that the readings do not determine and that the convention sets.
struct Decision {
  std::vector<std::string> parameters;  // a table's column has one name: `table.Z.rX`
  double reach_um =
      0;  // possible motion of the tool at the edge of the measured box, one standard uncertainty
  std::string sentence;
};

/// Returns the decisions of the convention, largest reach first, at most `most`. Set-ups are
/// excluded, because the position of the measuring frame is not an error of the machine.
std::vector<Decision> decisions_of(const FitResult& result, std::size_t most = 10);

/// Says why a fit did not converge: the number of readings and of parameters; the combination of parameters
/// along which the last step still moved; the combinations that the readings do not determine; what to do.
/// step: the last step in units of each scale, empty if it was small. readings: of the fit rows, without
/// those that only determine touched objects. Parts are separated by semicolons, without a final point.
std::string blame_of(const FitResult& result, const Eigen::VectorXd& step, std::size_t readings);

}  // namespace vernier::fit
