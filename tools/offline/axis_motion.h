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

/// A motion of all axes together from one position to another, along a straight line or an arc.
struct ProgramMove {
  Eigen::VectorXd from, to;  // positions in mm and deg
  std::optional<ProgramArc> arc;
  double feed = 0;  // feed of the linear axes together, mm/min; 0: unknown (rapid, inverse time)

  Eigen::VectorXd at(double share) const;
};

/// Computes the motion of the axes at positions of a program's moves: speeds, directions, and the travel of
/// each axis since its last reversal.
class AxisMotion {
 public:
  /// `at`: one state with the values of the inputs.
  AxisMotion(const model::Machine& machine, const model::States& at);

  /// Returns the shares of a move between which no axis changes its direction: 0, the reversals, 1.
  std::vector<double> stretches(const ProgramMove& move) const;
  /// Records that the axes move from one position to another without a reversal in between.
  void set_out(const Eigen::VectorXd& from, const Eigen::VectorXd& to);
  /// Returns the states of the machine at the given shares of a move. All positions are within the planned
  /// range.
  model::States along(const ProgramMove& move, const std::vector<double>& shares) const;
  /// Returns the shares at which the correction is evaluated in a part of a move, including its first and
  /// last share. The shares of a part of a move are those of even_looks. The intervals are smaller where an
  /// expression of the chain changes quickly (model::Detail::Sharp).
  std::vector<double> looks(const ProgramMove& move, double from, double to, double deviation_mm) const;

 private:
  /// Returns the number of equal parts in which a move is evaluated. Each part is at most one millimetre or a
  /// tenth of a degree. Each period of a cyclic error has 32 parts, and each interval between stations has 4
  /// parts. The parts of an arc are so short that their chords differ from the arc by at most an eighth of
  /// `deviation_mm`.
  int even_looks(const ProgramMove& move, double from, double to, double deviation_mm) const;

  const model::Machine& machine_;
  const model::States& at_;
  std::vector<double> turn_, sense_;   // position of the last reversal of each axis, and direction of its
                                       // motion
  std::vector<model::Detail> detail_;  // one Detail for each axis
};

}  // namespace vernier::offline
