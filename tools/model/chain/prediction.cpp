// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/prediction.h"

#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/linearizer.h"
#include "tools/model/chain/observation_model.h"

namespace vernier::model {

Eigen::VectorXd predict(const Machine& machine, const Measurement& m) {
  const ChainRows chain(machine, m.states);
  std::vector<const BaseShift*> shifts;
  for (const std::string& run : m.states.names(m.states.setup)) {
    const auto found = base_shift_of(machine, run);
    shifts.push_back(found ? &machine.base_shifts[*found] : nullptr);
  }
  Eigen::VectorXd predicted(static_cast<Eigen::Index>(m.observations.size()));
  for (std::size_t k = 0; k < m.observations.size();) {
    const std::size_t row = m.observations[k].row;
    const Frame pose = chain.pose(row);
    ObservationModel model(m, machine.gravity, shifts[m.states.of(m.states.setup, row)], pose);
    if (const std::size_t other = m.other_end.empty() ? kNoRow : m.other_end[row]; other != kNoRow) {
      const Frame there = chain.pose(other);
      model.set_other_end(
          ObservationModel(m, machine.gravity, shifts[m.states.of(m.states.setup, other)], there).point());
    }
    for (; k < m.observations.size() && m.observations[k].row == row; ++k)
      predicted[static_cast<Eigen::Index>(k)] = model.predicted(m.observations[k]);
  }
  return predicted;
}

Linearisation linearise(const Machine& machine, const Measurement& m, const ParameterSet& parameters) {
  return linearise(machine, Linearizer(machine, m, parameters), m.observations.size(), parameters.size());
}

Linearisation linearise(const Machine& machine, const Linearizer& linearizer, std::size_t observations,
                        std::size_t parameters) {
  Linearisation result;
  result.predicted.resize(static_cast<Eigen::Index>(observations));
  std::vector<int> outer{0}, columns;
  std::vector<double> values;
  linearizer.each_row(machine, [&](const RowLinear& row) {
    for (Eigen::Index o = 0; o < row.predicted.size(); ++o) {
      result.predicted[static_cast<Eigen::Index>(row.first_observation) + o] = row.predicted[o];
      for (const ParameterGroup& group : row.groups)
        for (const auto& [first, weight] : group.first_weight)
          for (Eigen::Index k = 0; k < group.width; ++k) {
            columns.push_back(static_cast<int>(first + k));
            values.push_back(weight * row.gradient(group.slot + k, o));
          }
      outer.push_back(static_cast<int>(columns.size()));
    }
  });
  result.jacobian = Eigen::Map<const SparseRows>(
      static_cast<Eigen::Index>(observations), static_cast<Eigen::Index>(parameters),
      static_cast<Eigen::Index>(columns.size()), outer.data(), columns.data(), values.data());
  return result;
}

}  // namespace vernier::model
