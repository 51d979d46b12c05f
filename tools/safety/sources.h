// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::safety {

/// One source of deviations: a static that differs from nominal, a column of a table, or a scale factor.
struct Source {
  std::string name;  // `alpha`, `table.X.rY`, `scalefactor.X`
  bool is_table = false;
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();  // mean effect of this source alone on the tool point,
                                                      // over all states
  double rms_mm = 0, varying_rms_mm = 0;              // rms effect with the mean, and without the mean
};

/// Returns the effect of each source alone. All other sources are at nominal. A source without effect is not
/// in the result.
std::vector<Source> error_sources(const model::Machine& machine, const model::States& states);

/// True if the chain uses the symbol (the tables of an axis count as use).
bool acts(const model::Machine& machine, const model::Symbol& symbol);

}  // namespace vernier::safety
