// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "tools/offline/program_words.h"

namespace vernier::offline {

/// State of the program that defines the arc of a block, in addition to the words of the block.
struct ArcReading {
  int plane = 17;  // plane: G17, G18 or G19
  bool clockwise = false;
  bool absolute_centre = false;        // G90.1: I J K are absolute coordinates, not relative to the start of
                                       // the arc
  double unit = 1;                     // length of the program's unit, mm
  std::array<Eigen::Index, 2> axis{};  // indices of the axes of the plane in the machine
  std::array<double, 2> zero{};        // machine position of the program's zero point, mm
};

/// An arc or helix between two positions of the machine. All other axes move in proportion to the angle about
/// the centre. If the ends have different distances from the centre, a spiral connects them.
struct ProgramArc {
  Eigen::VectorXd from, to;
  std::array<Eigen::Index, 2> axis{};
  Eigen::Vector2d centre;      // centre in the plane, mm
  double begin = 0, turn = 0;  // start angle, and signed angle of the arc, rad
  double radius = 0, radius_at_end = 0;

  double angle(double share) const { return begin + share * turn; }
  Eigen::VectorXd at(double share) const;
  bool whole() const;
};

/// Returns the letters of the two axes of a plane. G3 turns from the first axis to the second axis. The
/// letters of the centre (I J K) correspond to these letters.
std::array<char, 2> plane_letters(int plane);

/// Returns the arc of a block from the word R, or from the words I J K. If both ends of the arc are equal,
/// the arc is a whole turn. Throws InputError if no arc with these words exists, if the centre has different
/// distances from both ends, or if the arc has several turns (P).
ProgramArc arc_of(const std::vector<Word>& words, const ArcReading& reading, const Eigen::VectorXd& from,
                  const Eigen::VectorXd& to, const text::Place& place);

}  // namespace vernier::offline
