// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/plan/types.h"

namespace vernier::plan {

/// The aim as numbers that are linear in the parameters: U95 = 2 sqrt(trace(rows C rows^T)), mm.
struct AimRows {
  Eigen::MatrixXd rows;  // by the machine's own parameters, in the order of `own`
  /// A part of the characteristics of a part: its rows and divisors.
  struct Piece {
    std::string name;
    Eigen::Index first = 0, count = 0;
    double scale = 1;  // U95 of the piece = 2 sqrt(trace of its rows) / scale
  };
  std::vector<Piece> pieces;
};

/// own: indices of the parameters of the machine, without the parameters of the set-ups.
AimRows aim_rows(const Knowledge& knowledge, const AccuracyAim& aim, const std::vector<Eigen::Index>& own);

/// Returns the machine with the region of the aim as its `<volume>`.
model::Machine with_region(const model::Machine& machine, const std::vector<model::WorkRange>& region);

}  // namespace vernier::plan
