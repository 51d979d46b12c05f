// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/rebind.h"

#include <cmath>

namespace vernier::model {

Measurement rebind(const Measurement& measurement, const Machine& from, const Machine& to) {
  Measurement result = measurement;
  result.states.input.clear();
  std::vector<char> empty(measurement.rows(), 0);
  std::vector<char> used(measurement.candidates.size(), 0);
  for (const Input& input : to.inputs) {
    if (const auto known = from.find_input(input.name)) {
      result.states.input.push_back(measurement.states.input[*known]);
      continue;
    }
    Column column = Column::Constant(static_cast<Eigen::Index>(measurement.rows()), input.reference);
    for (std::size_t i = 0; i < measurement.candidates.size(); ++i) {
      if (measurement.candidates[i].name != input.name) continue;
      column = measurement.candidates[i].value;
      used[i] = 1;
      for (std::size_t row = 0; row < measurement.rows(); ++row)
        if (!std::isfinite(column[static_cast<Eigen::Index>(row)])) empty[row] = 1;
    }
    result.states.input.push_back(column);
  }
  result.candidates.clear();
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] == 0) result.candidates.push_back(measurement.candidates[i]);
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < measurement.rows(); ++row)
    if (empty[row] == 0) keep.push_back(row);
  if (keep.size() == measurement.rows()) return result;
  const std::size_t excluded = measurement.excluded + measurement.rows() - keep.size();
  result = select_rows(result, keep);
  result.excluded = excluded;
  return result;
}

}  // namespace vernier::model
