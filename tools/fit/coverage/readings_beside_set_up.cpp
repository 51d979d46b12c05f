// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/readings_beside_set_up.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reading_direction.h"
#include "tools/maths/orthonormal.h"
#include "tools/model/chain/chain.h"
#include "tools/model/fit_record.h"

namespace vernier::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ReadingsBesideSetUp::ReadingsBesideSetUp(const model::Machine& fitted, const model::Measurement& rows,
                                         const VectorXd& residual, double variance)
    : bare_(fitted), states_(rows.states), check_(rows.check) {
  bare_.base_shifts.clear();
  bare_.tool_shifts.clear();
  const double rms_mm = fitted.fitted ? std::max(fitted.fitted->rms_mm, 1e-9) : 1;
  std::vector<double> left;
  std::vector<std::size_t> setups;
  for (std::size_t i = 0; i < rows.observations.size(); ++i) {
    const model::Observation& o = rows.observations[i];
    // The unknown place of a touched object follows the effects that are compared here.
    if (rows.check[o.row] != 0 || model::is_of_thing(o.kind)) continue;
    rotations_ = rotations_ || model::is_rotation(o.kind);
    const Eigen::Vector3d along =
        model::is_rotation(o.kind) ? Eigen::Vector3d::Zero().eval() : reading_direction(fitted, rows, o);
    if (along.norm() <= 0) continue;
    const double u = model::uncertainty_of(rows, o);
    const double weight = u > 0 ? 1 / (u * std::sqrt(variance)) : 1 / rms_mm;
    row_.push_back(static_cast<Index>(o.row));
    along_.push_back(weight * along);
    left.push_back(weight * residual[static_cast<Index>(i)]);
    setups.push_back(rows.states.of(rows.states.setup, o.row));
  }
  if (row_.empty()) return;
  find_set_ups(setups);
  left_ = beside_set_up(Eigen::Map<VectorXd>(left.data(), static_cast<Index>(left.size())));
}

VectorXd ReadingsBesideSetUp::of(const VectorXd& points) const {
  VectorXd column(static_cast<Index>(row_.size()));
  for (std::size_t i = 0; i < row_.size(); ++i)
    column[static_cast<Index>(i)] = along_[i].dot(points.segment<3>(3 * row_[i]));
  return beside_set_up(column);
}

void ReadingsBesideSetUp::find_set_ups(const std::vector<std::size_t>& setups) {
  const MatrixXd rigid = rigid_motions(model::forward(bare_, states_).position);
  std::map<std::size_t, Index> place;
  for (const std::size_t name : setups) place.emplace(name, static_cast<Index>(place.size()));
  MatrixXd columns = MatrixXd::Zero(static_cast<Index>(row_.size()), 6 * static_cast<Index>(place.size()));
  for (std::size_t i = 0; i < row_.size(); ++i)
    columns.block<1, 6>(static_cast<Index>(i), 6 * place[setups[i]]) =
        along_[i].transpose() * rigid.middleRows<3>(3 * row_[i]);
  set_up_ = maths::orthonormal(columns, 1e-9, nullptr);
}

VectorXd ReadingsBesideSetUp::beside_set_up(const VectorXd& column) const {
  return column - set_up_ * (set_up_.transpose() * column);
}

}  // namespace vernier::fit
