// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// The weighted readings x, y, z, d of the fit rows, each along one direction. The part of the readings that
/// a free set-up of each instrument explains is removed by projection. The projected readings are used to
/// compare two explanations of the same readings. Touch rows (`same`, `on`) are excluded from these readings.
class ReadingsBesideSetUp {
 public:
  /// `residual`: measured - model of each reading; `variance`: variance of a weighted reading.
  ReadingsBesideSetUp(const model::Machine& fitted, const model::Measurement& rows,
                      const Eigen::VectorXd& residual, double variance);

  bool empty() const { return row_.empty(); }
  /// Returns the fitted machine in workpiece coordinates, without BaseShifts.
  const model::Machine& bare() const { return bare_; }
  /// True if the fit rows also contain readings of rotations.
  bool rotations() const { return rotations_; }
  /// Returns the states of all rows, including check rows.
  const model::States& states() const { return states_; }
  /// Returns one flag for each row of states(): true if the row is a check row.
  const std::vector<char>& check() const { return check_; }
  /// Returns the weighted residual after projection, without unit.
  const Eigen::VectorXd& left() const { return left_; }
  /// Converts motions of the tool point in all rows (3 N elements, mm) to weighted readings without unit.
  Eigen::VectorXd of(const Eigen::VectorXd& points) const;

 private:
  void find_set_ups(const std::vector<std::size_t>& setups);
  Eigen::VectorXd beside_set_up(const Eigen::VectorXd& column) const;

  model::Machine bare_;
  model::States states_;
  std::vector<char> check_;
  std::vector<Eigen::Index> row_;
  std::vector<Eigen::Vector3d> along_;  // direction of each reading divided by its uncertainty, 1/mm
  Eigen::MatrixXd set_up_;
  Eigen::VectorXd left_;
  bool rotations_ = false;
};

}  // namespace vernier::fit
