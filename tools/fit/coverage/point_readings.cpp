// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/point_readings.h"

namespace vernier::fit {

model::Measurement point_readings(const model::States& states) {
  model::Measurement m;
  m.states = states;
  m.uncertainty = model::Column::Zero(static_cast<Eigen::Index>(states.count));
  m.check.assign(states.count, 0);
  m.centre = m.nominal_point = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(states.count));
  m.files = {"point"};
  m.file.assign(states.count, 0);
  for (std::size_t row = 0; row < states.count; ++row) m.line.push_back(row + 1);
  for (std::size_t row = 0; row < states.count; ++row)
    for (const model::ObservationKind kind :
         {model::ObservationKind::kX, model::ObservationKind::kY, model::ObservationKind::kZ})
      m.observations.push_back({kind, row, 0});
  return m;
}

Eigen::MatrixXd rigid_motions(const Eigen::Matrix3Xd& points) {
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(3 * points.cols(), 6);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    motions.block<3, 3>(3 * i, 0).setIdentity();
    const Eigen::Vector3d p = points.col(i);
    motions.block<3, 3>(3 * i, 3) << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
  }
  return motions;
}

}  // namespace vernier::fit
