// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// The weighted readings of the fit rows along one direction each (x, y, z, d). The part that a free set-up
/// of each instrument absorbs is projected out. Two explanations of the readings are compared in this form.
/// Touches (`same`, `on`) are left out.
class ReadingsBesideSetUp {
 public:
  /// residual: measured - model of each reading; variance: variance of a weighted reading.
  ReadingsBesideSetUp(const model::Machine& fitted, const model::Measurement& rows,
                      const Eigen::VectorXd& residual, double variance);

  bool empty() const { return row_.empty(); }
  /// The fitted machine without BaseShifts: workpiece coordinates.
  const model::Machine& bare() const { return bare_; }
  /// True if the fit rows contain rotations too.
  bool rotations() const { return rotations_; }
  /// Returns all rows, including check rows.
  const model::States& states() const { return states_; }
  /// For each row of states(): true if the row is a check row.
  const std::vector<char>& check() const { return check_; }
  /// The residual, 1.
  const Eigen::VectorXd& left() const { return left_; }
  /// Converts motions of the tool point in all rows (3 N, mm) to readings: 1.
  Eigen::VectorXd of(const Eigen::VectorXd& points) const;

 private:
  void find_set_ups(const std::vector<std::size_t>& setups);
  Eigen::VectorXd beside_set_up(const Eigen::VectorXd& column) const;

  model::Machine bare_;
  model::States states_;
  std::vector<char> check_;
  std::vector<Eigen::Index> row_;
  std::vector<Eigen::Vector3d> along_;  // direction over uncertainty, 1/mm
  Eigen::MatrixXd set_up_;
  Eigen::VectorXd left_;
  bool rotations_ = false;
};

}  // namespace vernier::fit
