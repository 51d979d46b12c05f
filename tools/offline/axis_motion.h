// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/model/chain/periods.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"
#include "tools/offline/program_arc.h"

namespace vernier::offline {

/// A move of all axes together from one position to another: straight, or along an arc.
struct ProgramMove {
  Eigen::VectorXd from, to;  // mm and deg
  std::optional<ProgramArc> arc;
  double feed = 0;  // of the linear axes together, mm/min; 0: not known (rapid, inverse time)

  Eigen::VectorXd at(double share) const;
};

/// The motion at the positions of a program's moves: speeds, directions, and the travel of each axis since
/// its last reversal.
class AxisMotion {
 public:
  /// at: one row, with the inputs.
  AxisMotion(const model::Machine& machine, const model::States& at);

  /// Shares between which the directions of all axes do not change: 0, reversals, 1.
  std::vector<double> stretches(const ProgramMove& move) const;
  /// Records that the axes move from one position to another without a reversal in between.
  void set_out(const Eigen::VectorXd& from, const Eigen::VectorXd& to);
  /// Returns the positions with the motion at shares of a move, all within the planned range.
  model::States along(const ProgramMove& move, const std::vector<double>& shares) const;
  /// Returns the shares of a part of a move at which the correction is evaluated, including its first and
  /// last. The shares are those of even_looks, with smaller intervals where an expression of the chain
  /// changes quickly (model::Detail::Sharp).
  std::vector<double> looks(const ProgramMove& move, double from, double to, double deviation_mm) const;

 private:
  /// Returns the number of equal parts that are evaluated. A part is at most a millimetre or a tenth of a
  /// degree. Each period of a cyclic error of the chain has 32 parts, each interval between stations
  /// 4. Parts of an arc are so short that their chords stay within an eighth of the deviation.
  int even_looks(const ProgramMove& move, double from, double to, double deviation_mm) const;

  const model::Machine& machine_;
  const model::States& at_;
  std::vector<double> turn_, sense_;   // where an axis last turned round, and how it moves
  std::vector<model::Detail> detail_;  // of each axis
};

}  // namespace vernier::offline
