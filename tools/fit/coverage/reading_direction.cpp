// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/reading_direction.h"

#include <Eigen/Geometry>

#include "tools/maths/factors.h"
#include "tools/model/parameters.h"

namespace vernier::fit {
namespace {

/// Measuring frame <- workpiece of a row's set-up: Rx Ry Rz, FORMATS section 1.
Eigen::Matrix3d frame_of(const model::Machine& machine, const model::Measurement& m, std::size_t row) {
  const auto shift =
      model::base_shift_of(machine, m.states.names(m.states.setup)[m.states.of(m.states.setup, row)]);
  if (!shift) return Eigen::Matrix3d::Identity();
  const auto& value = machine.base_shifts[*shift].value;
  return (Eigen::AngleAxisd(maths::kRadPerDeg * value[3], Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(maths::kRadPerDeg * value[4], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(maths::kRadPerDeg * value[5], Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

}  // namespace

Eigen::Vector3d reading_direction(const model::Machine& machine, const model::Measurement& rows,
                                  const model::Observation& reading) {
  const auto row = static_cast<Eigen::Index>(reading.row);
  if (reading.kind <= model::ObservationKind::kZ)
    return frame_of(machine, rows, reading.row).transpose() *
           Eigen::Vector3d::Unit(static_cast<Eigen::Index>(reading.kind));
  if (reading.kind == model::ObservationKind::kD)
    return {rows.states.normal[0][row], rows.states.normal[1][row], rows.states.normal[2][row]};
  if (reading.kind >= model::ObservationKind::kSameX && reading.kind <= model::ObservationKind::kSameZ)
    return Eigen::Vector3d::Unit(static_cast<Eigen::Index>(format::component_of(reading.kind)));
  return Eigen::Vector3d::Zero();
}

}  // namespace vernier::fit
