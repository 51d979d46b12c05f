// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/plan/types.h"

namespace vernier::plan {

/// The aim of an accuracy plan as rows that are linear in the parameters. The uncertainty of the aim is U95 =
/// 2 sqrt(trace(rows C rows^T)), mm, with the covariance C of the parameters.
struct AimRows {
  Eigen::MatrixXd rows;  // columns: the machine's own parameters, in the order of `own`
  /// The rows and the divisor of one group of part characteristics.
  struct Piece {
    std::string name;
    Eigen::Index first = 0, count = 0;
    double scale = 1;  // U95 of the group = 2 sqrt(trace of its rows) / scale
  };
  std::vector<Piece> pieces;
};

/// `own`: indices of the parameters of the machine, without the parameters of set-ups.
AimRows aim_rows(const Knowledge& knowledge, const AccuracyAim& aim, const std::vector<Eigen::Index>& own);

/// Returns a copy of the machine whose `<volume>` is the region of the aim.
model::Machine with_region(const model::Machine& machine, const std::vector<model::WorkRange>& region);

}  // namespace vernier::plan
