// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::safety {

/// One cause of deviation: a static away from nominal, a column of a table, a scale factor.
struct Source {
  std::string name;  // `alpha`, `table.X.rY`, `scalefactor.X`
  bool is_table = false;
  Eigen::Vector3d mean_mm =
      Eigen::Vector3d::Zero();            // of its separate effect on the tool point, over the states
  double rms_mm = 0, varying_rms_mm = 0;  // with and without the mean
};

/// Returns the effect of each source alone, with the other sources at nominal. Sources without effect are not
/// listed.
std::vector<Source> error_sources(const model::Machine& machine, const model::States& states);

/// True if the symbol is used anywhere in the chain (tables of an axis count).
bool acts(const model::Machine& machine, const model::Symbol& symbol);

}  // namespace vernier::safety
