// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/reading_direction.h"

#include "tools/model/chain/chain_rows.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

Eigen::Matrix3d measuring_frame(const model::Machine& machine, const model::Measurement& rows,
                                std::size_t row) {
  const auto shift = model::base_shift_of(
      machine, rows.states.names(rows.states.setup)[rows.states.of(rows.states.setup, row)]);
  if (!shift) return Eigen::Matrix3d::Identity();
  return model::sixdof_frame(machine.base_shifts[*shift].value).rotation;
}

Eigen::Vector3d reading_direction(const model::Machine& machine, const model::Measurement& rows,
                                  const model::Observation& reading) {
  const auto row = static_cast<Eigen::Index>(reading.row);
  if (reading.kind <= model::ObservationKind::kZ)
    return measuring_frame(machine, rows, reading.row).transpose() *
           Eigen::Vector3d::Unit(static_cast<Eigen::Index>(reading.kind));
  if (reading.kind == model::ObservationKind::kD)
    return {rows.states.normal[0][row], rows.states.normal[1][row], rows.states.normal[2][row]};
  if (reading.kind >= model::ObservationKind::kSameX && reading.kind <= model::ObservationKind::kSameZ)
    return Eigen::Vector3d::Unit(static_cast<Eigen::Index>(format::component_of(reading.kind)));
  return Eigen::Vector3d::Zero();
}

}  // namespace vernier::fit
