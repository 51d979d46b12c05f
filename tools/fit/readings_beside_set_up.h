// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// The fit rows' readings along one direction each (x, y, z, d), weighted, with what a free set-up of each
/// instrument takes up projected out: what two explanations of them are compared by. tool.
class ReadingsBesideSetUp {
 public:
  /// residual: measured - model of each reading; variance: of a weighted reading.
  ReadingsBesideSetUp(const model::Machine& fitted, const model::Measurement& rows,
                      const Eigen::VectorXd& residual, double variance);

  bool empty() const { return row_.empty(); }
  /// The fitted machine without BaseShifts: workpiece coordinates.
  const model::Machine& bare() const { return bare_; }
  /// Do the fit rows read rotations too?
  bool rotations() const { return rotations_; }
  /// All rows, check rows too.
  const model::States& states() const { return states_; }
  /// Of each of these rows: is it a check row?
  const std::vector<char>& check() const { return check_; }
  /// The residual, 1.
  const Eigen::VectorXd& left() const { return left_; }
  /// What the readings make of movements of the tool point in all rows (3 N, mm): 1.
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
