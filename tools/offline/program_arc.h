// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "tools/offline/program_words.h"

namespace vernier::offline {

/// State of the program that defines a block's arc, in addition to the words of the block.
struct ArcReading {
  int plane = 17;  // G17, G18, G19
  bool clockwise = false;
  bool absolute_centre = false;        // G90.1: I J K are a place, not a step from the arc's begin
  double unit = 1;                     // mm of one of the program
  std::array<Eigen::Index, 2> axis{};  // of the plane's letters among the axes of the machine
  std::array<double, 2> zero{};        // machine position of the program's zero, mm
};

/// An arc or helix between two positions of the machine: turns about its centre, and moves all other axes
/// evenly with the angle. Ends at unequal distances from the centre are joined by a spiral.
struct ProgramArc {
  Eigen::VectorXd from, to;
  std::array<Eigen::Index, 2> axis{};
  Eigen::Vector2d centre;      // mm
  double begin = 0, turn = 0;  // angle of the begin, signed way round, rad
  double radius = 0, radius_at_end = 0;

  double angle(double share) const { return begin + share * turn; }
  Eigen::VectorXd at(double share) const;
  bool whole() const;
};

/// Returns the letters of a plane's axes in the order in which G3 turns from the first to the second. The
/// letters of the centre (I J K) follow from them.
std::array<char, 2> plane_letters(int plane);

/// Returns the arc of a block from R, or from I J K. Ends that coincide are a whole turn. Throws InputError:
/// no such arc, a centre whose distances from both ends differ, several turns (P).
ProgramArc arc_of(const std::vector<Word>& words, const ArcReading& reading, const Eigen::VectorXd& from,
                  const Eigen::VectorXd& to, const text::Place& place);

}  // namespace vernier::offline
