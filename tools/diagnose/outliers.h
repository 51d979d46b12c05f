// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/thresholds.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// A few readings far from all others, and the rest noise once their rows are left out and the machine is
/// fitted again: that is the instrument (a lost beam, a bumped target). The sentence that says so, with line
/// numbers; nothing where it is not so or where no uncertainty says what noise is. `of_all`: residual of the
/// machine's fit to all rows, mm or deg. tool.
std::optional<std::string> outliers_to_blame(const model::Machine& machine,
                                             const model::Measurement& measurement,
                                             const Eigen::VectorXd& of_all,
                                             const VerdictThresholds& thresholds);

/// The rows beside the gross outliers, and the sentence that says which were left out.
struct WithoutOutliers {
  std::vector<std::size_t> kept;
  std::string sentence;
};

/// Leaves out the rows with a reading far off what the effects found so far leave, up to a share of the rows;
/// nothing where there are none or more. `machine`, `of_all`: with
/// those effects. tool.
std::optional<WithoutOutliers> without_gross_outliers(const model::Machine& machine,
                                                      const model::Measurement& measurement,
                                                      const Eigen::VectorXd& of_all,
                                                      const VerdictThresholds& thresholds);

}  // namespace vernier::diagnose
