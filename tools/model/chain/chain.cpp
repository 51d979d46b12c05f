// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/chain.h"

#include "tools/model/chain/chain_rows.h"

namespace vernier::model {

Poses forward(const Machine& machine, const States& states) {
  ChainRows chain(machine, states);
  Poses poses;
  poses.position.resize(3, static_cast<Eigen::Index>(states.count));
  poses.rotation.resize(states.count);
  for (std::size_t i = 0; i < states.count; ++i) {
    const Frame frame = chain.pose(i);
    poses.position.col(static_cast<Eigen::Index>(i)) = frame.origin;
    poses.rotation[i] = frame.rotation;
  }
  return poses;
}

Eigen::Matrix3Xd deviation(const Machine& machine, const States& states) {
  return forward(machine, states).position - forward(nominal_machine(machine), states).position;
}

}  // namespace vernier::model
