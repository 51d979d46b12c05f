// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/evaluate/positioning.h"

namespace vernier::evaluate {

/// A diagonal displacement test of one diagonal. Targets: commanded distances along the diagonal from its end
/// with the lowest first axis. Deviations: of the measured distance. mm.
struct DiagonalFile {
  std::string name;  // signs of the axes along it: "+X+Y+Z", "+X-Y+Z"; of a face diagonal those that move
  double length = 0;
  PositioningFile positions;
};

/// Reads the diagonals of a measurement file. Columns of the file: two or three linear axes (commanded
/// positions), and `reading`. `reading` is the displacement measured along the diagonal, with any zero and
/// either sign. Rows on one straight line in space are a diagonal. The approach direction of a row is that of
/// the motion from the previous row. Throws InputError with file and line: a row on no line with its
/// neighbours, a line along an axis, fewer than two targets.
std::vector<DiagonalFile> read_diagonals(const std::string& text, const std::string& file,
                                         const std::string& reading);

/// Returns the values of the machine by ISO 230-6:2002. Each diagonal is evaluated as an axis by ISO 230-2;
/// the value of the machine is the largest of its body diagonals (E_d, B_d, R_d, …). The keys of the result
/// are the letters A E M R B. Values of face diagonals are reported separately.
std::map<std::string, double> machine_values(const std::map<std::string, PositioningResult>& body);

}  // namespace vernier::evaluate
