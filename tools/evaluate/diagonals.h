// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/evaluate/positioning.h"

namespace vernier::evaluate {

/// Readings of a diagonal displacement test along one diagonal. The targets are commanded distances along the
/// diagonal, from the end with the lowest position of the first axis. The deviations are those of the
/// measured distance, mm.
struct DiagonalFile {
  std::string name;  // signs of the moving axes along the diagonal: "+X+Y+Z", "+X-Y+Z"; a face diagonal has
                     // only the axes that move
  double length = 0;
  PositioningFile positions;
};

/// Reads the diagonals of a displacement test from a measurement file. The file must have columns for two or
/// three linear axes (commanded positions), and the column `reading`. The column `reading` contains the
/// displacement along the diagonal, with any zero and either sign. Rows whose positions are on one straight
/// line in space belong to one diagonal. The approach direction of a row is the direction of the motion from
/// the previous row. Throws InputError with file and line if a row is on no line with its neighbours, if a
/// line is along an axis, or if there are fewer than two targets.
std::vector<DiagonalFile> read_diagonals(const std::string& text, const std::string& file,
                                         const std::string& reading);

/// Returns the results of the machine by ISO 230-6:2002. Each diagonal is evaluated like an axis by ISO
/// 230-2. The result of the machine is the largest value of its body diagonals (E_d, B_d, R_d, …). The keys
/// of the result are the letters A, E, M, R, B. The values of face diagonals are reported separately.
std::map<std::string, double> machine_values(const std::map<std::string, PositioningResult>& body);

}  // namespace vernier::evaluate
