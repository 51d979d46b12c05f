// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/order/motion_directions.h"

#include <cmath>
#include <cstddef>

namespace vernier::importer {
namespace {

bool same_run(const std::vector<std::string>& runs, std::size_t i) {
  return runs.empty() || runs[i] == runs[i - 1];
}

}  // namespace

std::vector<int> directions_by_motion(const std::vector<double>& positions,
                                      const std::vector<std::string>& runs) {
  std::vector<int> direction(positions.size(), 0);
  int next = 0;
  for (std::size_t i = positions.size(); i-- > 0;) {
    if (i + 1 < positions.size() && !same_run(runs, i + 1)) next = 0;
    if (i > 0 && same_run(runs, i) && positions[i] != positions[i - 1])
      next = positions[i] > positions[i - 1] ? 1 : -1;
    direction[i] = next;
  }
  for (std::size_t i = 1; i < positions.size(); ++i)
    if (direction[i] == 0 && same_run(runs, i)) direction[i] = direction[i - 1];
  return direction;
}

std::vector<int> directions_of_last_motion(const std::vector<double>& positions,
                                           const std::vector<std::string>& runs, double still) {
  std::vector<int> direction(positions.size(), 0);
  for (std::size_t i = 1; i < positions.size(); ++i) {
    if (!same_run(runs, i)) continue;
    const double step = positions[i] - positions[i - 1];
    direction[i] = !(std::abs(step) > still) ? direction[i - 1] : step > 0 ? 1 : -1;
  }
  return direction;
}

}  // namespace vernier::importer
