#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier {

/// A few readings far from all others, and the rest noise once their rows are left out and the machine is
/// fitted again: that is the instrument (a lost beam, a bumped target). The sentence that says so, with line
/// numbers; nothing where it is not so or where no uncertainty says what noise is. `of_all`: residual of the
/// machine's fit to all rows, mm or deg. tool.
std::optional<std::string> outliers_to_blame(const Machine& machine, const Measurement& measurement,
                                             const Eigen::VectorXd& of_all);

/// Measurement without its gross outliers, and the sentence that says which.
struct WithoutOutliers {
  Measurement rows;
  std::string sentence;
};

/// Leaves out up to a hundredth of the rows (one at least) that lie so far off that they hide what the others
/// show; nothing where there are none. tool.
std::optional<WithoutOutliers> without_gross_outliers(const Machine& machine, const Measurement& measurement,
                                                      const Eigen::VectorXd& of_all);

}  // namespace vernier
